"""A server for tests in Python."""

import contextlib
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def serving(program: str, *arguments: str, cwd: Path | None = None) -> Iterator[str]:
    """Yields the WebSocket address of a server with these arguments, and ends the server."""
    command = [program, "serve", "--port", "0", "--log-level", "error", *arguments]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=cwd) as server:
        try:
            assert server.stdout is not None
            line = server.stdout.readline()
            found = re.search(r"http(s?)://(127\.0\.0\.1:\d+)/", line)
            assert found is not None, line
            yield f"ws{found[1]}://{found[2]}/ws"
        finally:
            server.terminate()
