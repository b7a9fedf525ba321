"""tutorial_test.py PROGRAM DOCUMENT: does all steps of a tutorial.

Writes its files, runs its commands, and compares their outputs. Numbers of outputs may differ, and
the lines of programs that run at the same time may have another order.
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

PROGRAM, DOCUMENT = sys.argv[1:]
BLOCK = re.compile(r"(?:<!-- ([^\n]*) -->\n\n)?^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
ADDRESS = "127.0.0.1:8080"
PATIENCE = 120  # [s]


@dataclass
class Block:
    note: str
    language: str
    text: str


def blocks_of(document: Path) -> list[Block]:
    return [Block(note or "", language, text)
            for note, language, text in BLOCK.findall(document.read_text("utf-8"))]


def without_numbers(text: str) -> list[str]:
    return sorted(re.sub(r"-?\d+(\.\d+)?", "#", line) for line in text.splitlines())


class Learner:
    """A person who follows a tutorial."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.address = ADDRESS
        self.server: subprocess.Popen[str] | None = None
        command = folder / "vat"
        command.write_text(f'#!/bin/sh\nexec "{PROGRAM}" "$@"\n')
        command.chmod(0o755)

    def write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text.replace(ADDRESS, self.address))

    def serve(self, command: str) -> str:
        """Starts a server in place of the last one. Returns its last line of the start."""
        self.stop()
        self.server = subprocess.Popen(
            [*command.split(), "--port", "0", "--log-level", "error"], cwd=self.folder,
            stdout=subprocess.PIPE, text=True)
        assert self.server.stdout is not None
        line = self.server.stdout.readline()
        found = re.search(r"http://(127\.0\.0\.1:\d+)/", line)
        assert found is not None, line
        self.address = found[1]
        return line

    def run(self, commands: str) -> str:
        python = Path(sys.executable)
        text = commands.replace("python3 ", f"{python} -B ")
        # Unbuffered, two programs could write parts of their lines in turn.
        environment = {**os.environ, "PYTHONUNBUFFERED": ""}
        done = subprocess.run(["bash", "-ec", text], cwd=self.folder, env=environment, text=True,
                              stdout=subprocess.PIPE, timeout=PATIENCE, check=True)
        return done.stdout

    def stop(self) -> None:
        if self.server is not None:
            self.server.terminate()
            self.server.communicate()


class Tutorial(unittest.TestCase):
    def test_all_steps(self) -> None:
        blocks = blocks_of(Path(DOCUMENT))
        self.assertEqual(len(re.findall(r"^## \d", Path(DOCUMENT).read_text("utf-8"), re.M)), 8)
        output = ""
        compared = 0
        with tempfile.TemporaryDirectory() as folder:
            learner = Learner(Path(folder))
            self.addCleanup(learner.stop)
            for block in blocks:
                if block.note.startswith("file: "):
                    learner.write(block.note.removeprefix("file: "), block.text)
                elif block.language == "text":
                    self.assertEqual(without_numbers(output), without_numbers(block.text))
                    compared += 1
                elif block.text.startswith("./vat serve"):
                    output = learner.serve(block.text)
                elif not block.note.startswith("not run"):
                    self.assertEqual(block.language, "sh", block.text)
                    output = learner.run(block.text)
        self.assertGreater(compared, 4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
