"""documents_test.py PROGRAM DOCUMENT...: runs the Python examples of documents with a server."""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

from serving import serving

PROGRAM, *DOCUMENTS = sys.argv[1:]
ADDRESS = "ws://127.0.0.1:8080/ws"
PATIENCE = 120  # [s]


def examples(document: Path) -> list[tuple[str, str]]:
    """Returns (place, program) of each example."""
    text = document.read_text("utf-8")
    return [(f"{document.name}:{text[:block.start()].count(chr(10)) + 1}", block[1])
            for block in re.finditer(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)]


class Documents(unittest.TestCase):
    def run_example(self, program: str, folder: str) -> None:
        done = subprocess.run([sys.executable, "-B", "-c", program], cwd=folder, env=os.environ,
                              text=True, check=False, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_examples(self) -> None:
        for document in map(Path, DOCUMENTS):
            programs = examples(document)
            self.assertNotEqual(programs, [], document)
            with tempfile.TemporaryDirectory() as folder, serving(PROGRAM) as url:
                for place, program in programs:
                    with self.subTest(place):
                        self.run_example(program.replace(ADDRESS, url), folder)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
