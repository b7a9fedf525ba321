"""run_example.py PROGRAM EXPECTED COMMAND...: runs COMMAND with a server.

The address of a separate server is the last argument of COMMAND. It must succeed and print the
content of the file EXPECTED.
"""

import difflib
import re
import subprocess
import sys
from pathlib import Path

SCENES = Path(__file__).resolve().parents[1] / "protocol" / "scenes"
PATIENCE = 60


def main():
    program, expected, *command = sys.argv[1:]
    serve = [program, "serve", "--port", "0", "--scenes", SCENES, "--scene", "pool",
             "--log-level", "error"]
    with subprocess.Popen(serve, stdout=subprocess.PIPE, text=True) as server:
        try:
            secure, port = re.search(r"http(s?)://127\.0\.0\.1:(\d+)/",
                                     server.stdout.readline()).groups()
            done = subprocess.run([*command, f"ws{secure}://127.0.0.1:{port}/ws"], text=True,
                                  stdout=subprocess.PIPE, timeout=PATIENCE)
        finally:
            server.terminate()
    wanted = Path(expected).read_text("utf-8")
    sys.stdout.writelines(difflib.unified_diff(
        wanted.splitlines(True), done.stdout.splitlines(True), "expected", "printed"))
    return done.returncode or int(done.stdout != wanted)


if __name__ == "__main__":
    sys.exit(main())
