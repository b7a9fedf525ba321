"""Changes of a body's particles: FRAMES.md, "Changed particles" and its parts."""

from collections.abc import Sequence
from dataclasses import dataclass

from bad_frame import BadFrame
from blocks import LIQUID, ParticleBlock, Triple
from neighbours import Neighbours, Order, clamp, mean_steps, order_of
from residual_tables import class_of_size
from symbols import Symbols

LARGEST_COORDINATE = 65535
LARGEST_ATTRIBUTE = 1 << 20
LARGEST_NUMBER = (1 << 32) - 1
LARGEST_SIZE = 131064
MIDDLE_OF_GRID = 32768
CLASS_OF_NOTHING = 67
SPEED, _DENSITY, _PRESSURE, ACCELERATION = range(4)


@dataclass(frozen=True)
class Particles:
    """Some particles of a body, in the order of their numbers."""

    numbers: list[int]
    positions: list[Triple]
    attributes: list[list[int]]


def attributes_of(kind: int, attribute_quanta: Sequence[float]) -> list[bool]:
    """Returns which attributes the block of a body of this kind has."""
    of_all_kinds = (SPEED, ACCELERATION)
    return [
        quantum > 0 and (kind == LIQUID or q in of_all_kinds)
        for q, quantum in enumerate(attribute_quanta)
    ]


def checked(values: Sequence[int], least: int, greatest: int) -> Sequence[int]:
    if min(values) < least or max(values) > greatest:
        raise BadFrame("bad_block")
    return values


def read_changed(
    symbols: Symbols, first: ParticleBlock, second: ParticleBlock, has: Sequence[bool]
) -> ParticleBlock:
    """Reads a changed block. The block of the second reference may have no particles.

    `has` states for each attribute whether the block has it.
    """
    removes = symbols.flag(2048)
    added = symbols.check_count(symbols.whole())
    moves = symbols.flag(2048)
    changes = [has_one and symbols.flag(2048) for has_one in has]
    order = Order([], [])
    if removes or moves or any(changes):
        order = order_of(first.positions, symbols.bits(4))
    stays = read_stays(symbols, order) if removes else [True] * len(first.numbers)
    kept = [i for i, one_stays in enumerate(stays) if one_stays]
    numbers = read_numbers(symbols, added)
    if not set(numbers).isdisjoint(first.numbers[i] for i in kept):
        raise BadFrame("bad_block")

    earlier = indices_in(second, first.numbers)
    staying = [i for i in order.particles if stays[i]]
    positions = list(first.positions)
    if moves:
        read_positions(symbols, order, staying, positions, second, earlier)
    attributes = [list(values) for values in first.attributes]
    for begin in (0, ACCELERATION):
        if any(changes[begin:begin + 3]):
            read_attributes(symbols, order, staying, attributes, second, earlier, changes, begin)
    stayed = Particles(
        [first.numbers[i] for i in kept],
        [positions[i] for i in kept],
        [[values[i] for i in kept] if values else [] for values in attributes],
    )
    come = read_coming(symbols, numbers, has)
    return merged(first.body, first.kind, stayed, come)


def read_stays(symbols: Symbols, order: Order) -> list[bool]:
    """Returns for each particle of the first reference whether it stays."""
    after_stay, after_gone = read_cases(symbols), read_cases(symbols)
    stays = [True] * len(order.particles)
    gone = False
    for i in order.particles:
        gone = symbols.flag(after_gone if gone else after_stay)
        stays[i] = not gone
    return stays


def read_cases(symbols: Symbols) -> int:
    cases = symbols.bits(12)
    if cases == 0:
        raise BadFrame("bad_block")
    return cases


def indices_in(block: ParticleBlock, numbers: Sequence[int]) -> list[int | None]:
    """Returns the indices of the particles with these numbers in the block."""
    places = {number: i for i, number in enumerate(block.numbers)}
    return [places.get(number) for number in numbers]


def read_positions(
    symbols: Symbols,
    order: Order,
    staying: Sequence[int],
    positions: list[Triple],
    second: ParticleBlock,
    earlier: Sequence[int | None],
) -> None:
    """Moves the staying particles from their positions in the first reference."""
    common, own = symbols.factor(), symbols.factor()
    neighbours = Neighbours(symbols)
    before = [None if at is None else second.positions[at] for at in earlier]
    means = mean_steps(order, positions, before)
    for i in staying:
        cell = order.cells[i]
        mean, x1, x2 = means[cell], positions[i], before[i]
        predictions = []
        for axis in range(3):
            beyond = 0 if x2 is None else 8 * (x1[axis] - x2[axis]) - mean[axis]
            step = (common * mean[axis] + own * beyond + 128) >> 8
            predictions.append(8 * x1[axis] + step)
        place = neighbours.read(cell, predictions, (True, True, True))
        x, y, z = checked(place, 0, LARGEST_COORDINATE)
        positions[i] = (x, y, z)


