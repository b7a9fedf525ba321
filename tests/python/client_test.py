"""client_test.py PROGRAM CERTIFICATE KEY: tests the clients.

Servers with TLS use this self-signed certificate.
"""

import asyncio
import json
import ssl
import struct
import sys
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests" / "protocol" / "scenes"
sys.path.insert(0, str(ROOT / "tests" / "support"))

import vat
from serving import serving
from vat import Client, Closed, VatError
from vat.exchange import EVENTS_KEPT, Exchange
from vat.websocket import BINARY, CONTINUATION, PING, PONG, TEXT

PROGRAM, CERTIFICATE, KEY = (sys.argv.pop(1) for _ in range(3))


class ServerTest(unittest.TestCase):
    """Base class of tests that share a server."""

    arguments = ()

    @classmethod
    def setUpClass(cls):
        cls.url = cls.enterClassContext(
            serving(PROGRAM, "--scenes", str(SCENES), "--scene", "pool", *cls.arguments))


class VatClient(ServerTest):
    def test_messages_of_every_length(self):
        with Client(self.url) as client:
            for length in (0, 100, 125, 126, 200, 60000):
                with self.assertRaises(VatError) as refused:
                    client.call("session.join", session="x" * length)
                wanted = "no_such_session" if length <= 64 else "invalid_params"
                self.assertEqual(refused.exception.kind, wanted)
                self.assertEqual(refused.exception.data["path"], "/session")
            with self.assertRaises(VatError) as refused:
                client.call("server.info", x="x" * 70000)
            self.assertEqual(refused.exception.data["limit"], "message_bytes")

    def test_frames_come_decoded_and_are_acknowledged(self):
        with Client(self.url) as client:
            client.call("session.join")
            client.call("frames.subscribe")
            ticks = [client.next_frame().tick for _ in range(10)]  # a window is 3 frames
            self.assertEqual(ticks, sorted(ticks))
            self.assertGreater(ticks[-1], ticks[0])

    def test_events_wait_for_who_asks(self):
        with Client(self.url) as client:
            client.call("session.join")
            client.call("control.set_speed", speed=2)
            while client.wait_event("session.status")["speed"] != 2:
                pass
            client.notify("control.set_speed", speed=1)
            while client.wait_event("session.status")["speed"] != 1:
                pass

    def test_waits_no_longer_than_it_is_told(self):
        with Client(self.url) as client, self.assertRaises(TimeoutError):
            client.wait_event("session.status", timeout=0.05)

    def test_what_is_no_server_is_refused(self):
        with self.assertRaises(ValueError):
            Client("http://127.0.0.1")
        with self.assertRaises(ValueError):
            Client("wss://")
        with self.assertRaises(ConnectionError):
            Client(self.url.replace("/ws", "/elsewhere"))


def message(opcode: int, payload: bytes) -> bytes:
    """Returns a frame of a server, which is not masked."""
    return struct.pack(">BBQ", 0x80 | opcode, 127, len(payload)) + payload


class Messages(unittest.TestCase):
    """Tests the exchange of both clients with messages that no server sends."""

    def setUp(self) -> None:
        self.exchange = Exchange()

    def tell(self, **members: Any) -> None:
        self.exchange.receive(message(TEXT, json.dumps({"jsonrpc": "2.0", **members}).encode()))

    def sent(self) -> list[dict[str, Any]]:
        """Returns the messages of the client."""
        messages, output = [], bytes(self.exchange.output)
        while output:
            size, begin = output[1] & 127, 2
            if size == 126:
                size, begin = int.from_bytes(output[2:4], "big"), 4
            mask, masked = output[begin:begin + 4], output[begin + 4:begin + 4 + size]
            messages.append(json.loads(bytes(b ^ mask[i % 4] for i, b in enumerate(masked))))
            output = output[begin + 4 + size:]
        return messages

    def test_unknown_events_and_members_are_ignored(self) -> None:
        identity = self.exchange.request("control.pause", {})
        self.tell(method="moon.rose", params={"phase": 1}, source="sky")
        self.tell(method="moon.set")
        self.tell(method="session.closed", params={"session": "s1", "moon": 1})
        self.tell(id=identity, result={"tick": 3, "moon": "new"}, source="sky")
        self.assertEqual(self.exchange.take_reply(identity)["tick"], 3)
        self.assertEqual(self.exchange.take_event("session.closed"), {"session": "s1", "moon": 1})

    def test_the_oldest_events_are_dropped(self) -> None:
        for number in range(EVENTS_KEPT + 5):
            self.tell(method="session.status", params={"tick": number})
        self.assertEqual(len(self.exchange.events), EVENTS_KEPT)
        self.assertEqual(self.exchange.take_event("session.status"), {"tick": 5})

    def test_a_frame_that_lacks_its_reference_is_rejected_once(self) -> None:
        for name in ("delta-one", "delta-two", "key", "delta-one"):
            frame = (ROOT / "tests" / "golden" / "frames" / f"v2-{name}.bin").read_bytes()
            self.exchange.receive(message(BINARY, frame))
        frames = [self.exchange.take_frame() for _ in range(3)]
        self.assertEqual([frame and frame.number for frame in frames], [10, 12, None])
        self.assertEqual([each["params"] for each in self.sent()],
                         [{"number": 12, "rejected": True}, {"number": 13}, {"number": 10},
                          {"number": 12}])

    def test_messages_arrive_in_any_parts(self) -> None:
        data = message(PING, b"a") + b"".join(
            message(TEXT, json.dumps({"method": "e", "params": {"n": n}}).encode())
            for n in range(3))
        for size in (1, 7, len(data)):
            exchange = Exchange()
            for begin in range(0, len(data), size):
                exchange.receive(data[begin:begin + size])
            self.assertEqual([params["n"] for _, params in exchange.events], [0, 1, 2])
            self.assertEqual(exchange.output[0], 0x80 | PONG)

    def test_a_message_in_fragments(self) -> None:
        text = json.dumps({"method": "e", "params": {"n": 1}}).encode()
        for first, opcode, part in ((0, TEXT, text[:5]), (0, CONTINUATION, text[5:9]),
                                    (0x80, CONTINUATION, text[9:])):
            self.exchange.receive(struct.pack(">BB", first | opcode, len(part)) + part)
        self.assertEqual(self.exchange.take_event("e"), {"n": 1})


