"""An asyncio client of vat.v1: `async with AsyncClient(url) as client: await client.call(...)`."""

import asyncio
import ssl
import struct
from collections.abc import AsyncIterator, Callable, Sequence
from typing import Any, TypeVar

from vat.continuation import FIRST_PAUSE, LONGEST_PAUSE, RECONNECT_TIME, Continuation, Steps
from vat.exchange import MOVES_FOLLOWED, Exchange, VatError
from vat.frames import Frame
from vat.session import Session
from vat.websocket import CLOSE, Address, Closed, Handshake, encode

Value = TypeVar("Value")


class AsyncClient:
    """One connection, as Client. Several tasks may use it at the same time."""

    def __init__(self, url: str | Sequence[str] = "ws://127.0.0.1:8080/ws", timeout: float = 10,
                 tls: ssl.SSLContext | None = None,
                 reconnect_time: float = RECONNECT_TIME) -> None:
        """The parameters are those of Client."""
        self._continuation = Continuation(url)
        for each in self._continuation.urls:
            Address.parse(each)
        self.url = self._continuation.urls[0]
        self._tls = tls
        self.timeout = timeout
        self.reconnect_time = reconnect_time
        self._exchange = Exchange()
        self._received = asyncio.Condition()
        self._restoring = asyncio.Lock()
        self._ended: BaseException | None = None

    async def __aenter__(self) -> "AsyncClient":
        *others, last = self._continuation.urls
        for other in others:
            try:
                await self._connect(other)
                return self
            except OSError:
                pass  # the next node
        await self._connect(last)
        return self

    async def _connect(self, url: str) -> None:
        address = Address.parse(url)
        self.url = url
        events = self._exchange.events
        self._exchange, self._ended = Exchange(), None
        self._exchange.events = events
        tls = (self._tls or ssl.create_default_context()) if address.is_secure else None
        async with asyncio.timeout(self.timeout):
            self._reader, self._writer = await asyncio.open_connection(
                address.host, address.port, ssl=tls)
            handshake = Handshake(address)
            self._writer.write(handshake.request)
            try:
                head = await self._reader.readuntil(b"\r\n\r\n")
                handshake.check(head.removesuffix(b"\r\n\r\n"))
            except BaseException as error:
                self._writer.close()
                if isinstance(error, EOFError):
                    raise Closed(0) from error
                raise
        self._task = asyncio.create_task(self._read_all())

    async def __aexit__(self, *_: object) -> None:
        """Closes the connection. Later messages of the server are not read."""
        await self._disconnect()

    async def _disconnect(self) -> None:
        self._task.cancel()
        await asyncio.wait([self._task])
        self._exchange.output += encode(CLOSE, struct.pack(">H", 1000))
        self._flush()
        self._writer.close()
        try:
            await self._writer.wait_closed()
        except OSError:
            pass  # it has already ended

    async def call(self, method: str, **params: Any) -> Any:
        """Returns the result of a method."""
        await self._restore()
        if method == "session.join" and self.reconnect_time > 0:
            await self._perform(self._continuation.learn_nodes())
        result = await self._request(method, params)
        self._continuation.remember(method, params, result)
        return result

    async def _request(self, method: str, params: dict[str, Any]) -> Any:
        exchange = self._exchange
        identity = exchange.request(method, params)
        await self._wait_here(lambda: True if identity in exchange.replies else None, None)
        return exchange.take_reply(identity)

    async def join(self, session: str | None = None, **params: Any) -> Session:
        """Joins a session, by default the first, as Client.join()."""
        if session is not None:
            params["session"] = session
        for left in reversed(range(MOVES_FOLLOWED)):
            try:
                return Session.joined(self.url, await self.call("session.join", **params))
            except VatError as error:
                if left == 0 or not error.moved_to:
                    raise
                await self._disconnect()
                await self._connect(error.moved_to)
                await self._perform(self._continuation.enter())
        raise AssertionError("the last attempt returns or raises")

    async def notify(self, method: str, **params: Any) -> None:
        """Sends a notification, which has no reply."""
        await self._restore()
        self._exchange.send(method, params)
        self._flush()
        await self._writer.drain()

    async def wait_event(self, name: str, timeout: float | None = None) -> dict[str, Any]:
        """Returns the params of the next event with this name. Discards others."""
        return await self._wait(lambda: self._exchange.take_event(name), timeout)

    async def next_frame(self, timeout: float | None = None) -> Frame:
        """Returns the next frame, decoded and acknowledged."""
        frame = await self._wait(lambda: self._exchange.take_frame(), timeout)
        self._flush()
        return frame

    async def frames(self) -> AsyncIterator[Frame]:
        """Yields the frames of the subscription as they arrive."""
        while True:
            yield await self._wait(lambda: self._exchange.take_frame(), float("inf"))
            self._flush()

    async def _restore(self) -> None:
        """Connects again, if the connection has ended or the session has moved."""
        if self._ended is None and not self._restoring.locked():
            return
        async with self._restoring:
            if self._ended is None:
                return  # another task has done it
            if self.reconnect_time <= 0 or not self._continuation.can_follow(self._ended):
                raise self._ended
            await self._reconnect()

    async def _reconnect(self) -> None:
        loop = asyncio.get_running_loop()
        deadline = loop.time() + self.reconnect_time
        url = self._exchange.moved_to or self._continuation.next_url()
        pause = FIRST_PAUSE
        while True:
            await self._disconnect()
            try:
                await self._connect(url)
                await self._perform(self._continuation.steps())
                return
            except VatError as error:
                failure: Exception = error
                self._continuation.fail(error)
                url = error.moved_to or self._continuation.next_url()
            except OSError as error:
                failure = error
                url = self._continuation.next_url()
            self._ended = failure
            if loop.time() + pause > deadline:
                raise failure
            await asyncio.sleep(pause)
            pause = min(2 * pause, LONGEST_PAUSE)

    async def _perform(self, steps: Steps) -> None:
        """Sends the requests of the steps."""
        try:
            request = next(steps)
            while True:
                try:
                    result = await self._request(*request)
                except VatError as error:
                    request = steps.throw(error)
                else:
                    request = steps.send(result)
        except StopIteration:
            pass

    async def _wait(self, take: Callable[[], Value | None], timeout: float | None) -> Value:
        """As _wait_here(), but continues on another connection."""
        while True:
            await self._restore()
            exchange = self._exchange
            try:
                return await self._wait_here(take, timeout)
            except Exception as error:
                if error is not self._ended and exchange is self._exchange:
                    raise

    async def _wait_here(self, take: Callable[[], Value | None], timeout: float | None) -> Value:
        """Returns the first value of `take` that is not None."""
        self._flush()
        exchange = self._exchange
        limit = self.timeout if timeout is None else timeout
        async with asyncio.timeout(None if limit == float("inf") else limit), self._received:
            while (value := take()) is None:
                if self._ended is not None:
                    raise self._ended
                if self._exchange is not exchange:
                    raise Closed(0)  # another task has connected again
                await self._received.wait()
        return value

    async def _read_all(self) -> None:
        try:
            while self._ended is None:
                await self._read_once()
        finally:
            async with self._received:
                self._received.notify_all()

    async def _read_once(self) -> None:
        try:
            data = await self._reader.read(1 << 16)
            if not data:
                raise Closed(0)
            async with self._received:
                self._exchange.receive(data)
                self._received.notify_all()
            self._flush()
            if self.reconnect_time > 0 and self._exchange.moved_to is not None:
                raise Closed(0, "the session has moved")
        except Exception as error:  # each later call raises it, or connects again
            self._ended = error

    def _flush(self) -> None:
        if self._exchange.output:
            self._writer.write(bytes(self._exchange.output))
            self._exchange.output.clear()
