"""The messages of a client, without input and output."""

import json
from collections import deque
from typing import Any

from vat.errors import InputError
from vat.frames import Frame, FrameDecoder, frame_number
from vat.websocket import BINARY, PING, PONG, TEXT, Receiver, encode

EVENTS_KEPT = 1000
MOVES_FOLLOWED = 5  # the nodes of a cluster may disagree about the owner of a session for some time
Event = tuple[str, dict[str, Any]]


class VatError(Exception):
    """The server refuses a call."""

    def __init__(self, error: dict[str, Any]) -> None:
        super().__init__(error["message"])
        self.code: int = error["code"]
        self.data: dict[str, Any] = error.get("data", {})  #: with `path` and `hint`
        self.kind: str | None = self.data.get("kind")
        #: URL of the node with the session; "": the error is another one, or the URL is unknown
        self.moved_to: str = self.data.get("url", "") if self.kind == "moved" else ""


class Exchange:
    """Requests, replies, events and frames of a connection. `output` is to be sent."""

    def __init__(self) -> None:
        self.receiver = Receiver()
        self.output = bytearray()
        self.last_id = 0
        self.replies: dict[int, dict[str, Any]] = {}
        self.events: deque[Event] = deque(maxlen=EVENTS_KEPT)  # the oldest are dropped
        self.frames: deque[bytes] = deque()
        self.decoder = FrameDecoder()
        self.waits_for_key = False  # a frame was rejected, and no later frame was decoded
        #: URL of the node that has the session now, or "" if it is unknown; None: no move
        self.moved_to: str | None = None

    def send(self, method: str, params: dict[str, Any], **more: Any) -> None:
        message: dict[str, Any] = {"jsonrpc": "2.0", **more, "method": method}
        if params:
            message["params"] = params
        self.output += encode(TEXT, json.dumps(message).encode())

    def request(self, method: str, params: dict[str, Any]) -> int:
        """Returns the id of the request."""
        self.last_id += 1
        self.send(method, params, id=self.last_id)
        return self.last_id

    def take_reply(self, identity: int) -> Any:
        """Returns the result. Raises VatError if the server refuses."""
        reply = self.replies.pop(identity)
        if "error" in reply:
            raise VatError(reply["error"])
        return reply["result"]

    def take_event(self, name: str) -> dict[str, Any] | None:
        """Returns the params of the next event with this name. Discards earlier events."""
        while self.events:
            event, params = self.events.popleft()
            if event == name:
                return params
        return None

    def take_frame(self) -> Frame | None:
        """Returns the next received frame, decoded and acknowledged. Rejects invalid frames; the
        server then sends a key frame.
        """
        while self.frames:
            data = self.frames.popleft()
            try:
                frame = self.decoder.decode(data)
            except InputError as error:
                # The key frame is requested once. The frames before it lack references too.
                wants_key = not (self.waits_for_key and error.code == "missing_reference")
                self.waits_for_key = True
                more = {"rejected": True} if wants_key else {}
                self.send("frames.ack", {"number": frame_number(data), **more})
                continue
            self.waits_for_key = False
            self.send("frames.ack", {"number": frame.number})
            return frame
        return None

    def receive(self, data: bytes) -> None:
        """Stores the received messages for their callers."""
        self.receiver.buffer += data
        while (message := self.receiver.next()) is not None:
            opcode, payload = message
            if opcode == PING:
                self.output += encode(PONG, payload)
            elif opcode == BINARY:
                self.frames.append(payload)
            else:
                self._store(json.loads(payload))

    def _store(self, message: dict[str, Any]) -> None:
        if "method" in message:
            params = message.get("params", {})
            self.events.append((message["method"], params))
            if message["method"] == "session.moved":
                self.moved_to = params["url"]
        elif message["id"] is None:
            raise VatError(message["error"])
        else:
            self.replies[message["id"]] = message
