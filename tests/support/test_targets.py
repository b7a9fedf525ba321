"""test_targets.py BUILD_FOLDER < chosen.json: prints the ninja targets of the chosen tests.

Reads the output of `ctest --show-only=json-v1`. Prints one target per line. Prints nothing if no
test is chosen or if the tests of a chosen program are unknown, so that everything must be built.
"""

import json
import re
import subprocess
import sys


def main():
    folder = sys.argv[1]
    tests = json.load(sys.stdin)["tests"]
    if not tests or any(test["name"].endswith("_NOT_BUILT") for test in tests):
        return
    listed = subprocess.run(
        ["ninja", "-C", folder, "-t", "targets", "all"], check=True, capture_output=True, text=True)
    linked = {line.split(": ")[0] for line in listed.stdout.splitlines()
              if re.search("CXX_(EXECUTABLE|STATIC_LIBRARY)_LINKER", line)}
    paths = re.findall(re.escape(folder) + r"/([\w./-]+)", json.dumps(tests))
    chosen = linked.intersection(paths)
    if any(path.split("/")[0] == "python" for path in paths):
        chosen.add("vat_python")
    # Without targets, ninja builds all.
    print("\n".join(sorted(chosen) or ["vat"]))


if __name__ == "__main__":
    main()