def read_attributes(
    symbols: Symbols,
    order: Order,
    staying: Sequence[int],
    attributes: list[list[int]],
    second: ParticleBlock,
    earlier: Sequence[int | None],
    changes: Sequence[bool],
    begin: int,
) -> None:
    """Changes up to three attributes of the staying particles, starting with `begin`.

    They are relative to the attributes in the first reference.
    """
    three = [*changes[begin:begin + 3], False, False][:3]
    factors = [symbols.factor() if change else 0 for change in three]
    neighbours = Neighbours(symbols)
    for i in staying:
        predictions = [0, 0, 0]
        for q in range(3):
            if three[q]:
                a1, at = attributes[begin + q][i], earlier[i]
                a2 = a1 if at is None else second.attributes[begin + q][at]
                predictions[q] = 8 * a1 + ((8 * factors[q] * (a1 - a2) + 128) >> 8)
        values = neighbours.read(order.cells[i], predictions, three)
        checked(values, -LARGEST_ATTRIBUTE, LARGEST_ATTRIBUTE)
        for q in range(3):
            if three[q]:
                attributes[begin + q][i] = values[q]


def merged(body: int, kind: int, stayed: Particles, come: Particles) -> ParticleBlock:
    """Returns all particles in the order of their numbers."""
    numbers = stayed.numbers + come.numbers
    by_number = sorted(range(len(numbers)), key=numbers.__getitem__)
    positions = stayed.positions + come.positions
    attributes = [kept + new for kept, new in zip(stayed.attributes, come.attributes)]
    return ParticleBlock(
        body,
        kind,
        [numbers[i] for i in by_number],
        [positions[i] for i in by_number],
        [[values[i] for i in by_number] if values else [] for values in attributes],
    )


def read_numbers(symbols: Symbols, count: int) -> list[int]:
    """Reads the numbers of new particles."""
    if count == 0:
        return []
    next_cases, k = symbols.bits(12), symbols.bits(5)
    if next_cases == 0:
        raise BadFrame("bad_block")
    numbers = []
    following = 0
    for _ in range(count):
        number = following if symbols.flag(next_cases) else following + 1 + read_gap(symbols, k)
        if number > LARGEST_NUMBER:
            raise BadFrame("bad_block")
        numbers.append(number)
        following = number + 1
    return numbers


def read_gap(symbols: Symbols, k: int) -> int:
    n = k
    while n < 32 and symbols.flag(2048):
        n += 1
    return symbols.long(n) + (1 << n) - (1 << k)


def read_coming(symbols: Symbols, numbers: list[int], has: Sequence[bool]) -> Particles:
    """Reads the positions and attributes of new particles."""
    count = len(numbers)
    if count == 0:
        return Particles([], [], [[] for _ in has])
    strides = read_strides(symbols)
    positions: list[Triple] = []
    sizes: list[Sequence[int]] = []
    for i in range(count):
        before = [i - stride for stride in strides if stride <= i]
        place, left = read_coming_position(
            symbols, [positions[j] for j in before], [sizes[j] for j in before])
        positions.append(place)
        sizes.append(left)
    attributes = [
        read_coming_attribute(symbols, q, count, strides) if has[q] else []
        for q in range(len(has))
    ]
    return Particles(numbers, positions, attributes)


def read_strides(symbols: Symbols) -> list[int]:
    count = symbols.bits(2) + 1
    if count > 3:
        raise BadFrame("bad_block")
    strides = [1]
    for _ in range(count - 1):
        stride = symbols.whole()
        if stride == 0:
            raise BadFrame("bad_block")
        strides.append(stride)
    return strides


def class_of_coming(size: int) -> int:
    return clamp(class_of_size(256 * size), 14, 67)


def size_left(value: int, prediction: int) -> int:
    return min(abs(8 * value - prediction), LARGEST_SIZE)


def read_coming_position(
    symbols: Symbols, before: Sequence[Triple], sizes: Sequence[Sequence[int]]
) -> tuple[Triple, list[int]]:
    """Reads a position, predicted from the earlier ones and their residual sizes. Returns it and
    its sizes.
    """
    predictions = [8 * MIDDLE_OF_GRID] * 3
    classes = [CLASS_OF_NOTHING] * 3
    if before:
        predictions = [8 * sum(along) // len(before) for along in zip(*before)]
        mean_sizes = [sum(along) // len(before) for along in zip(*sizes)]
        classes = [class_of_coming((13 * size + sum(mean_sizes)) >> 4) for size in mean_sizes]
    place = []
    for q in range(3):
        coordinate = symbols.predicted(predictions[q], classes[q], q)
        place += checked([coordinate], 0, LARGEST_COORDINATE)
    x, y, z = place
    return (x, y, z), [size_left(place[q], predictions[q]) for q in range(3)]


def read_coming_attribute(
    symbols: Symbols, q: int, count: int, strides: Sequence[int]
) -> list[int]:
    """Reads attribute q of all new particles."""
    values: list[int] = []
    sizes: list[int] = []
    for i in range(count):
        before = [i - stride for stride in strides if stride <= i]
        prediction, residual_class = 0, CLASS_OF_NOTHING
        if before:
            prediction = 8 * sum(values[j] for j in before) // len(before)
            residual_class = class_of_coming(sum(sizes[j] for j in before) // len(before))
        value = symbols.predicted(prediction, residual_class, q % 3)
        checked([value], -LARGEST_ATTRIBUTE, LARGEST_ATTRIBUTE)
        values.append(value)
        sizes.append(size_left(value, prediction))
    return values
