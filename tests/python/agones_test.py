"""agones_test.py VAT AGONES.SH: the script for game servers of Agones, with a sidecar of the test."""

import http.server
import os
import queue
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

from vat import Client

PROGRAM, SCRIPT = sys.argv[1:]
ANSWER_SECONDS = 60


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


class Sidecar:
    """Collects the reports, as the sidecar of Agones."""

    def __init__(self, port):
        reports = queue.Queue()

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                self.send_response(200 if body == b"{}" else 400)
                self.end_headers()
                self.wfile.write(b"{}")
                reports.put(self.path)

            def log_message(self, *_):
                pass

        self.reports = reports
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        threading.Thread(target=self.server.serve_forever).start()

    def next(self):
        return self.reports.get(timeout=ANSWER_SECONDS)

    def until(self, report):
        """Returns the reports before this one."""
        before = []
        while (found := self.next()) != report:
            before.append(found)
        return before

    def close(self):
        self.server.shutdown()
        self.server.server_close()


class Agones(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        (Path(folder.name) / "vat").symlink_to(PROGRAM)
        self.port, self.sidecar_port = free_port(), free_port()
        self.environment = {**os.environ, "PATH": f"{folder.name}:{os.environ['PATH']}",
                            "VAT_PORT": str(self.port), "VAT_LOG_LEVEL": "warn",
                            "AGONES_SDK_HTTP_PORT": str(self.sidecar_port)}

    def start(self, **settings):
        self.script = subprocess.Popen([SCRIPT, "serve"], env={**self.environment, **settings},
                                       text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.script.communicate)
        self.addCleanup(self.script.terminate)
        while "vat is at" not in (line := self.script.stdout.readline()):
            self.assertTrue(line, "the server has ended")

    def start_sidecar(self):
        sidecar = Sidecar(self.sidecar_port)
        self.addCleanup(sidecar.close)
        return sidecar

    def test_a_late_sidecar_gets_readiness_then_health_and_the_end(self):
        self.start()
        sidecar = self.start_sidecar()
        self.assertEqual([sidecar.next() for _ in range(3)], ["/ready", "/health", "/health"])
        self.script.send_signal(signal.SIGTERM)
        self.assertLessEqual(set(sidecar.until("/shutdown")), {"/health"})
        self.assertEqual(self.script.wait(ANSWER_SECONDS), 0)

    def test_a_server_without_clients_ends_after_its_first_client(self):
        self.start(AGONES_EMPTY_SECONDS="1", VAT_ACCESS="token", VAT_ADMIN_TOKEN="admin" * 5)
        sidecar = self.start_sidecar()
        for _ in range(3):
            self.assertNotEqual(sidecar.next(), "/shutdown")  # without a client before
        with Client(f"ws://127.0.0.1:{self.port}/ws") as client:
            client.call("access.enter", token="admin" * 5)
            client.join()
            for _ in range(4):
                self.assertEqual(sidecar.next(), "/health")
        self.assertLessEqual(set(sidecar.until("/shutdown")), {"/health"})
        self.assertEqual(self.script.wait(ANSWER_SECONDS), 0)

    def test_an_invalid_option_is_the_exit_code_and_an_end(self):
        sidecar = self.start_sidecar()
        run = subprocess.run([SCRIPT, "serve", "--port", "no"], capture_output=True, text=True,
                             env=self.environment)
        self.assertEqual(run.returncode, 2, run.stderr)
        self.assertEqual(sidecar.next(), "/shutdown")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], verbosity=2)
