"""Recordings of frames, and their pictures in notebooks."""

import base64
import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast, overload

from vat import _native
from vat.frames import Frame, to_frame

VIEWER = Path(__file__).parent / "viewer"
PICTURE_HEIGHT = 400  # [CSS pixels]


class Recording(Sequence[Frame]):
    """A recording of `Simulation.record`, `vat record` or a server, in .vatrec.

    It is the sequence of its frames. As the last expression of a notebook's cell, it is a picture
    with play, seek and orbit.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        """Opens a recording. Raises InputError if the file is not complete."""
        self.file = Path(file)
        self._native = _native.Recording(str(self.file))

    def __repr__(self) -> str:
        return f"<vat.Recording {str(self.file)!r}: {len(self)} frames>"

    def __len__(self) -> int:
        return self._native.frame_count

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | Sequence[Frame]:
        """Returns a frame. Frames in order are decoded once; others from the last key frame on."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        number = index + len(self) if index < 0 else index
        if not 0 <= number < len(self):
            raise IndexError(f"frame {index} of {len(self)}")
        return to_frame(self._native.frame(number))

    def description(self, frame: int = 0) -> dict[str, Any]:
        """Returns the description of the bodies of a frame (PROTOCOL.md, "Description")."""
        return cast(dict[str, Any], json.loads(self._native.description(frame)))

    def save_page(self, page: str | os.PathLike[str]) -> None:
        """Writes a page with the recording and a player. It needs no server."""
        _native.write_page(str(self.file), os.fspath(page), str(VIEWER))

    def _repr_html_(self) -> str:
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder, "page.html")
            self.save_page(page)
            content = base64.b64encode(page.read_bytes()).decode()
        return iframe(f"data:text/html;base64,{content}", "A recording of a simulation")


def iframe(address: str, title: str) -> str:
    return (f'<iframe src="{address}" title="{title}" width="100%" height="{PICTURE_HEIGHT}" '
            'style="border:0" allow="fullscreen"></iframe>')
