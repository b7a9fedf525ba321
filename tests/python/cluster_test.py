"""cluster_test.py VAT CLUSTER.md: the example and the permissions of the document, and the clients.

Both Python clients join a session of another node, and continue it at another node.
"""

import asyncio
import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from vat import AsyncClient, Client, Closed, VatError

ADMIN = "the token of an admin"
SECRETS = {"VAT_ACCESS": "token", "VAT_ADMIN_TOKEN": ADMIN,
           "VAT_CLUSTER_KEY": "a key of the cluster with sufficient length"}
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
        self.variables = {}

    def run_command(self, command, ready):
        """Starts a process, waits for a line of its output, and returns the process."""
        process = subprocess.Popen(command, cwd=self.folder.name, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True,
                                   env={**os.environ, **self.variables})
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        lines = []
        for line in process.stdout:
            lines.append(line)
            if ready in line:
                return process
        return self.fail("".join(lines))

    def start(self):
        """Returns the processes of the nodes by their names."""
        self.run_command(self.nats, "Server is ready")
        return {name: self.run_command(node, "vat is at")
                for name, node in zip(self.urls, self.nodes)}

    def owner(self):
        """Returns the name of the node with the first session, and the name of the other."""
        with Client(self.urls["a"]) as client:
            if self.variables:
                client.call("access.enter", token=ADMIN)
            [listed] = client.call("session.list")["sessions"]
        [other] = set(self.urls) - {listed["node"]}
        return listed["node"], other

    async def join_async(self, url, session):
        async with AsyncClient(url) as client:
            await client.join(session)
            return client.url

    def test_the_example_runs_and_clients_find_the_node_of_a_session(self):
        self.start()
        owner, other = (self.urls[name] for name in self.owner())
        with Client(other) as client:
            client.join("s1")
            self.assertEqual(client.url, owner)
        self.assertEqual(asyncio.run(self.join_async(other, "s1")), owner)

    def test_clients_continue_after_the_end_of_their_node(self):
        nodes = self.start()
        owner, other = self.owner()
        at_once = Client(self.urls[owner], reconnect_time=0)
        self.addCleanup(at_once.close)
        at_once.join("s1")
        # Take-overs of a busy machine can take longer than the default.
        with Client(self.urls[owner], reconnect_time=120) as client:
            client.join("s1", name="Ada")
            client.call("frames.subscribe")
            client.next_frame()
            asyncio.run(self.continue_async(nodes[owner], owner, other))
            client.next_frame()
            self.assertEqual(client.url, self.urls[other])
            names = [each["name"] for each in client.call("presence.list")["participants"]]
            self.assertEqual(names.count("Ada"), 1)
            self.assertEqual(names.count("Bob"), 1)
            client.call("world.set_gravity", gravity=[0, 0, -9])
        for _ in range(2):
            with self.assertRaises((ConnectionError, Closed)):
                at_once.call("session.hash")

    async def continue_async(self, process, owner, other):
        """Kills the node while a task waits for frames and another one for an event."""
        async with (asyncio.timeout(60),
                    AsyncClient([self.urls[owner], self.urls[other]]) as client):
            await client.join("s1", name="Bob")
            await client.call("frames.subscribe")
            await client.next_frame()
            epoch = (await client.next_frame()).epoch
            process.kill()
            await asyncio.to_thread(process.wait)
            frames = client.frames()
            while (await anext(frames)).epoch == epoch:
                pass
            self.assertEqual(client.url, self.urls[other])
            await client.call("world.set_gravity", gravity=[0, 0, -9])

    def test_clients_follow_a_session_that_moves(self):
        nodes = self.start()
        owner, other = self.owner()
        with Client(self.urls[owner]) as client:
            client.join("s1", name="Ada")
            nodes[owner].terminate()
            client.wait_event("session.moved")
            participants = client.call("presence.list")["participants"]
            self.assertEqual([each["name"] for each in participants], ["Ada"])
            self.assertEqual(client.url, self.urls[other])

    def test_clients_with_tokens_continue(self):
        self.variables = SECRETS
        nodes = self.start()
        owner, other = self.owner()
        with Client(self.urls[owner]) as admin:
            admin.call("access.enter", token=ADMIN)
            admin.join("s1")
            invitation = admin.call("session.invite", role="controller", uses=1)["token"]
        with Client(self.urls[other]) as client:
            client.call("access.enter", token=invitation)
            client.join()
            self.assertEqual(client.url, self.urls[owner])
            nodes[owner].kill()
            nodes[owner].wait()
            client.call("world.set_gravity", gravity=[0, 0, -9])  # needs the role controller
            self.assertEqual(client.url, self.urls[other])

    def test_clients_without_a_session_do_not_reconnect(self):
        nodes = self.start()
        with Client(self.urls["a"]) as client:
            client.call("server.info")
            nodes["a"].kill()
            nodes["a"].wait()
            for _ in range(2):
                with self.assertRaises(ConnectionError):
                    client.call("server.info")
        with Client([self.urls["a"], self.urls["b"]]) as client:  # the first one is down
            self.assertEqual(client.url, self.urls["b"])
        with self.assertRaises(ValueError):
            Client([])

    def test_the_documented_permissions_suffice(self):
        users = []
        for name in self.urls:
            lists = [f"{kind}: {subjects}" for kind, subjects in permissions(name).items()]
            self.assertEqual(len(lists), 2)
            users.append(f"{{user: {name}, password: secret, permissions: {{{', '.join(lists)}}}}}")
        config = f"authorization {{ users: [{', '.join(users)}] }}\n".replace("'", '"')
        (Path(self.folder.name) / "nats.conf").write_text(config)
        self.nats += ["--config", "nats.conf", "--log", "nats.log"]
        self.variables = SECRETS
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
            with Client(url) as client, Client(url) as guest:
                client.call("access.enter", token=ADMIN)
                client.join("s1")
                client.call("world.set_gravity", gravity=[0, 0, -9])
                invitation = client.call("session.invite", role="viewer", uses=1)["token"]
                self.assertEqual(guest.call("access.enter", token=invitation)["session"], "s1")
                guest.join()
                with Client(client.url) as late, self.assertRaises(VatError) as refused:
                    late.call("access.enter", token=invitation)
                self.assertEqual(refused.exception.kind, "not_authenticated")
        self.assertNotIn("iolation", log.read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
