"""vat_client_test.py PROGRAM CERTIFICATE KEY: tests the Python client.

The tests cover functions beyond the example. Servers with TLS use this self-signed certificate.
"""

import json
import re
import ssl
import subprocess
import sys
import unittest
from collections import deque
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests" / "protocol" / "scenes"
sys.path.insert(0, str(ROOT / "protocol" / "python"))

from vat_client import BINARY, EVENTS_KEPT, TEXT, Client, Closed, VatError

PROGRAM, CERTIFICATE, KEY = (sys.argv.pop(1) for _ in range(3))


class ServerTest(unittest.TestCase):
    """Base class of tests that share a server."""

    arguments = ()

    @classmethod
    def setUpClass(cls):
        cls.server = subprocess.Popen(
            [PROGRAM, "serve", "--port", "0", "--scenes", SCENES, "--scene", "pool",
             "--log-level", "error", *cls.arguments], stdout=subprocess.PIPE, text=True)
        secure, port = re.search(r"http(s?)://127\.0\.0\.1:(\d+)/",
                                 cls.server.stdout.readline()).groups()
        cls.url = f"ws{secure}://127.0.0.1:{port}/ws"

    @classmethod
    def tearDownClass(cls):
        cls.server.terminate()
        cls.server.wait()
        cls.server.stdout.close()


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
            ticks = [client.next_frame().header.tick for _ in range(10)]  # a window is 3 frames
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


class ScriptedSocket:
    """A socket whose messages are those of the test."""

    def __init__(self, *_):
        self.messages = deque()
        self.sent = []

    def send(self, opcode, payload):
        if opcode == TEXT:
            self.sent.append(json.loads(payload))

    def receive(self, _):
        if not self.messages:
            raise TimeoutError
        return self.messages.popleft()

    def tell(self, **message):
        self.messages.append((TEXT, json.dumps({"jsonrpc": "2.0", **message}).encode()))


class ScriptedServer(unittest.TestCase):
    def setUp(self):
        with mock.patch("vat_client.WebSocket", ScriptedSocket):
            self.client = Client()
        self.socket = self.client.socket

    def test_unknown_events_and_members_are_ignored(self):
        self.socket.tell(method="moon.rose", params={"phase": 1}, source="sky")
        self.socket.tell(method="moon.set")
        self.socket.tell(method="session.closed", params={"session": "s1", "moon": 1})
        self.socket.tell(id=1, result={"tick": 3, "moon": "new"}, source="sky")
        self.assertEqual(self.client.call("control.pause")["tick"], 3)
        self.assertEqual(self.client.wait_event("session.closed")["session"], "s1")

    def test_the_oldest_events_that_nobody_takes_are_dropped(self):
        for number in range(EVENTS_KEPT + 5):
            self.socket.tell(method="session.status", params={"tick": number})
        self.socket.tell(id=1, result={})
        self.client.call("session.hash")
        self.assertEqual(len(self.client.events), EVENTS_KEPT)
        self.assertEqual(self.client.wait_event("session.status")["tick"], 5)

    def test_a_frame_that_lacks_its_reference_is_rejected_once(self):
        for name in ("delta-one", "delta-two", "key", "delta-one"):
            frame = (ROOT / "tests" / "golden" / "frames" / f"v2-{name}.bin").read_bytes()
            self.socket.messages.append((BINARY, frame))
        self.assertEqual(self.client.next_frame().header.number, 10)
        self.assertEqual(self.client.next_frame().header.number, 12)
        self.assertEqual([message["params"] for message in self.socket.sent],
                         [{"number": 12, "rejected": True}, {"number": 13}, {"number": 10},
                          {"number": 12}])


class FullServer(ServerTest):
    arguments = ("--max-connections", "3")

    def test_the_end_of_a_connection_is_told(self):
        clients = [Client(self.url) for _ in range(3)]
        extra = Client(self.url)
        with self.assertRaises(Closed) as closed:
            extra.call("server.info")
        self.assertEqual(closed.exception.code, 1013)
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

    def test_who_is_not_trusted_is_refused(self):
        with self.assertRaises(ssl.SSLCertVerificationError):
            Client(self.url)

    def test_a_certificate_is_for_one_server(self):
        with self.assertRaises(ssl.SSLCertVerificationError):
            Client(self.url.replace("127.0.0.1", "127.1"),  # another name of the same address
                   tls=ssl.create_default_context(cafile=CERTIFICATE))


if __name__ == "__main__":
    unittest.main()
