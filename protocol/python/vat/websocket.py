"""The client's side of a WebSocket connection (RFC 6455), without input and output."""

import base64
import hashlib
import os
import struct
from dataclasses import dataclass
from urllib.parse import urlsplit

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
PORTS = {"ws": 80, "wss": 443}
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10
SUBPROTOCOL = "vat.v1"


class Closed(ConnectionError):
    """The connection has ended. `code` is 0 if there was no close frame."""

    def __init__(self, code: int, reason: str = "") -> None:
        super().__init__(f"closed with {code} {reason}".rstrip())
        self.code = code


@dataclass(frozen=True)
class Address:
    """Address of a server: ws://HOST[:PORT][/PATH] or wss://. The default path is /ws."""

    host: str
    port: int
    path: str
    location: str  #: host and port as in the address
    is_secure: bool

    @staticmethod
    def parse(url: str) -> "Address":
        parts = urlsplit(url)
        if parts.scheme not in PORTS or not parts.hostname:
            raise ValueError(f"{url!r} is neither ws://HOST[:PORT][/PATH] nor wss://")
        path = parts.path if len(parts.path) > 1 else "/ws"
        return Address(parts.hostname, parts.port or PORTS[parts.scheme], path, parts.netloc,
                       parts.scheme == "wss")


class Handshake:
    """The request for a WebSocket, and the check of its reply."""

    def __init__(self, address: Address) -> None:
        self.key = base64.b64encode(os.urandom(16)).decode()
        self.request = (
            f"GET {address.path} HTTP/1.1\r\nHost: {address.location}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {self.key}\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Protocol: {SUBPROTOCOL}\r\n\r\n").encode()

    def check(self, head: bytes) -> None:
        """Raises ConnectionError if the server does not accept the request."""
        status, *lines = head.decode("latin-1").split("\r\n")
        headers = {name.strip().lower(): value.strip()
                   for name, _, value in (line.partition(":") for line in lines)}
        accept = base64.b64encode(hashlib.sha1((self.key + GUID).encode()).digest()).decode()
        if " 101 " not in status + " " or headers.get("sec-websocket-accept") != accept:
            raise ConnectionError(f"the server refuses: {status}")


def encode(opcode: int, payload: bytes) -> bytes:
    """Returns a masked frame."""
    size = len(payload)
    if size < 126:
        head = struct.pack(">BB", 0x80 | opcode, 0x80 | size)
    elif size < 1 << 16:
        head = struct.pack(">BBH", 0x80 | opcode, 0x80 | 126, size)
    else:
        head = struct.pack(">BBQ", 0x80 | opcode, 0x80 | 127, size)
    mask = os.urandom(4)
    stream = (mask * (size // 4 + 1))[:size]
    masked = int.from_bytes(payload, "big") ^ int.from_bytes(stream, "big")
    return head + mask + masked.to_bytes(size, "big")


class Receiver:
    """Assembles messages from received data."""

    def __init__(self) -> None:
        self.buffer = bytearray()
        self.opcode = CONTINUATION
        self.parts: list[bytes] = []

    def _frame(self) -> tuple[int, bytes] | None:
        """Returns the first byte and the payload of the next frame, or None if it is incomplete."""
        if len(self.buffer) < 2:
            return None
        size = self.buffer[1] & 127
        extra = {126: 2, 127: 8}.get(size, 0)
        begin = 2 + extra
        if len(self.buffer) < begin:
            return None
        if extra:
            size = int.from_bytes(self.buffer[2:begin], "big")
        if len(self.buffer) < begin + size:
            return None
        first, payload = self.buffer[0], bytes(self.buffer[begin:begin + size])
        del self.buffer[:begin + size]
        return first, payload

    def next(self) -> tuple[int, bytes] | None:
        """Returns the next message: TEXT or BINARY, or PING, which the caller answers. Returns None
        if it is incomplete. Raises Closed after a close frame.
        """
        while (frame := self._frame()) is not None:
            first, payload = frame
            opcode = first & 15
            if opcode == PING:
                return opcode, payload
            if opcode == CLOSE:
                code = struct.unpack(">H", payload[:2])[0] if len(payload) >= 2 else 0
                raise Closed(code, payload[2:].decode("utf-8", "replace"))
            if opcode in (CONTINUATION, TEXT, BINARY):
                if opcode != CONTINUATION:
                    self.opcode, self.parts = opcode, []
                self.parts.append(payload)
                if first & 0x80:
                    return self.opcode, b"".join(self.parts)
        return None
