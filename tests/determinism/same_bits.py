"""same_bits.py SCENE.json SECONDS PROGRAM HASHES.json: compares the state hash with the stored one.

Each instruction set of this machine runs with another number of threads. The hashes were stored
with two threads. Hashes of unavailable instruction sets are not compared.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

THREADS = {"baseline": "4", "avx2": "2", "avx512": "1"}


def state_hash(program, scene, seconds, instruction_set, threads):
    """Returns the hash of the last state, or None if this machine lacks the instruction set."""
    run = subprocess.run(
        [program, "simulate", scene, "--until", seconds, "--threads", threads,
         "--isa", instruction_set, "--hash"], capture_output=True, text=True)
    if run.returncode != 0 and "instruction set" in run.stderr:
        return None
    found = re.findall(r"^hash ([0-9a-f]{16}) (\w+)$", run.stdout, re.MULTILINE)
    if run.returncode != 0 or not found or found[-1][1] != instruction_set:
        sys.exit(f"no hash of {instruction_set}: {run.stdout}{run.stderr}")
    return found[-1][0]


def main():
    scene, seconds, program, hashes = sys.argv[1:]
    file = pathlib.Path(hashes)
    stored = json.loads(file.read_text()) if file.exists() else {}
    updates = os.environ.get("VAT_UPDATE_GOLDEN") == "1"
    expected = stored.setdefault(pathlib.Path(scene).stem, {}).setdefault(seconds, {})
    status = 0
    for instruction_set, threads in THREADS.items():
        value = state_hash(program, scene, seconds, instruction_set, "2" if updates else threads)
        if value is None:
            continue
        if updates:
            expected[instruction_set] = value
        same = value == expected.get(instruction_set)
        print(f"{value} {instruction_set}, {threads} threads" + ("" if same else
              f": stored is {expected.get(instruction_set)}"))
        status = status if same else 1
    if updates:
        file.write_text(json.dumps(stored, indent=2, sort_keys=True) + "\n")
    return status


if __name__ == "__main__":
    sys.exit(main())
