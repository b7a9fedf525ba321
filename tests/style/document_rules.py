"""Rules that compare documents with their subjects. A rule is a function: Tree -> list of faults."""

import posixpath
import re
from fnmatch import fnmatchcase

REFERENCES = "core/REFERENCES.md"
PACKAGES = "docker/packages.txt"

COMMENT_BREAK = re.compile(r"\s*\n\s*//[/!]?<?\s*")
NUMBERS = r"\d+(?:\.\d+)?(?:(?:, | and )\d+(?:\.\d+)?)*"
EQUATIONS = re.compile(rf"(Boldt|\[[A-Z][A-Za-z]*\d\d\]),? (eq|def)s?\. ({NUMBERS})")
KEY = re.compile(r"\[[A-Z][A-Za-z]*\d\d\]")
ROW = re.compile(r"^\| ([^|]+) \| ([^|]+) \|")
LINK = re.compile(r"\]\(([^)\s]+)\)")
PACKAGES_CALL = re.compile(r"(?<![\w-])packages ((?:[a-z]+ )*[a-z]+) ?(?:&&|;;|$)", re.MULTILINE)
TEST = re.compile(r"^(?:TEST|TEST_F|TEST_P)\(\s*(\w+),\s*(\w+)\)", re.MULTILINE)
NAMED_TEST = re.compile(r"`([A-Z]\w+\.(?:[A-Z]\w*\*?|\*)|vat_\w+)`")
CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)


def equations_in(text):
    """Returns the cited equations: "Boldt eqs. 5 and 6" gives "Boldt eq. 5", "Boldt eq. 6"."""
    joined = COMMENT_BREAK.sub(" ", text)
    return {
        f"{source} {kind}. {number}"
        for source, kind, numbers in EQUATIONS.findall(joined)
        for number in re.split(r", | and ", numbers)
    }


def cited_in_core(tree):
    """Returns {(equation, file)} of the code."""
    return {
        (equation, path)
        for path, text in tree.matching(["core/"], [".h", ".cpp"])
        for equation in equations_in(text)
    }


def listed_in_references(text):
    """Returns {(equation, file)} of the table. Its rows start with an equation, then files in
    backquotes.
    """
    rows = [match.groups() for line in text.splitlines() if (match := ROW.match(line))]
    return {
        (equation, path)
        for equation_cell, files in rows
        for equation in equations_in(equation_cell)
        for path in re.findall(r"`([^`]+)`", files)
    }


def citations(tree):
    text = tree.files.get(REFERENCES, "")
    cited, listed = cited_in_core(tree), listed_in_references(text)
    faults = [f"{path}: {eq} is not in {REFERENCES}" for eq, path in sorted(cited - listed)]
    faults += [f"{REFERENCES}: {path} does not cite {eq}" for eq, path in sorted(listed - cited)]
    return faults


def bibliography(tree):
    defined = set(re.findall(r"^- (\[\w+\])", tree.files.get(REFERENCES, ""), re.MULTILINE))
    used = {
        (key, path)
        for path, text in tree.matching(["core/"], [".h", ".cpp"])
        for key in KEY.findall(text)
    }
    faults = [f"{path}: {key} is not in {REFERENCES}" for key, path in sorted(used)
              if key not in defined]
    unused = defined - {key for key, _ in used}
    return faults + [f"{REFERENCES}: nothing in core cites {key}" for key in sorted(unused)]


def links(tree):
    faults = []
    for path, text in tree.matching([""], [".md"]):
        for target in LINK.findall(CODE.sub("", text)):
            if re.match(r"[a-z]+:|#", target):
                continue
            place = posixpath.normpath(
                posixpath.join(posixpath.dirname(path), target.split("#")[0]))
            if not tree.has(place):
                faults.append(f"{path}: {target} is not there")
    return faults


def listed_groups(tree):
    lines = tree.files.get(PACKAGES, "").splitlines()
    return {line.split()[0] for line in lines if line.strip() and not line.startswith("#")}


def packages(tree):
    """The script, the image and the list name the same groups. The image uses no other
    installation.
    """
    dockerfile = tree.files.get("docker/Dockerfile", "")
    used = {
        group
        for text in (dockerfile, tree.files.get("vat", ""))
        for words in PACKAGES_CALL.findall(text)
        for group in words.split()
    }
    listed = listed_groups(tree)
    faults = [f"{PACKAGES}: nothing installs the group {group}" for group in sorted(listed - used)]
    faults += [f"{PACKAGES}: no group {group}" for group in sorted(used - listed)]
    if re.search(r"\b(?:apt|apt-get|npm) ", dockerfile):
        faults.append("docker/Dockerfile: installs past ./vat")
    return faults


def commands(tree):
    """README.md and `./vat help` name the same commands."""
    helped = set(re.findall(r"^  ([a-z]+)  +\S", tree.files.get("vat", ""), re.MULTILINE))
    told = set(re.findall(r"^\| `\./vat ([a-z]+)", tree.files.get("README.md", ""), re.MULTILINE))
    faults = [f"README.md: no row for ./vat {name}" for name in sorted(helped - told)]
    return faults + [f"README.md: ./vat help has no {name}" for name in sorted(told - helped)]


def rows_with_tests(text):
    """Returns [(first cell, cell of tests)] for the rows of tables with a column of tests."""
    rows, has_tests = [], False
    for line in text.splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")] if line[:1] == "|" else []
        if not cells:
            has_tests = False
        elif cells[-1] == "tests":
            has_tests = True
        elif has_tests and not set(cells[0]) <= set("- :"):
            rows.append((cells[0], cells[-1]))
    return rows


def named_tests(tree):
    """The tests in a table exist, and each row has a test or "the build"."""
    tests = {
        f"{suite}.{name}"
        for _, text in tree.matching(["tests/"], [".cpp"])
        for suite, name in TEST.findall(text)
        if not name.startswith("DISABLED_")
    }
    lists = "".join(text for _, text in tree.matching(["tests/"], ["CMakeLists.txt"]))
    programs = set(re.findall(r"\bvat_\w+", lists))
    faults = []
    for path, text in tree.matching([""], [".md"]):
        for row, cell in rows_with_tests(text):
            names = NAMED_TEST.findall(cell)
            if not names and cell != "the build":
                faults.append(f"{path}: the row \"{row}\" names no test")
            faults += [
                f"{path}: no test is {name}" for name in names
                if not (name in programs or any(fnmatchcase(test, name) for test in tests))
            ]
    return faults


def metrics(tree):
    """The alerts and the dashboard use metrics of the table in the protocol only."""
    rows = re.findall(r"^\| (`vat_[^|]*)", tree.files.get("protocol/PROTOCOL.md", ""), re.MULTILINE)
    known = set(re.findall(r"\bvat_\w+", " ".join(rows)))
    used = {
        (path, name)
        for path, text in tree.matching(["docker/operations/"], [".yaml", ".json"])
        for name in re.findall(r"\bvat_\w+", text)
    }
    return [f"{path}: {name} is not a metric" for path, name in sorted(used) if name not in known]


RULES = (citations, bibliography, links, packages, commands, metrics, named_tests)
