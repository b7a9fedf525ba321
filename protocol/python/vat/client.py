"""A blocking client of vat.v1: `with Client(url) as client: client.call("server.info")`."""

import socket
import ssl
import struct
import time
from typing import Any

from vat.exchange import MOVES_FOLLOWED, Exchange, VatError
from vat.frames import Frame
from vat.session import Session
from vat.websocket import CLOSE, Address, Closed, Handshake, encode


class Client:
    """One connection. It reads in the caller's thread, during calls only.

    Results and events are dictionaries as in PROTOCOL.md. Calls raise VatError if the server
    refuses, TimeoutError without a reply in time, and Closed if the connection has ended.
    """

    def __init__(self, url: str = "ws://127.0.0.1:8080/ws", timeout: float = 10,
                 tls: ssl.SSLContext | None = None) -> None:
        """`timeout` [s] is for each reply. `tls` has trusted certificates. None: the system's."""
        self.timeout = timeout
        self._tls = tls
        self._connect(url)

    def _connect(self, url: str) -> None:
        address = Address.parse(url)
        self.url = url
        self._exchange = Exchange()
        self._early = b""  # received with the reply to the handshake
        self._socket = socket.create_connection((address.host, address.port), self.timeout)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        try:
            if address.is_secure:
                context = self._tls or ssl.create_default_context()
                self._socket = context.wrap_socket(self._socket, server_hostname=address.host)
            handshake = Handshake(address)
            self._socket.sendall(handshake.request)
            while b"\r\n\r\n" not in self._early:
                self._early += self._receive(self._deadline())
            head, _, self._early = self._early.partition(b"\r\n\r\n")
            handshake.check(head)
        except BaseException:
            self._socket.close()
            raise

    def __enter__(self) -> "Client":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connection. Later messages of the server are not read."""
        self._exchange.output += encode(CLOSE, struct.pack(">H", 1000))
        try:
            self._flush()
        except OSError:
            pass  # it has already ended
        self._socket.close()

    def call(self, method: str, **params: Any) -> Any:
        """Returns the result of a method."""
        identity = self._exchange.request(method, params)
        deadline = self._deadline()
        while identity not in self._exchange.replies:
            self._take(deadline)
        return self._exchange.take_reply(identity)

    def join(self, session: str | None = None, **params: Any) -> Session:
        """Joins a session, by default the first. `params` are those of session.join.

        If another node of a cluster has the session, the client connects to that node.
        """
        if session is not None:
            params["session"] = session
        for left in reversed(range(MOVES_FOLLOWED)):
            try:
                return Session.joined(self.url, self.call("session.join", **params))
            except VatError as error:
                if left == 0 or not error.moved_to:
                    raise
                self.close()
                self._connect(error.moved_to)
        raise AssertionError("the last attempt returns or raises")

    def notify(self, method: str, **params: Any) -> None:
        """Sends a notification, which has no reply."""
        self._exchange.send(method, params)
        self._flush()

    def wait_event(self, name: str, timeout: float | None = None) -> dict[str, Any]:
        """Returns the params of the next event with this name. Discards others."""
        deadline = self._deadline(timeout)
        while (params := self._exchange.take_event(name)) is None:
            self._take(deadline)
        return params

    def next_frame(self, timeout: float | None = None) -> Frame:
        """Returns the next frame, decoded and acknowledged."""
        deadline = self._deadline(timeout)
        while (frame := self._exchange.take_frame()) is None:
            self._take(deadline)
        self._flush()
        return frame

    def next_frame_bytes(self, timeout: float | None = None) -> bytes:
        """Returns the bytes of the next frame. The caller acknowledges it with frames.ack."""
        deadline = self._deadline(timeout)
        while not self._exchange.frames:
            self._take(deadline)
        return self._exchange.frames.popleft()

    def _deadline(self, timeout: float | None = None) -> float:
        return time.monotonic() + (self.timeout if timeout is None else timeout)

    def _receive(self, deadline: float) -> bytes:
        left = deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError("no data arrived in time")
        self._socket.settimeout(left)
        data = self._socket.recv(1 << 16)
        if not data:
            raise Closed(0)
        return data

    def _take(self, deadline: float) -> None:
        self._flush()
        data, self._early = self._early or self._receive(deadline), b""
        self._exchange.receive(data)
        self._flush()

    def _flush(self) -> None:
        if self._exchange.output:
            data = bytes(self._exchange.output)
            self._exchange.output.clear()
            self._socket.settimeout(None)
            self._socket.sendall(data)
