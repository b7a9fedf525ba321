"""Decodes the frames of a subscription: FRAMES.md.

It is written from that document alone, in its terms and order, to show that the document is
sufficient.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bad_frame import BadFrame
from blocks import LARGEST_PLACE, RIGID, VAT, Block, ParticleBlock, PoseBlock, check_of_blocks
from frame_header import KEY_FRAME, Header, Scale, read_header, read_scale, symbols_begin
from neighbours import clamp
from particles import attributes_of, read_changed, read_coming, read_numbers
from symbols import Symbols

FRAMES_KEPT = 16


@dataclass(frozen=True)
class Frame:
    header: Header
    scale: Scale
    blocks: list[Block]


class Decoder:
    """Decodes successive frames. A rejected frame does not change the decoder."""

    def __init__(self) -> None:
        self.frames: list[Frame] = []  # possible references, the newest last

    def decode(self, data: bytes) -> Frame:
        """Decodes a frame. Raises BadFrame if it is invalid."""
        header = read_header(data)
        if header.type == KEY_FRAME:
            scale = read_scale(data, header)
            symbols = Symbols(data[symbols_begin(header):])
            blocks = read_key_blocks(symbols, scale)
        else:
            references = [self.reference(header, back) for back in header.references_back]
            scale = references[0].scale
            symbols = Symbols(data[symbols_begin(header):])
            blocks = read_delta_blocks(symbols, scale, references)
        symbols.finish()
        if check_of_blocks(blocks) != header.check:
            raise BadFrame("bad_check")
        frame = Frame(header, scale, blocks)
        kept = [] if header.type == KEY_FRAME else self.frames
        self.frames = (kept + [frame])[-FRAMES_KEPT:]
        return frame

    def reference(self, header: Header, back: int) -> Frame:
        """Returns the newest frame of the epoch whose number is lower by `back`."""
        number = (header.number - back) % (1 << 32)
        for frame in reversed(self.frames):
            if (frame.header.number, frame.header.epoch) == (number, header.epoch):
                return frame
        raise BadFrame("missing_reference")


def read_key_blocks(symbols: Symbols, scale: Scale) -> list[Block]:
    count = symbols.check_count(symbols.whole())
    blocks = [read_key_block(symbols, scale) for _ in range(count)]
    for i, block in enumerate(blocks):
        if (block.kind == VAT) != (block.body == 0) or (block.kind == VAT and i > 0):
            raise BadFrame("bad_block")
    return blocks


def read_key_block(symbols: Symbols, scale: Scale) -> Block:
    body, kind = symbols.whole(), symbols.bits(2)
    if kind in (RIGID, VAT):
        place = [symbols.signed() for _ in range(3)]
        if kind == VAT:
            return PoseBlock(body, kind, place, 0, [])
        orientation_bits = symbols.bits(5)
        orientation = [symbols.signed() for _ in range(4)]
        return checked_pose(PoseBlock(body, kind, place, orientation_bits, orientation))
    count = symbols.check_count(symbols.whole())
    numbers = list(range(count)) if symbols.flag(2048) else read_numbers(symbols, count)
    come = read_coming(symbols, numbers, attributes_of(kind, scale.attribute_quanta))
    return ParticleBlock(body, kind, come.numbers, come.positions, come.attributes)


def checked_pose(pose: PoseBlock) -> PoseBlock:
    """Returns the pose of a rigid body. Raises BadFrame if its orientation is far from a unit
    quaternion.
    """
    one = 1 << (2 * pose.orientation_bits)
    squares = sum(x * x for x in pose.orientation)
    if not 3 * one <= 4 * squares <= 5 * one:
        raise BadFrame("bad_block")
    return pose


def read_delta_blocks(symbols: Symbols, scale: Scale, references: Sequence[Frame]) -> list[Block]:
    """Reads the blocks relative to those of the references. The second is optional."""
    turn = symbols.factor()
    two = len(references) == 2
    blocks: list[Block] = []
    changed = False
    for i, first in enumerate(references[0].blocks):
        second = references[-1].blocks[i]
        changed = symbols.flag(3584 if changed else 256)
        if not changed:
            blocks.append(first)
        elif isinstance(first, ParticleBlock):
            has = attributes_of(first.kind, scale.attribute_quanta)
            second = second if two else replace(first, numbers=[], positions=[])
            blocks.append(read_changed(symbols, first, second, has))
        else:
            blocks.append(read_changed_pose(symbols, turn, first, second))
    return blocks


def read_changed_pose(
    symbols: Symbols, turn: int, first: PoseBlock, second: PoseBlock
) -> PoseBlock:
    place = read_turned(symbols, turn, first.place, second.place)
    if first.kind == VAT:
        return PoseBlock(first.body, first.kind, place, 0, [])
    orientation = read_turned(symbols, turn, first.orientation, second.orientation)
    return checked_pose(
        PoseBlock(first.body, first.kind, place, first.orientation_bits, orientation))


def read_turned(
    symbols: Symbols, turn: int, first: Sequence[int], second: Sequence[int]
) -> list[int]:
    """Reads the numbers of a position or orientation, predicted from those of the references."""
    residual_class = symbols.residual_class()
    numbers = []
    for q, (x1, x2) in enumerate(zip(first, second)):
        expected = clamp(x1 + ((turn * (x1 - x2) + 128) >> 8), -LARGEST_PLACE, LARGEST_PLACE)
        number = expected + symbols.residual(residual_class, 0, q % 3)
        if abs(number) > LARGEST_PLACE:
            raise BadFrame("bad_block")
        numbers.append(number)
    return numbers
