"""A session that a client has joined."""

from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

from vat.recording import iframe


@dataclass(frozen=True)
class Session:
    """A joined session. As the last expression of a notebook's cell, it is a live picture.

    The server admits the notebook with its option --allow-origin, such as http://localhost:8888.
    """

    id: str
    page: str  #: address of the viewer
    description: dict[str, Any]  #: of the scene and its bodies (PROTOCOL.md, "Description")

    def _repr_html_(self) -> str:
        return iframe(self.page, f"The session {self.id}")

    @staticmethod
    def joined(url: str, result: dict[str, Any]) -> "Session":
        """Returns the session of the result of session.join, on the server with this address."""
        page = url.replace("ws", "http", 1).removesuffix("/ws")
        identity = result["session"]
        return Session(identity, f"{page}/?session={quote(identity)}", result["description"])
