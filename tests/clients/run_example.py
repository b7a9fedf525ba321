"""run_example.py [--catalogue] PROGRAM EXPECTED COMMAND...: runs COMMAND with a server.

The server has the scenes of the tests, or with --catalogue the scenes of the program. Its address is
the last argument of COMMAND, whose input has ten empty lines. COMMAND must succeed and print the
content of the file EXPECTED. A line of EXPECTED that starts with "~ " is a regular expression.
"""

import difflib
import re
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TESTS / "support"))

from serving import serving

SCENES = TESTS / "protocol" / "scenes"
PATIENCE = 60


def matches(pattern, line):
    return re.fullmatch(pattern[2:], line) if pattern.startswith("~ ") else pattern == line


def with_matches(wanted, printed):
    """Returns `wanted` with the printed lines in place of the expressions that match them."""
    pairs = zip(wanted, printed + [""] * len(wanted))
    return [line if matches(pattern, line) else pattern for pattern, line in pairs]


def main():
    arguments = sys.argv[1:]
    scenes = ["--scenes", SCENES, "--scene", "pool"]
    if arguments[0] == "--catalogue":
        arguments, scenes = arguments[1:], []
    program, expected, *command = arguments
    with serving(program, *scenes) as url:
        done = subprocess.run([*command, url], text=True, input="\n" * 10, stdout=subprocess.PIPE,
                              timeout=PATIENCE)
    printed = done.stdout.splitlines()
    wanted = with_matches(Path(expected).read_text("utf-8").splitlines(), printed)
    print(*difflib.unified_diff(wanted, printed, "expected", "printed", lineterm=""), sep="\n")
    return done.returncode or int(printed != wanted)


if __name__ == "__main__":
    sys.exit(main())
