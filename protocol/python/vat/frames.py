"""Decoded frames of a session (protocol/FRAMES.md)."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vat import _native
from vat._native import frame_number
from vat.results import Quaternion, Vector

__all__ = ["FrameBody", "Frame", "FrameDecoder", "frame_number"]


@dataclass(frozen=True)
class FrameBody:
    """A body of a frame. Rigid bodies have a pose, the others have particles."""

    id: int  #: as in the session's description
    kind: str  #: liquid, deformable or rigid
    numbers: NDArray[np.uint32] | None = None  #: numbers of the particles, ascending
    positions: NDArray[np.float64] | None = None  #: shape (n, 3) [m]
    #: By name, shape (n): speed [m/s], density [kg/m^3], pressure [Pa], acceleration [m/s^2]. Only
    #: the requested attributes.
    attributes: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    center_of_mass: Vector | None = None  #: [m]
    orientation: Quaternion | None = None  #: from body axes to world axes


@dataclass(frozen=True)
class Frame:
    """The visible state of a session at a tick."""

    number: int  #: counts the frames of the session
    epoch: int  #: of the description to which the bodies belong
    tick: int
    time: float  #: simulated time [s]
    published: float  #: time of publication [s since 1970]
    playing: bool
    slow: bool  #: the session is slower than its speed
    real_time_factor: float
    detail: int  #: level of detail, 0 to 3 (all particles)
    has_region: bool  #: only particles of the subscribed region
    quantum: float  #: distance of two positions of the grid [m]; twice the maximum error
    vat_offset: Vector | None  #: displacement of the vat [m]; None without a vat
    bodies: list[FrameBody]

    def __getitem__(self, body: int) -> FrameBody:
        """Returns the body with an id. Raises KeyError if there is none."""
        for each in self.bodies:
            if each.id == body:
                return each
        raise KeyError(body)


class FrameDecoder:
    """Decodes the frames of a subscription in order. A rejected frame does not change the decoder."""

    def __init__(self) -> None:
        self._native = _native.FrameDecoder()

    def decode(self, data: bytes) -> Frame:
        """Returns the frame. Raises InputError if a byte does not conform to FRAMES.md. The code
        missing_reference means that an earlier frame is missing.
        """
        return to_frame(self._native.decode(data))


def to_frame(values: dict[str, Any]) -> Frame:
    """Returns the frame of the values of a native decoder."""
    bodies = [FrameBody(**body) for body in values.pop("bodies")]
    return Frame(bodies=bodies, **values)
