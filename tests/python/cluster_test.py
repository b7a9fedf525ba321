"""cluster_test.py VAT SCENES: both clients join a session of another node of a cluster."""

import asyncio
import shutil
import socket
import subprocess
import sys
import tempfile

from vat import AsyncClient, Client

NATS = shutil.which("nats-server") or "/usr/sbin/nats-server"


def free_port():
    with socket.socket() as any_port:
        any_port.bind(("127.0.0.1", 0))
        return any_port.getsockname()[1]


def start(command, ready):
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in process.stdout:
        if ready in line:
            return process
    raise RuntimeError(f"{command[0]} did not start")


async def join_async(url, session):
    async with AsyncClient(url) as client:
        await client.join(session)
        return client.url


def main(program, scenes):
    processes = []
    with tempfile.TemporaryDirectory() as folder:
        try:
            port = free_port()
            processes.append(start(
                [NATS, "-js", "-sd", f"{folder}/nats", "-a", "127.0.0.1",
                 "-p", str(port)], "Server is ready"))
            urls = {}
            for name in "ab":
                own = free_port()
                urls[name] = f"ws://127.0.0.1:{own}/ws"
                processes.append(start(
                    [program, "serve", "--cluster", f"nats://127.0.0.1:{port}", "--node", name,
                     "--public-url", urls[name], "--port", str(own), "--data", f"{folder}/{name}",
                     "--scenes", scenes, "--scene", "pool"], "vat is at"))
            client = Client(urls["a"])
            [listed] = client.call("session.list")["sessions"]
            owner = urls[listed["node"]]
            [other] = set(urls.values()) - {owner}
            client.close()
            client = Client(other)
            client.join(listed["session"])
            assert client.url == owner, client.url
            client.close()
            joined = asyncio.run(join_async(other, listed["session"]))
            assert joined == owner, joined
        finally:
            for process in processes:
                process.kill()
                process.communicate()


if __name__ == "__main__":
    main(*sys.argv[1:])
