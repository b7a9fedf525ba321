"""times.py BUILD_FOLDER JUNIT.xml: prints the slowest sources and tests, and sums per suite.

Reads the times of ninja's log and of ctest's report. All times are wall seconds.
"""

import collections
import pathlib
import re
import sys
import xml.etree.ElementTree

LONGEST = 10


def edges(folder):
    """Returns seconds by output file. The last line about a file counts."""
    seconds = {}
    for line in (folder / ".ninja_log").read_text().splitlines()[1:]:
        start, end, _, output, _ = line.split("\t")
        seconds[output] = (int(end) - int(start)) / 1000
    return seconds


def sources(folder, output):
    """Returns the sources that were compiled together, as one text."""
    unity = folder / output.removesuffix(".o")
    if "/Unity/" not in output or not unity.exists():
        return re.sub(r"CMakeFiles/[^/]*\.dir/|\.o$", "", output)
    names = re.findall(r'^#include "([^"]+)"', unity.read_text(), re.MULTILINE)
    paths = [pathlib.Path(name) for name in names]
    return f"{paths[0].parent.name}/" + ", ".join(path.stem for path in paths)


def program(output):
    """Returns the library or program of an object, or None."""
    found = re.search(r"CMakeFiles/(\w+)\.dir/", output)
    return found.group(1) if found else None


def show(title, seconds):
    print(f"\n{title}")
    for name, value in sorted(seconds.items(), key=lambda item: -item[1])[:LONGEST]:
        print(f"{value:9.1f} s  {name if len(name) < 140 else name[:137] + '...'}")


def show_sums(title, pairs):
    sums = collections.defaultdict(lambda: [0, 0.0])
    for name, value in pairs:
        sums[name][0] += 1
        sums[name][1] += value
    print(f"\n{title}")
    for name, (count, value) in sorted(sums.items(), key=lambda item: -item[1][1]):
        print(f"{value:9.1f} s  {count:5}  {name}")


def main():
    folder = pathlib.Path(sys.argv[1])
    compiled = {output: value for output, value in edges(folder).items()
                if output.endswith((".o", ".gch"))}
    cases = xml.etree.ElementTree.parse(sys.argv[2]).getroot().iter("testcase")
    tests = {case.get("name"): float(case.get("time")) for case in cases}
    show("longest to compile", {sources(folder, output): v for output, v in compiled.items()})
    show("longest tests", tests)
    show_sums("compilation by target: sum, units",
              [(program(output) or output, value) for output, value in compiled.items()])
    show_sums("tests by suite: sum, tests",
              [(name.partition("/")[0], value) for name, value in tests.items()])


if __name__ == "__main__":
    main()
