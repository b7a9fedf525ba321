"""A client of vat.v1 in plain Python: `with Client(url) as client: client.call("server.info")`.

It reads from the connection in the caller's thread, during calls only. The module decode_frame in
this folder decodes frames. Without it, only their bytes are available.
"""

import base64
import hashlib
import json
import os
import socket
import ssl
import struct
import time
from collections import deque
from urllib.parse import urlsplit

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455
PORTS = {"ws": 80, "wss": 443}
EVENTS_KEPT = 1000
CONTINUATION, TEXT, BINARY, CLOSE, PING, PONG = 0, 1, 2, 8, 9, 10


class VatError(Exception):
    """An error reply of the server: `code`, `kind`, `data`, with `path` and `hint` in it."""

    def __init__(self, error):
        super().__init__(error["message"])
        self.code = error["code"]
        self.data = error.get("data", {})
        self.kind = self.data.get("kind")


class Closed(Exception):
    """The connection has ended. `code` is 0 if there was no close frame."""

    def __init__(self, code, reason):
        super().__init__(f"closed with {code} {reason}".rstrip())
        self.code = code


class WebSocket:
    """A WebSocket client (RFC 6455) over TCP or TLS."""

    def __init__(self, url, timeout, tls):
        parts = urlsplit(url)
        if parts.scheme not in PORTS or not parts.hostname:
            raise ValueError(f"{url!r} is neither ws://HOST[:PORT][/PATH] nor wss://")
        address = (parts.hostname, parts.port or PORTS[parts.scheme])
        self.socket = socket.create_connection(address, timeout)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.buffer = b""
        self.message = None  # opcode and parts of an incomplete message
        try:
            if parts.scheme == "wss":
                context = tls or ssl.create_default_context()
                self.socket = context.wrap_socket(self.socket, server_hostname=parts.hostname)
            self.upgrade(parts)
        except BaseException:
            self.socket.close()
            raise

    def upgrade(self, parts):
        key = base64.b64encode(os.urandom(16)).decode()
        path = parts.path if len(parts.path) > 1 else "/ws"
        self.socket.sendall((
            f"GET {path} HTTP/1.1\r\nHost: {parts.netloc}\r\nUpgrade: websocket\r\n"
            f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Protocol: vat.v1\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.buffer:
            self.fill(None)
        head, _, self.buffer = self.buffer.partition(b"\r\n\r\n")
        status, *lines = head.decode("latin-1").split("\r\n")
        headers = {name.strip().lower(): value.strip()
                   for name, _, value in (line.partition(":") for line in lines)}
        accept = base64.b64encode(hashlib.sha1((key + GUID).encode()).digest()).decode()
        if " 101 " not in status + " " or headers.get("sec-websocket-accept") != accept:
            raise ConnectionError(f"the server refuses: {status}")

    def fill(self, deadline):
        """Appends received data to the buffer. Raises TimeoutError if there is none."""
        if deadline is not None:
            left = deadline - time.monotonic()
            if left <= 0:
                raise TimeoutError("no data arrived in time")
            self.socket.settimeout(left)
        more = self.socket.recv(1 << 16)
        if not more:
            raise Closed(0, "")
        self.buffer += more

    def send(self, opcode, payload):
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
        self.socket.settimeout(None)
        self.socket.sendall(head + mask + masked.to_bytes(size, "big"))

    def frame_size(self):
        """Returns the sizes of head and payload of the first frame, or None if they are unknown."""
        if len(self.buffer) < 2:
            return None
        size = self.buffer[1] & 127
        extra = {126: 2, 127: 8}.get(size, 0)
        if len(self.buffer) < 2 + extra:
            return None
        return 2 + extra, int.from_bytes(self.buffer[2:2 + extra], "big") if extra else size

    def read_frame(self, deadline):
        """Returns (whether it is the last of its message, opcode, payload)."""
        while (found := self.frame_size()) is None or len(self.buffer) < sum(found):
            self.fill(deadline)
        head, size = found
        first = self.buffer[0]
        payload = self.buffer[head:head + size]
        self.buffer = self.buffer[head + size:]
        return bool(first & 0x80), first & 15, payload

    def receive(self, deadline):
        """Returns the next message: (TEXT or BINARY, bytes). Answers pings."""
        while True:
            last, opcode, payload = self.read_frame(deadline)
            if opcode == PING:
                self.send(PONG, payload)
            elif opcode == CLOSE:
                code = struct.unpack(">H", payload[:2])[0] if len(payload) >= 2 else 0
                raise Closed(code, payload[2:].decode("utf-8", "replace"))
            elif opcode in (CONTINUATION, TEXT, BINARY):
                if opcode != CONTINUATION:
                    self.message = (opcode, [])
                self.message[1].append(payload)
                if last:
                    opcode, parts = self.message
                    return opcode, b"".join(parts)


class Client:
    """One connection. Results, events and frames are dictionaries as in PROTOCOL.md."""

    def __init__(self, url="ws://127.0.0.1:8080/ws", timeout=10, tls=None):
        """`tls` is an ssl.SSLContext with trusted certificates. None: the system's."""
        self.timeout = timeout
        self.socket = WebSocket(url, timeout, tls)
        self.last_id = 0
        self.replies = {}
        # (name, params) of received events that were not taken. The oldest are dropped.
        self.events = deque(maxlen=EVENTS_KEPT)
        self.frames = deque()  # bytes of received frames that were not taken
        self.decoder = None
        self.waits_for_key = False  # a frame was rejected, and no later frame was decoded

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Closes the connection. Later messages of the server are not read."""
        try:
            self.socket.send(CLOSE, struct.pack(">H", 1000))
        except OSError:
            pass  # it has already ended
        self.socket.socket.close()

    def send(self, method, params, **more):
        message = {"jsonrpc": "2.0", **more, "method": method}
        if params:
            message["params"] = params
        self.socket.send(TEXT, json.dumps(message).encode())

    def call(self, method, **params):
        """Returns the result. Raises VatError if the server refuses, and TimeoutError without a
        reply.
        """
        self.last_id += 1
        identity = self.last_id
        self.send(method, params, id=identity)
        deadline = time.monotonic() + self.timeout
        while identity not in self.replies:
            self.take(deadline)
        reply = self.replies.pop(identity)
        if "error" in reply:
            raise VatError(reply["error"])
        return reply["result"]

    def notify(self, method, **params):
        """Sends a notification, which has no reply."""
        self.send(method, params)

    def wait_event(self, name, timeout=None):
        """Returns the params of the next event with this name. Discards others."""
        deadline = time.monotonic() + (timeout or self.timeout)
        while True:
            while self.events:
                event, params = self.events.popleft()
                if event == name:
                    return params
            self.take(deadline)

    def next_frame(self, timeout=None):
        """Returns the next frame, decoded and acknowledged: header, scale and blocks of
        decode_frame. Rejects invalid frames; the server then sends a key frame.
        """
        from decode_frame import BadFrame, Decoder, read_header
        if self.decoder is None:
            self.decoder = Decoder()
        deadline = time.monotonic() + (timeout or self.timeout)
        while True:
            data = self.next_frame_bytes(deadline - time.monotonic())
            try:
                frame = self.decoder.decode(data)
            except BadFrame as error:
                # The key frame is requested once. The frames before it lack references too.
                wants_key = not (self.waits_for_key and error.reason == "missing_reference")
                self.waits_for_key = True
                more = {"rejected": True} if wants_key else {}
                self.notify("frames.ack", number=read_header(data).number, **more)
                continue
            self.waits_for_key = False
            self.notify("frames.ack", number=frame.header.number)
            return frame

    def next_frame_bytes(self, timeout=None):
        """Returns the bytes of the next frame. The caller acknowledges it with frames.ack."""
        deadline = time.monotonic() + (timeout or self.timeout)
        while not self.frames:
            self.take(deadline)
        return self.frames.popleft()

    def take(self, deadline):
        """Reads one message and stores it for its caller."""
        opcode, payload = self.socket.receive(deadline)
        if opcode == BINARY:
            self.frames.append(payload)
            return
        message = json.loads(payload)
        if "method" in message:
            self.events.append((message["method"], message.get("params", {})))
        elif message["id"] is None:
            raise VatError(message["error"])
        else:
            self.replies[message["id"]] = message
