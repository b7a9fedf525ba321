"""same_bits.py SCENE.json SECONDS PROGRAM [SCENE_HASH]: one hash for 1, 2 and 4 threads.

SCENE_HASH is a program built with other options; its hash must be the same too.
"""

import re
import subprocess
import sys


def last_hash(*command):
    output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    found = re.findall(r"\b[0-9a-f]{16}\b", output)
    if not found:
        sys.exit(f"no hash from {' '.join(command)}: {output!r}")
    return found[-1]


def main():
    scene, seconds, program, *others = sys.argv[1:]
    hashes = {
        f"{threads} threads": last_hash(
            program, "simulate", scene, "--until", seconds, "--threads", threads, "--hash")
        for threads in ("1", "2", "4")
    }
    for other in others:
        hashes["other compiler options"] = last_hash(other, scene, seconds)
    for name, value in hashes.items():
        print(f"{value}  {name}")
    return 0 if len(set(hashes.values())) == 1 else 1


if __name__ == "__main__":
    sys.exit(main())
