"""A blocking client of vat.v1: `with Client(url) as client: client.call("server.info")`."""

import socket
import ssl
import struct
import time
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from vat.continuation import FIRST_PAUSE, LONGEST_PAUSE, RECONNECT_TIME, Continuation, Steps
from vat.exchange import MOVES_FOLLOWED, Exchange, VatError
from vat.frames import Frame
from vat.session import Session
from vat.websocket import CLOSE, Address, Closed, Handshake, encode

Value = TypeVar("Value")
LOST = (ConnectionError, ssl.SSLError)  # the connection has ended


class Client:
    """One connection. It reads in the caller's thread, during calls only.

    Results and events are dictionaries as in PROTOCOL.md. Calls raise VatError if the server
    refuses, TimeoutError without a reply in time, and ConnectionError if the connection has ended.
    After session.join, the next call connects again and continues the session, at another node of
    the cluster if necessary. A call that waited for its reply raises the error, because the server
    may have executed it.
    """

    def __init__(self, url: str | Sequence[str] = "ws://127.0.0.1:8080/ws", timeout: float = 10,
                 tls: ssl.SSLContext | None = None,
                 reconnect_time: float = RECONNECT_TIME) -> None:
        """`url` can be a list of nodes of a cluster. `timeout` [s] is for each reply. `tls` has
        trusted certificates. None: the system's. `reconnect_time` [s] limits the attempts to
        continue a session. 0: the client does not connect again.
        """
        self.timeout = timeout
        self.reconnect_time = reconnect_time
        self._tls = tls
        self._continuation = Continuation(url)
        self._exchange = Exchange()
        self._ended: BaseException | None = None
        *others, last = self._continuation.urls
        for other in others:
            try:
                return self._connect(other)
            except OSError:
                pass  # the next node
        self._connect(last)

    def _connect(self, url: str) -> None:
        address = Address.parse(url)
        self.url = url
        events = self._exchange.events
        self._exchange = Exchange()
        self._exchange.events = events
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
        self._restore()
        try:
            if method == "session.join" and self.reconnect_time > 0:
                self._perform(self._continuation.learn_nodes())
            result = self._request(method, params)
        except LOST as error:
            self._ended = error
            raise
        self._continuation.remember(method, params, result)
        return result

    def _request(self, method: str, params: dict[str, Any]) -> Any:
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
                self._perform(self._continuation.enter())
        raise AssertionError("the last attempt returns or raises")

    def notify(self, method: str, **params: Any) -> None:
        """Sends a notification, which has no reply."""
        self._restore()
        self._exchange.send(method, params)
        try:
            self._flush()
        except LOST as error:
            self._ended = error
            raise

    def wait_event(self, name: str, timeout: float | None = None) -> dict[str, Any]:
        """Returns the params of the next event with this name. Discards others."""
        return self._wait(lambda: self._exchange.take_event(name), timeout)

    def next_frame(self, timeout: float | None = None) -> Frame:
        """Returns the next frame, decoded and acknowledged."""
        return self._wait(lambda: self._exchange.take_frame(), timeout)

    def next_frame_bytes(self, timeout: float | None = None) -> bytes:
        """Returns the bytes of the next frame. The caller acknowledges it with frames.ack."""
        return self._wait(
            lambda: self._exchange.frames.popleft() if self._exchange.frames else None, timeout)

    def _wait(self, take: Callable[[], Value | None], timeout: float | None) -> Value:
        """Returns the first value of `take` that is not None. Continues on another connection."""
        while True:
            self._restore()
            deadline = self._deadline(timeout)
            try:
                while (value := take()) is None:
                    self._take(deadline)
                self._flush()
                return value
            except LOST as error:
                self._ended = error

    def _restore(self) -> None:
        """Connects again, if the connection has ended or the session has moved."""
        if self._ended is None:
            try:
                self._read_arrived()
            except LOST as error:
                self._ended = error
        if self._can_continue() and (self._ended or self._must_follow()):
            self._reconnect()
        elif self._ended is not None:
            raise self._ended

    def _can_continue(self) -> bool:
        return self.reconnect_time > 0 and self._continuation.can_follow(self._ended)

    def _must_follow(self) -> bool:
        return self._exchange.moved_to is not None and self._can_continue()

    def _reconnect(self) -> None:
        deadline = time.monotonic() + self.reconnect_time
        url = self._exchange.moved_to or self._continuation.next_url()
        pause = FIRST_PAUSE
        while True:
            self._socket.close()
            try:
                self._connect(url)
                self._perform(self._continuation.steps())
                self._ended = None
                return
            except VatError as error:
                failure: Exception = error
                self._ended = None
                self._continuation.fail(error)
                url = error.moved_to or self._continuation.next_url()
            except OSError as error:
                failure = error
                url = self._continuation.next_url()
            self._ended = failure
            if time.monotonic() + pause > deadline:
                raise failure
            time.sleep(pause)
            pause = min(2 * pause, LONGEST_PAUSE)

    def _perform(self, steps: Steps) -> None:
        """Sends the requests of the steps."""
        try:
            request = next(steps)
            while True:
                try:
                    result = self._request(*request)
                except VatError as error:
                    request = steps.throw(error)
                else:
                    request = steps.send(result)
        except StopIteration:
            pass

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

    def _read_arrived(self) -> None:
        """Reads the data that has arrived, without waiting."""
        if self._early:
            return
        self._socket.settimeout(0)
        while True:
            try:
                data = self._socket.recv(1 << 16)
            except (BlockingIOError, ssl.SSLWantReadError):
                return
            if not data:
                raise Closed(0)
            self._exchange.receive(data)

    def _take(self, deadline: float) -> None:
        if self._must_follow():
            raise Closed(0, "the session has moved")
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
