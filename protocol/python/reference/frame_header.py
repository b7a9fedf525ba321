"""The header of a frame: FRAMES.md, "Header"."""

import math
import struct
from dataclasses import dataclass

from bad_frame import BadFrame

KEY_FRAME = 1
DELTA_FRAME = 2
FIELDS = struct.Struct("<4s4B2I2HIQ2df")
SCALE = struct.Struct("<7d")
SCALE_WITH_ACCELERATION = struct.Struct("<8d")
ACCELERATION_FLAG = 32


@dataclass(frozen=True)
class Scale:
    """The values of steps of the grid and of attributes, in SI units."""

    origin: tuple[float, float, float]
    quantum: float
    attribute_quanta: tuple[float, ...]  # three, or four with accelerations


@dataclass(frozen=True)
class Header:
    type: int
    playing: bool
    slow: bool
    detail: int
    region: bool
    accelerations: bool  # key frames
    stride: int
    epoch: int
    number: int
    references_back: tuple[int, ...]
    check: int
    tick: int
    time: float
    published: float
    real_time_factor: float


def read_header(frame: bytes) -> Header:
    """Reads the first 52 bytes of a frame."""
    if len(frame) < FIELDS.size:
        raise BadFrame("truncated")
    (magic, version, frame_type, flags, stride, epoch, number, first_back, second_back, check,
     tick, time, published, real_time_factor) = FIELDS.unpack_from(frame)
    if magic != b"VATF":
        raise BadFrame("bad_magic")
    if version != 2:
        raise BadFrame("bad_version")
    if frame_type not in (KEY_FRAME, DELTA_FRAME):
        raise BadFrame("bad_type")
    known = 31 + (ACCELERATION_FLAG if frame_type == KEY_FRAME else 0)
    if flags & ~known or stride == 0:
        raise BadFrame("bad_header")
    if not all(map(math.isfinite, (time, published, real_time_factor))):
        raise BadFrame("bad_header")
    if frame_type == KEY_FRAME and (first_back or second_back):
        raise BadFrame("bad_header")
    if frame_type == DELTA_FRAME and (first_back == 0 or 0 < second_back <= first_back):
        raise BadFrame("bad_header")
    return Header(
        type=frame_type,
        playing=bool(flags & 1),
        slow=bool(flags & 2),
        detail=flags >> 2 & 3,
        region=bool(flags & 16),
        accelerations=bool(flags & ACCELERATION_FLAG),
        stride=stride,
        epoch=epoch,
        number=number,
        references_back=tuple(back for back in (first_back, second_back) if back),
        check=check,
        tick=tick,
        time=time,
        published=published,
        real_time_factor=real_time_factor,
    )


def symbols_begin(header: Header) -> int:
    """Returns the index of the first byte after the header."""
    if header.type == DELTA_FRAME:
        return FIELDS.size
    return FIELDS.size + (SCALE_WITH_ACCELERATION if header.accelerations else SCALE).size


def read_scale(frame: bytes, header: Header) -> Scale:
    """Reads the scale that follows the first 52 bytes of a key frame."""
    if len(frame) < symbols_begin(header):
        raise BadFrame("truncated")
    fields = SCALE_WITH_ACCELERATION if header.accelerations else SCALE
    x, y, z, quantum, *attribute_quanta = numbers = fields.unpack_from(frame, FIELDS.size)
    if not all(map(math.isfinite, numbers)):
        raise BadFrame("bad_header")
    if quantum <= 0 or min(attribute_quanta) < 0:
        raise BadFrame("bad_header")
    if header.accelerations and attribute_quanta[3] == 0:
        raise BadFrame("bad_header")
    return Scale((x, y, z), quantum, tuple(attribute_quanta))
