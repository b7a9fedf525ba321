"""The states of bodies in frames, as integers: FRAMES.md, "Blocks", "Check"."""

from collections.abc import Iterable
from dataclasses import dataclass

LIQUID, DEFORMABLE, RIGID, VAT = range(4)
LARGEST_PLACE = 1 << 28
Triple = tuple[int, int, int]


@dataclass(frozen=True)
class ParticleBlock:
    """A liquid or deformable body, with its particles in the order of their numbers."""

    body: int
    kind: int
    numbers: list[int]
    positions: list[Triple]
    attributes: list[list[int]]  # speeds, densities, pressures, accelerations; some empty


@dataclass(frozen=True)
class PoseBlock:
    """A rigid body, or the vat, which has no orientation and no orientation bits."""

    body: int
    kind: int
    place: list[int]
    orientation_bits: int
    orientation: list[int]


Block = ParticleBlock | PoseBlock


def check_of(numbers: Iterable[int]) -> int:
    """Returns K(x1, x2, ...)."""
    check = 0
    for x in numbers:
        check = (check * 16777619 + x) % (1 << 32)
    return check


def block_numbers(block: Block) -> list[int]:
    """Returns the numbers of a block that the check covers."""
    head = [block.body, block.kind]
    if isinstance(block, PoseBlock):
        orientation = block.orientation or [0, 0, 0, 0]
        return head + [block.orientation_bits, check_of(block.place), check_of(orientation)]
    count = len(block.numbers)
    plain = block.numbers == list(range(count))
    return head + [
        count,
        0 if plain else check_of(block.numbers),
        *(check_of(position[axis] for position in block.positions) for axis in range(3)),
        *(check_of(values) for values in block.attributes),
    ]


def check_of_blocks(blocks: Iterable[Block]) -> int:
    return check_of(number for block in blocks for number in block_numbers(block))
