"""Rules for source files: layers, form, words. A rule is a function: Tree -> list of faults."""

import posixpath
import re
from collections import Counter

CPP = (".cpp", ".h")
SOURCE = CPP + (".ts", ".js", ".css", ".html", ".py", ".sh")
MAX_LINES = 400
MAX_SOURCES = 25  # in one folder
GENERATED = re.compile(r"// Written from .*; not to be edited\.\n")  # the first line of such files

# The includes that each layer permits: prefixes of "quoted" headers, and of <angled> headers with a
# folder or an extension. Headers of the standard library have neither.
LAYERS = {
    "core/": (("core/",), ("CL/", "Eigen/", "cpuid.h", "dlfcn.h", "hwy/")),
    "protocol/": (
        ("core/", "protocol/"), ("boost/", "nlohmann/", "openssl/", "pybind11/", "tiny_obj_loader.h"),
    ),
    "server/": (
        ("core/", "protocol/", "server/"),
        ("CLI/", "Eigen/", "boost/", "fmt/", "nlohmann/", "spdlog/", "websocketpp/", "unistd.h", "sys/",
         "fcntl.h", "malloc.h", "nats/", "poll.h", "openssl/", "lz4.h", "sqlite3.h", "zstd.h"),
    ),
}
# core/threads runs the blocks of a step, whose results do not depend on it.
NOT_IN_CORE = {"chrono", "ctime", "iostream", "fstream", "filesystem", "random", "thread"}
ONLY_IN = {
    "CL/": "core/device/opencl/", "dlfcn.h": "core/device/opencl/", "sqlite3.h": "server/storage/",
    "websocketpp/": "server/transport/", "zstd.h": "server/storage/",
    "lz4.h": "server/output/", "nats/": "server/nats/", "pybind11/": "protocol/python/native/",
    "boost/": ("protocol/client/connection/", "server/"),
    "openssl/": ("protocol/client/connection/", "server/"),
}

# Constructs that make the order of operations depend on threads, addresses or randomness.
NOT_DETERMINISTIC = re.compile(
    r"\bunordered_|\bstd::(?:reduce|transform_reduce|execution|async)\b|\brand\(|ffast-math"
    r"|\batomic<\s*(?:float|double|Real)\b"
)
# The server reads the time from its Clock, which tests control. The cost of work is measured by
# CostClock.
CLOCKED = tuple(f"server/{folder}/" for folder in
                ("access", "clients", "cluster", "directory", "frames", "history", "http", "messages", "methods",
                 "people", "replay", "rpc", "session", "storage"))
SYSTEM_TIME = re.compile(r"\b(?:steady_clock|system_clock|SteadyClock)::now\b|\bsteady_timer\b")
# Tests wait for events. tests/bench generates load for a given time.
WAITING = re.compile(r"\bsleep_(?:for|until)\b|\bGTEST_SKIP\b")
MAY_WAIT = ("tests/bench/", "tests/support/wait.h")
INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]')
# The spelling avoids that a pattern matches itself.
DENIED = re.compile(
    r"\b(?:TO[D]O|FIX[M]E|X{3})\b|\bha[c]k(?:s|y|ish)?\b|(?<![\w./*-])/(?:work|root|home|tmp)/",
    re.IGNORECASE
)


def numbered(text):
    return enumerate(text.splitlines(), start=1)


def include_fault(path, layer, quote, header):
    quoted, angled = LAYERS[layer]
    if quote == '"':
        return None if header.startswith(quoted) else f"{layer} may not include {header}"
    if "/" in header or "." in header:
        if not header.startswith(angled):
            return f"{layer} may not include <{header}>"
        for prefix, home in ONLY_IN.items():
            if header.startswith(prefix) and not path.startswith(home):
                homes = [home] if isinstance(home, str) else home
                return f"only {' and '.join(homes)} may include <{header}>"
    elif layer == "core/" and header in NOT_IN_CORE and not path.startswith("core/threads/"):
        return f"core/ has no clock, files, chance or threads: <{header}>"
    return None


def layering(tree):
    faults = []
    for layer in LAYERS:
        for path, text in tree.matching([layer], CPP):
            for number, line in numbered(text):
                match = INCLUDE.match(line)
                fault = include_fault(path, layer, *match.groups()) if match else None
                if fault:
                    faults.append(f"{path}:{number}: {fault}")
    return faults


def determinism(tree):
    return [
        f"{path}:{number}: results may depend on more than the scene: {match.group()}"
        for path, text in tree.matching(["core/"], CPP)
        for number, line in numbered(text)
        if (match := NOT_DETERMINISTIC.search(line.split("//")[0]))
    ]


def clock(tree):
    return [
        f"{path}:{number}: time that is not of the server's clock: {match.group()}"
        for folder in CLOCKED
        for path, text in tree.matching([folder], CPP)
        for number, line in numbered(text)
        if (match := SYSTEM_TIME.search(line))
    ]


def waiting(tree):
    return [
        f"{path}:{number}: tests wait for events, and run everywhere: {match.group()}"
        for path, text in tree.matching(["tests/"], CPP)
        if not path.startswith(MAY_WAIT)
        for number, line in numbered(text)
        if (match := WAITING.search(line))
    ]


def file_length(tree):
    return [
        f"{path}: {lines} lines; at most {MAX_LINES}"
        for path, text in tree.matching([""], SOURCE)
        if (lines := len(text.splitlines())) > MAX_LINES and not GENERATED.match(text)
    ]


def folder_size(tree):
    counts = Counter(posixpath.dirname(path) for path, _ in tree.matching([""], SOURCE))
    return [
        f"{folder}: {count} sources; at most {MAX_SOURCES}"
        for folder, count in sorted(counts.items())
        if count > MAX_SOURCES
    ]


def line_ends(tree):
    faults = []
    for path, text in sorted(tree.files.items()):
        if text and not text.endswith("\n"):
            faults.append(f"{path}: no newline at the end")
        if "\r" in text:
            faults.append(f"{path}: carriage return")
    return faults


def encoding(tree):
    return [
        f"{path}:{number}: not UTF-8"
        for path, text in sorted(tree.files.items())
        for number, line in numbered(text)
        if "\N{REPLACEMENT CHARACTER}" in line
    ]


def tabs(tree):
    return [
        f"{path}:{number}: tab"
        for path, text in tree.matching([""], CPP)
        for number, line in numbered(text)
        if "\t" in line
    ]


def conflicts(tree):
    """Marks of unresolved merges."""
    return [
        f"{path}:{number}: merge conflict"
        for path, text in sorted(tree.files.items())
        for number, line in numbered(text)
        if line.startswith(("<<<<<<< ", ">>>>>>> "))
    ]


def denied_words(tree):
    return [
        f"{path}:{number}: {match.group()}"
        for path, text in sorted(tree.files.items())
        if not path.endswith("package-lock.json")
        for number, line in numbered(text)
        if (match := DENIED.search(line))
    ]


def header_docstrings(tree):
    return [
        f"{path}: no docstring (///)"
        for path, text in tree.matching(["core/"], [".h"])
        if not re.search(r"^\s*///", text, re.MULTILINE)
    ]


RULES = (
    layering, determinism, clock, waiting, file_length, folder_size, line_ends, encoding, tabs, conflicts, denied_words,
    header_docstrings,
)
