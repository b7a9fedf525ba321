"""Predictions from coded particles: FRAMES.md, "Order" and "Context of neighbouring cells"."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from bad_frame import BadFrame
from blocks import Triple
from residual_tables import LARGEST_CLASS, class_of_size
from symbols import Symbols

QUANTITIES = range(3)
MOST_COUNTED = 63


def clamp(x: int, least: int, greatest: int) -> int:
    return max(least, min(x, greatest))


@dataclass(frozen=True)
class Order:
    """The cells of the particles of the first reference, and their indices sorted by cell."""

    cells: list[Triple]
    particles: list[int]


def order_of(positions: Sequence[Triple], shift: int) -> Order:
    cells = [(x >> shift, y >> shift, z >> shift) for x, y, z in positions]
    if cells:
        box = 1
        for along in zip(*cells):
            box *= max(along) - min(along) + 3
        if box > 4096 + 16 * len(cells):
            raise BadFrame("bad_block")
    particles = sorted(range(len(cells)), key=lambda i: (cells[i][2], cells[i][1], cells[i][0], i))
    return Order(cells, particles)


@dataclass
class Coded:
    """The coded quantities of a cell."""

    count: int = 0
    errors: list[int] = field(default_factory=lambda: [0, 0, 0])
    sizes: list[int] = field(default_factory=lambda: [0, 0, 0])


NOTHING_CODED = Coded()


class Neighbours:
    """Reads three quantities of each particle, in the order of the document."""

    def __init__(self, symbols: Symbols) -> None:
        self.symbols = symbols
        self.shift = symbols.bits(3) - 4
        self.first_class = symbols.residual_class()
        self.cells: dict[Triple, Coded] = {}

    def read(self, cell: Triple, predictions: Sequence[int], is_read: Sequence[bool]) -> list[int]:
        """Reads the quantities of a particle in the cell, predicted in eighths. Quantities that are
        not read are 0.
        """
        own = self.cells.setdefault(cell, Coded())
        x, y, z = cell
        before = [
            self.cells.get(neighbour, NOTHING_CODED)
            for neighbour in ((x - 1, y, z), (x, y - 1, z), (x, y, z - 1))
        ]
        weighted = 4 * own.count + sum(other.count for other in before)
        weight = 65536 // (weighted + 1)
        sizes = [4 * own.sizes[q] + sum(other.sizes[q] for other in before) + 8
                 for q in QUANTITIES]
        values, expected = [0, 0, 0], [0, 0, 0]
        for q in QUANTITIES:
            errors = 4 * own.errors[q] + sum(other.errors[q] for other in before)
            expected[q] = predictions[q] + ((errors * weight) >> 16)
            if not is_read[q]:
                continue
            size = (((13 * sizes[q] + sum(sizes)) >> 4) * weight) >> 8
            size_class = clamp(class_of_size(size) + self.shift, 0, LARGEST_CLASS)
            values[q] = self.symbols.predicted(
                expected[q], size_class if weighted > 0 else self.first_class, q)
        if own.count < MOST_COUNTED:
            own.count += 1
            for q in QUANTITIES:
                own.errors[q] += clamp(8 * values[q] - predictions[q], -8184, 8184)
                own.sizes[q] += min(abs(8 * values[q] - expected[q]), 2047)
        return values


def mean_steps(
    order: Order, positions: Sequence[Triple], earlier: Sequence[Triple | None]
) -> dict[Triple, Triple]:
    """Returns the mean step of each cell in eighths, from the particles that are in both
    references.
    """
    seen: dict[Triple, int] = {}
    steps: dict[Triple, list[int]] = {}  # count, and a sum for each axis
    for i in order.particles:
        cell = order.cells[i]
        seen[cell] = seen.get(cell, 0) + 1
        before = earlier[i]
        if seen[cell] > MOST_COUNTED or before is None:
            continue
        sums = steps.setdefault(cell, [0, 0, 0, 0])
        sums[0] += 1
        for axis in range(3):
            sums[1 + axis] += clamp(positions[i][axis] - before[axis], -8191, 8191)
    return {cell: mean_around(cell, steps) for cell in seen}


def mean_around(cell: Triple, steps: dict[Triple, list[int]]) -> Triple:
    x, y, z = cell
    near = [
        sums
        for dz in (-1, 0, 1) for dy in (-1, 0, 1) for dx in (-1, 0, 1)
        if (sums := steps.get((x + dx, y + dy, z + dz)))
    ]
    if not near:
        return 0, 0, 0
    count, *sums = map(sum, zip(*near))
    mean_x, mean_y, mean_z = ((total * (65536 // count)) >> 13 for total in sums)
    return mean_x, mean_y, mean_z
