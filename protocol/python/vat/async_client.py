"""An asyncio client of vat.v1: `async with AsyncClient(url) as client: await client.call(...)`."""

import asyncio
import ssl
import struct
from collections.abc import AsyncIterator, Callable
from typing import Any, TypeVar

from vat.exchange import MOVES_FOLLOWED, Exchange, VatError
from vat.frames import Frame
from vat.session import Session
from vat.websocket import CLOSE, Address, Closed, Handshake, encode

Value = TypeVar("Value")


class AsyncClient:
    """One connection, as Client. Several tasks may use it at the same time."""

    def __init__(self, url: str = "ws://127.0.0.1:8080/ws", timeout: float = 10,
                 tls: ssl.SSLContext | None = None) -> None:
        """`timeout` [s] is for each reply. `tls` has trusted certificates. None: the system's."""
        self.url = url
        self._address = Address.parse(url)
        self._tls = tls
        self.timeout = timeout
        self._exchange = Exchange()
        self._received = asyncio.Condition()
        self._ended: BaseException | None = None

    async def __aenter__(self) -> "AsyncClient":
        await self._connect()
        return self

    async def _connect(self) -> None:
        address = self._address
        tls = (self._tls or ssl.create_default_context()) if address.is_secure else None
        async with asyncio.timeout(self.timeout):
            self._reader, self._writer = await asyncio.open_connection(
                address.host, address.port, ssl=tls)
            handshake = Handshake(address)
            self._writer.write(handshake.request)
            head = await self._reader.readuntil(b"\r\n\r\n")
            try:
                handshake.check(head.removesuffix(b"\r\n\r\n"))
            except BaseException:
                self._writer.close()
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
        identity = self._exchange.request(method, params)
        replies = self._exchange.replies
        await self._wait(lambda: True if identity in replies else None, None)
        return self._exchange.take_reply(identity)

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
                self.url, self._address = error.moved_to, Address.parse(error.moved_to)
                self._exchange, self._ended = Exchange(), None
                await self._connect()
        raise AssertionError("the last attempt returns or raises")

    async def notify(self, method: str, **params: Any) -> None:
        """Sends a notification, which has no reply."""
        self._exchange.send(method, params)
        self._flush()
        await self._writer.drain()

    async def wait_event(self, name: str, timeout: float | None = None) -> dict[str, Any]:
        """Returns the params of the next event with this name. Discards others."""
        return await self._wait(lambda: self._exchange.take_event(name), timeout)

    async def next_frame(self, timeout: float | None = None) -> Frame:
        """Returns the next frame, decoded and acknowledged."""
        frame = await self._wait(self._exchange.take_frame, timeout)
        self._flush()
        return frame

    async def frames(self) -> AsyncIterator[Frame]:
        """Yields the frames of the subscription as they arrive."""
        while True:
            yield await self._wait(self._exchange.take_frame, float("inf"))
            self._flush()

    async def _wait(self, take: Callable[[], Value | None], timeout: float | None) -> Value:
        """Returns the first value of `take` that is not None."""
        self._flush()
        limit = self.timeout if timeout is None else timeout
        async with asyncio.timeout(None if limit == float("inf") else limit), self._received:
            while (value := take()) is None:
                if self._ended is not None:
                    raise self._ended
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
        except Exception as error:  # each later call raises it
            self._ended = error

    def _flush(self) -> None:
        if self._exchange.output:
            self._writer.write(bytes(self._exchange.output))
            self._exchange.output.clear()
