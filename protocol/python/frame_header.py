"""The header of a frame: PROTOCOL.md, "The header"."""

import math
import struct
from dataclasses import dataclass

from bad_frame import BadFrame

KEY_FRAME = 1
DELTA_FRAME = 2
FIELDS = struct.Struct("<4s4B2I2HIQ2df")
SCALE = struct.Struct("<7d")


@dataclass(frozen=True)
class Scale:
    """What steps of the grid and of attributes stand for, in SI units."""

    origin: tuple[float, float, float]
    quantum: float
    attribute_quanta: tuple[float, float, float]


@dataclass(frozen=True)
class Header:
    type: int
    playing: bool
    slow: bool
    detail: int
    region: bool
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
    """The first 52 bytes of a frame."""
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
    if flags >= 1 << 5 or stride == 0:
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


def read_scale(frame: bytes) -> Scale:
    """What a key frame has behind its first 52 bytes."""
    if len(frame) < FIELDS.size + SCALE.size:
        raise BadFrame("truncated")
    numbers = SCALE.unpack_from(frame, FIELDS.size)
    x, y, z, quantum, speed, density, pressure = numbers
    if not all(map(math.isfinite, numbers)):
        raise BadFrame("bad_header")
    if quantum <= 0 or min(speed, density, pressure) < 0:
        raise BadFrame("bad_header")
    return Scale((x, y, z), quantum, (speed, density, pressure))
