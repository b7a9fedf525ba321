"""vat_client_test.py PROGRAM CERTIFICATE KEY: tests the Python client.

The tests cover functions beyond the example. Servers with TLS use this self-signed certificate.
"""

import re
import ssl
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests" / "protocol" / "scenes"
sys.path.insert(0, str(ROOT / "protocol" / "python"))

from vat_client import Client, Closed, VatError

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
