"""simulated_hash.py SCENES SCENE PROGRAM: checks that a session and `vat simulate` give the same
bits.
"""

import re
import subprocess
import sys
from pathlib import Path


def main():
    scenes, scene, program = sys.argv[1:]
    script = Path(__file__).with_suffix(".jsonl")
    simulate = [program, "simulate", f"{scenes}/{scene}.json", "--until", "2", "--hash"]
    output = subprocess.run(simulate, check=True, capture_output=True, text=True).stdout
    found = re.search(r"\bhash ([0-9a-f]{16}) (\w+)\b", output)
    if not found:
        sys.exit(f"no hash from {' '.join(simulate)}: {output!r}")
    play = [program, "script", script, "--scenes", scenes, "--scene", scene,
            "--set", "hash", found[1], "--set", "instruction_set", found[2]]
    return subprocess.run(play).returncode


if __name__ == "__main__":
    sys.exit(main())
