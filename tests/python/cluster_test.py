"""cluster_test.py VAT CLUSTER.md: the example and the permissions of the document, and the clients.

Both Python clients join a session of another node.
"""

import asyncio
import re
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from vat import AsyncClient, Client

PROGRAM = sys.argv[1]
DOCUMENT = Path(sys.argv[2]).read_text()
NATS = shutil.which("nats-server") or "/usr/sbin/nats-server"


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


def example():
    """Returns the commands of the document with free ports, and the URLs of the nodes."""
    text = "\n".join(re.findall(r"^    (.*)$", DOCUMENT, re.MULTILINE))
    ports = {port: str(free_port()) for port in ("4222", "8081", "8082")}
    text = re.sub("|".join(ports), lambda match: ports[match.group()], text)
    nats, *nodes = [shlex.split(line) for line in text.splitlines()]
    nats = [NATS, *nats[1:], "--addr", "127.0.0.1", "--port", ports["4222"]]
    urls = {node[node.index("--node") + 1]: node[node.index("--public-url") + 1] for node in nodes}
    return nats, [[PROGRAM, *node[1:]] for node in nodes], urls


def permissions(node):
    """Returns the row of the table as a list of subjects for each kind."""
    rows = re.findall(r"^\| (publish|subscribe) \| (.*) \|$", DOCUMENT, re.MULTILINE)
    return {kind: [subject.replace("NAME", node) for subject in re.findall("`(.*?)`", subjects)]
            for kind, subjects in rows}


class Cluster(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.nats, self.nodes, self.urls = example()

    def run_command(self, command, ready):
        """Starts a process and waits for a line of its output."""
        process = subprocess.Popen(command, cwd=self.folder.name, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        lines = []
        for line in process.stdout:
            lines.append(line)
            if ready in line:
                return
        self.fail("".join(lines))

    def start(self):
        self.run_command(self.nats, "Server is ready")
        for node in self.nodes:
            self.run_command(node, "vat is at")

    async def join_async(self, url, session):
        async with AsyncClient(url) as client:
            await client.join(session)
            return client.url

    def test_the_example_runs_and_clients_find_the_node_of_a_session(self):
        self.start()
        with Client(self.urls["a"]) as client:
            [listed] = client.call("session.list")["sessions"]
        owner = self.urls[listed["node"]]
        [other] = set(self.urls.values()) - {owner}
        with Client(other) as client:
            client.join(listed["session"])
            self.assertEqual(client.url, owner)
        self.assertEqual(asyncio.run(self.join_async(other, listed["session"])), owner)

    def test_the_documented_permissions_suffice(self):
        users = []
        for name in self.urls:
            lists = [f"{kind}: {subjects}" for kind, subjects in permissions(name).items()]
            self.assertEqual(len(lists), 2)
            users.append(f"{{user: {name}, password: secret, permissions: {{{', '.join(lists)}}}}}")
        config = f"authorization {{ users: [{', '.join(users)}] }}\n".replace("'", '"')
        (Path(self.folder.name) / "nats.conf").write_text(config)
        self.nats += ["--config", "nats.conf", "--log", "nats.log"]
        for name, node in zip(self.urls, self.nodes):
            node[:] = [word.replace("nats://", f"nats://{name}:secret@") for word in node]
        log = Path(self.folder.name) / "nats.log"
        process = subprocess.Popen(self.nats, cwd=self.folder.name)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        while not log.exists() or "Server is ready" not in log.read_text():
            self.assertIsNone(process.poll())
        for node in self.nodes:
            self.run_command(node, "vat is at")
        for url in self.urls.values():
            with Client(url) as client:
                client.join("s1")
                client.call("world.set_gravity", gravity=[0, 0, -9])
        self.assertNotIn("iolation", log.read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