class Asynchronous(ServerTest):
    """Tests the client for asyncio."""

    def test_tasks_share_a_connection(self) -> None:
        async def use() -> None:
            async with vat.AsyncClient(self.url) as client:
                await client.call("session.join")
                await client.call("frames.subscribe")
                ticks: list[int] = []

                async def watch() -> None:
                    async for frame in client.frames():
                        ticks.append(frame.tick)
                        if len(ticks) == 10:  # a window is 3 frames
                            return

                hashes = (client.call("session.hash") for _ in range(5))
                _, *replies = await asyncio.gather(watch(), *hashes)
                self.assertEqual(ticks, sorted(ticks))
                self.assertGreater(ticks[-1], ticks[0])
                self.assertTrue(all(len(reply["hash"]) == 16 for reply in replies))
                await client.notify("control.set_speed", speed=2)
                while (await client.wait_event("session.status"))["speed"] != 2:
                    pass
                await client.call("control.set_speed", speed=1)
                self.assertGreater((await client.next_frame()).tick, ticks[-1])

        asyncio.run(use())

    def test_errors(self) -> None:
        async def use() -> None:
            async with vat.AsyncClient(self.url) as client:
                with self.assertRaises(vat.VatError) as refused:
                    await client.call("session.join", session="x")
                self.assertEqual(refused.exception.kind, "no_such_session")
                with self.assertRaises(TimeoutError):
                    await client.wait_event("session.closed", timeout=0.05)
            with self.assertRaises(ConnectionError):
                async with vat.AsyncClient(self.url.replace("/ws", "/elsewhere")):
                    pass

        asyncio.run(use())


class FullServer(ServerTest):
    arguments = ("--max-connections", "3")

    def test_the_end_of_a_connection_is_told(self):
        clients = [Client(self.url) for _ in range(3)]
        extra = Client(self.url)
        with self.assertRaises(Closed) as closed:
            extra.call("server.info")
        self.assertEqual(closed.exception.code, 1013)

        async def use() -> None:
            async with vat.AsyncClient(self.url) as late:
                for _ in range(2):
                    with self.assertRaises(Closed) as closed:
                        await late.call("server.info")
                    self.assertEqual(closed.exception.code, 1013)

        asyncio.run(use())
        for client in [*clients, extra]:
            client.close()


class SecureServer(ServerTest):
    arguments = ("--tls-certificate", CERTIFICATE, "--tls-key", KEY)

    def test_messages_of_every_kind(self):
        with Client(self.url, tls=ssl.create_default_context(cafile=CERTIFICATE)) as client:
            self.assertEqual(client.call("session.join")["description"]["scene"], "pool")
            client.call("frames.subscribe")
            for _ in range(10):
                client.next_frame()
            with self.assertRaises(VatError) as refused:
                client.call("server.info", x="x" * 70000)
            self.assertEqual(refused.exception.data["limit"], "message_bytes")
            with self.assertRaises(TimeoutError):
                client.wait_event("session.closed", timeout=0.05)

    def test_asyncio(self):
        async def use() -> None:
            tls = ssl.create_default_context(cafile=CERTIFICATE)
            async with vat.AsyncClient(self.url, tls=tls) as client:
                self.assertEqual((await client.call("session.join"))["description"]["scene"], "pool")

        asyncio.run(use())

    def test_who_is_not_trusted_is_refused(self):
        with self.assertRaises(ssl.SSLCertVerificationError):
            Client(self.url)

    def test_a_certificate_is_for_one_server(self):
        with self.assertRaises(ssl.SSLCertVerificationError):
            Client(self.url.replace("127.0.0.1", "127.1"),  # another name of the same address
                   tls=ssl.create_default_context(cafile=CERTIFICATE))


if __name__ == "__main__":
    unittest.main()
