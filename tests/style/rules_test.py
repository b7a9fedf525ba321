"""Tests that each rule accepts a valid tree and rejects each violation."""

import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import check_tree
import document_rules
import fault_rules
import folder_order
import import_cycles
import source_rules
from tree import OUR_ENTRIES, Tree, read_tree

REFERENCES = """# References
| equation | file | what |
|---|---|---|
| Boldt eq. 3 | `core/a.h`, `core/b.cpp` | spring |
| [MCG03] eq. 20 | `core/a.h` | kernel |

- [MCG03] An article.
"""
CITING = {
    "core/a.h": "/// Boldt eq. 3, [MCG03] eq. 20\n",
    "core/b.cpp": "// The force of Boldt\n// eq. 3\n",
    "core/REFERENCES.md": REFERENCES,
}
PACKAGED = {
    "docker/packages.txt": "# list\nrun a\nbuild g++ g++\n",
    "docker/Dockerfile": "RUN ./vat packages run && true\n",
    "vat": "    serve) packages build && x ;;\n",
}


class RuleTest(unittest.TestCase):
    def accepts(self, rule, files):
        self.assertEqual(rule(Tree(files)), [])

    def refuses(self, rule, files, *mentioned):
        faults = rule(Tree(files))
        self.assertEqual(len(faults), 1, faults)
        for word in mentioned:
            self.assertIn(word, faults[0])


class SourceRules(RuleTest):
    def test_layering_accepts_downward_includes(self):
        self.accepts(source_rules.layering, {
            "core/a.cpp": '#include <vector>\n#include <Eigen/Core>\n#include "core/a.h"\n',
            "protocol/a.cpp": '#include <nlohmann/json.hpp>\n#include "core/a.h"\n',
            "server/a.cpp": '#include <CLI/CLI.hpp>\n#include "protocol/a.h"\n',
            "server/transport/a.cpp": "#include <websocketpp/server.hpp>\n",
            "core/device/opencl/a.cpp": "#include <CL/cl.h>\n#include <dlfcn.h>\n",
            "tests/core/a.cpp": '#include "server/a.h"\n#include <gtest/gtest.h>\n',
        })

    def test_layering_refuses_upward_and_foreign_includes(self):
        for path, include in (
            ("core/a.h", '"protocol/a.h"'),
            ("core/a.h", '"server/a.h"'),
            ("core/a.h", "<nlohmann/json.hpp>"),
            ("core/a.h", "<boost/asio.hpp>"),
            ("core/a.h", "<chrono>"),
            ("core/a.h", "<iostream>"),
            ("core/device/tait/a.h", "<CL/cl.h>"),
            ("protocol/a.h", '"server/a.h"'),
            ("protocol/a.h", "<boost/asio.hpp>"),
            ("server/a.h", '"tests/a.h"'),
            ("server/a.h", "<websocketpp/server.hpp>"),
        ):
            with self.subTest(path=path, include=include):
                text = f"#pragma once\n#  include {include}\n"
                self.refuses(source_rules.layering, {path: text}, f"{path}:2", include.strip('<>"'))

    def test_folder_order(self):
        rule = folder_order.folder_order
        self.accepts(rule, {
            "core/model/a.h": '#include "core/model/b.h"\n#include "core/stage/plan.h"\n',
            "protocol/frame/a.cpp": '#include "core/simulation/simulation.h"\n',
            "server/a.h": '#include "server/session/b.h"\n',
        })
        self.refuses(rule, {"core/stage/a.h": '#include "core/model/b.h"\n'}, "core/model/b.h")
        self.refuses(rule, {"core/new/a.h": "\n"}, "FOLDER_ORDER does not have core/new")
        self.refuses(rule, {"core/model/a.h": '#include "core/new/b.h"\n'}, "core/new/b.h")

    def test_import_cycles(self):
        rule = import_cycles.import_cycles
        accepted = {"web/a.ts": "import { b } from './c/b';\n", "web/c/b.ts": "export {};\n"}
        self.accepts(rule, accepted)
        self.refuses(rule, accepted | {"web/c/b.ts": "import type {\n  A,\n} from '../a.js';\n"},
                     "files form a cycle", "web/a.ts", "web/c/b.ts")
        self.refuses(rule, accepted | {"web/c/d.ts": "import { e } from '../e';\n"},
                     "folders form a cycle", "web/c")

    def test_determinism(self):
        rule = source_rules.determinism
        self.accepts(rule, {"core/a.cpp": "operand(1);  // not rand()\n",
                            "server/a.cpp": "std::unordered_map<int, int> m;\n"})
        for line in ("std::unordered_map<int, int> m;", "std::reduce(a, b);", "int i = rand();",
                     "std::atomic<double> sum;", "std::execution::par"):
            with self.subTest(line=line):
                self.refuses(rule, {"core/a.cpp": line + "\n"}, "core/a.cpp:1")

    def test_clock(self):
        rule = source_rules.clock
        self.accepts(rule, {"server/session/a.cpp": "clock_.now(); CostClock::now();\n",
                            "server/support/clock.h": "SteadyClock::now()\n"})
        for line in ("auto t = SteadyClock::now();", "std::chrono::steady_clock::now()",
                     "std::chrono::system_clock::now()", "boost::asio::steady_timer timer;"):
            with self.subTest(line=line):
                self.refuses(rule, {"server/storage/a.h": line + "\n"}, "server/storage/a.h:1")

    def test_waiting(self):
        rule = source_rules.waiting
        self.accepts(rule, {"tests/support/wait.h": "sleep_for(1ms);\n",
                            "tests/bench/a.cpp": "sleep_for(1ms);\n",
                            "tests/server/a.cpp": "wait_until(condition);\n"})
        for line in ("std::this_thread::sleep_for(1ms);", "sleep_until(end);", "GTEST_SKIP();"):
            with self.subTest(line=line):
                self.refuses(rule, {"tests/server/a.cpp": line + "\n"}, "tests/server/a.cpp:1")

    def test_file_length(self):
        longest = "x\n" * source_rules.MAX_LINES
        self.accepts(source_rules.file_length, {"a.cpp": longest, "web/package-lock.json": "\n" * 999})
        self.refuses(source_rules.file_length, {"web/a.ts": longest + "x\n"}, "web/a.ts", "401")
        written = "// Written from a/ by `b`; not to be edited.\n"
        self.accepts(source_rules.file_length, {"web/a.ts": written + longest})
        self.refuses(source_rules.file_length, {"web/a.ts": longest + written}, "web/a.ts", "401")

    def test_folder_size(self):
        rule = source_rules.folder_size
        most = {f"web/a/{number}.ts": "" for number in range(source_rules.MAX_SOURCES)}
        self.accepts(rule, most | {"web/a/b/c.ts": "", "web/a/scene.json": ""})
        self.refuses(rule, most | {"web/a/c.css": ""}, "web/a: 26 sources")

    def test_line_ends(self):
        self.accepts(source_rules.line_ends, {"a.md": "x\n", "empty.txt": ""})
        self.refuses(source_rules.line_ends, {"a.md": "x"}, "no newline")
        self.refuses(source_rules.line_ends, {"a.md": "x\r\n"}, "carriage return")

    def test_encoding(self):
        self.accepts(source_rules.encoding, {"a.md": "größer\n"})
        self.refuses(source_rules.encoding, {"a.md": "x\ngr\N{REPLACEMENT CHARACTER}er\n"}, "a.md:2")

    def test_tabs(self):
        self.accepts(source_rules.tabs, {"a.cpp": '"\\t"\n', "Makefile": "\tx\n"})
        self.refuses(source_rules.tabs, {"a.cpp": "x\n\tx\n"}, "a.cpp:2")

    def test_conflicts(self):
        self.accepts(source_rules.conflicts, {"a.md": "a <<<<<<< b\n=======\n"})
        self.refuses(source_rules.conflicts, {"a.md": "a\n<<<<<<< " + "HEAD\n"}, "a.md:2")
        self.refuses(source_rules.conflicts, {"a.md": ">>>>>>> " + "b\n"}, "a.md:1")

    def test_denied_words(self):
        rule = source_rules.denied_words
        self.accepts(rule, {"a.cpp": '// a hackle; "build/tmp/x"; HOME=/root\n'})
        # In two parts each, for this file has none of them either.
        for parts in ("// TO", "DO later"), ("// fix", "me"), ("// X", "XX"), ("// a ha", "ck"), (
                '"/', 'root/x"'), ('"/', 'work/x"'), ("cd /", "home/someone"), ("(/", "tmp/x)"):
            line = "".join(parts)
            with self.subTest(line=line):
                self.refuses(rule, {"web/a.ts": f"\n{line}\n"}, "web/a.ts:2")

    def test_header_docstrings(self):
        rule = source_rules.header_docstrings
        self.accepts(rule, {"core/a.h": "/// What it is.\nstruct A {};\n", "core/a.cpp": "int a;\n"})
        self.refuses(rule, {"core/a.h": "// a note\nstruct A {};\n"}, "core/a.h")


class DocumentRules(RuleTest):
    def changed(self, files, path, old, new):
        self.assertIn(old, files[path])
        return files | {path: files[path].replace(old, new)}

    def test_equations_in_reads_lists_and_broken_lines(self):
        self.assertEqual(
            document_rules.equations_in("// Boldt eqs. 5, 6\n  /// and 7; Boldt\n// def. 0.2"),
            {"Boldt eq. 5", "Boldt eq. 6", "Boldt eq. 7", "Boldt def. 0.2"})

    def test_citations(self):
        rule = document_rules.citations
        self.accepts(rule, CITING)
        self.refuses(rule, CITING | {"core/c.h": "/// Boldt eq. 9\n"}, "core/c.h", "eq. 9")
        self.refuses(rule, CITING | {"core/c.h": "/// Boldt eq. 3\n"}, "core/c.h", "eq. 3")
        self.refuses(rule, CITING | {"core/b.cpp": "\n"}, "core/b.cpp does not cite Boldt eq. 3")

    def test_bibliography(self):
        rule = document_rules.bibliography
        self.accepts(rule, CITING)
        self.refuses(rule, CITING | {"core/c.h": "/// [DC96]\n"}, "[DC96]")
        self.refuses(rule, CITING | {"core/a.h": "\n"}, "nothing in core cites [MCG03]")

    def test_links(self):
        rule = document_rules.links
        self.accepts(rule, {
            "docs/a.md": "[b](b.md#x) [up](../c/) [web](https://x.y) [here](#a) `[no](gone.md)`\n",
            "docs/b.md": "x\n", "c/d.txt": "x\n"})
        self.refuses(rule, {"docs/a.md": "![](picture.png)\n"}, "picture.png")

    def test_packages(self):
        rule = document_rules.packages
        self.accepts(rule, PACKAGED)
        self.refuses(rule, PACKAGED | {"docker/packages.txt": "run a\nbuild b\nextra c\n"}, "extra")
        self.refuses(rule, self.changed(PACKAGED, "vat", "build", "build web"), "no group web")
        self.refuses(rule, self.changed(PACKAGED, "docker/Dockerfile", "true", "apt-get install x"),
                     "past ./vat")

    def test_commands(self):
        rule = document_rules.commands
        files = {"vat": "  serve      run\n  test       try\n",
                 "README.md": "| `./vat serve` | x |\n| `./vat test` | y |\n"}
        self.accepts(rule, files)
        self.refuses(rule, self.changed(files, "vat", "  test       try\n", ""), "has no test")
        self.refuses(rule, files | {"README.md": "| `./vat serve` | x |\n"}, "no row for ./vat test")

    def test_metrics(self):
        rule = document_rules.metrics
        files = {"protocol/PROTOCOL.md": "| `vat_a{state}`, `vat_b` | gauge | vat_c |\n"}
        alerts = "docker/operations/alerts.yaml"
        self.accepts(rule, files | {alerts: "expr: vat_a > vat_b"})
        self.refuses(rule, files | {alerts: "expr: vat_a > vat_c"}, "vat_c")

    def test_named_tests(self):
        rule = document_rules.named_tests
        table = ("| point | what | tests |\n|---|---|---|\n| a | b | `Of.It`, `Of.I*` |\n"
                 "| c | d | `Other.*`, `vat_fuzz_it` |\n| e | f | the build |\n\n| x | y |\n| 1 | 2 |\n")
        files = {"a.md": table, "tests/a/a.cpp": "TEST_F(Of, It) {\nTEST_P(\n    Other, One) {\n",
                 "tests/a/CMakeLists.txt": "add(vat_fuzz_it)\n"}
        self.accepts(rule, files)
        for old, new, mentioned in (
            ("`Of.It`", "`Of.That`", "Of.That"), ("`Other.*`", "`Others.*`", "Others.*"),
            ("vat_fuzz_it", "vat_fuzz_that", "vat_fuzz_that"), ("the build", "care", '"e"'),
        ):
            with self.subTest(new=new):
                self.refuses(rule, self.changed(files, "a.md", old, new), mentioned)
        self.refuses(rule, self.changed(files, "tests/a/a.cpp", "Other, One", "Other, DISABLED_One"),
                     "Other.*")

    def test_known_faults(self):
        rule = fault_rules.known_faults
        fault = {"name": "f", "file": "core/a.cpp", "before": "a + b", "detected_by": ["unit/A.B"]}
        web = fault | {"detected_by": ["web/test: tests/web/a.test.ts > adds"]}
        files = {"core/a.cpp": "return a + b;\n", "tests/faults/core.json": json.dumps([fault]),
                 "tests/core/a_test.cpp": "TEST(A, B) {}\n"}
        self.accepts(rule, files)
        self.accepts(rule, files | {"tests/web/a.test.ts": "",
                                    "tests/faults/core.json": json.dumps([web])})
        self.refuses(rule, files | {"core/a.cpp": "return a - b;\n"}, "f: its text occurs 0 times")
        self.refuses(rule, files | {"core/a.cpp": "a + b + a + b"}, "f: its text occurs 2 times")
        undetected = json.dumps([fault | {"detected_by": []}])
        self.refuses(rule, files | {"tests/faults/core.json": undetected}, "f: no test detects it")
        self.refuses(rule, files | {"tests/core/a_test.cpp": "TEST(A, C) {}"}, "no test unit/A.B")
        self.refuses(rule, files | {"tests/faults/core.json": json.dumps([web])}, "no test web/test")


class Coverage(unittest.TestCase):
    def test_every_rule_has_a_test(self):
        tests = {name for case in (SourceRules, DocumentRules) for name in dir(case)}
        for rule in check_tree.RULES:
            self.assertTrue(any(t.startswith(f"test_{rule.__name__}") for t in tests), rule.__name__)


class ReadTree(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = folder.name
        self.write("README.md", b"ours\n")
        self.write("core/a.h", b"/// ours\n")
        self.write("bath.json", b"a user's")
        self.write("notes.txt", "für mich".encode("latin-1"))
        self.write("runs/core/a.h", b"a user's")

    def write(self, path, content):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "wb") as file:
            file.write(content)

    def git(self, *arguments):
        own = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
        subprocess.run(["git", *arguments], cwd=self.root, env=own, check=True, capture_output=True)

    def test_leaves_out_what_a_user_keeps_beside_the_project(self):
        tree = read_tree(self.root)
        self.assertEqual(tree.files, {"README.md": "ours\n", "core/a.h": "/// ours\n"})
        self.assertEqual(tree.paths, set(tree.files))

    def test_has_what_git_tracks_and_is_there(self):
        if not shutil.which("git"):
            self.skipTest("no git")
        self.write("core/gone.h", b"x")
        self.write("core/picture.png", b"x")
        self.git("init")
        self.git("add", "README.md", "core")
        os.remove(os.path.join(self.root, "core/gone.h"))
        self.write("core/new.h", b"not added yet")
        tree = read_tree(self.root)
        self.assertEqual(set(tree.files), {"README.md", "core/a.h"})
        self.assertEqual(tree.paths, {"README.md", "core/a.h", "core/picture.png"})

    def test_reads_line_ends_and_wrong_bytes_as_they_are(self):
        self.write("core/a.h", "gr\xf6\xdfer\r\n".encode("latin-1"))
        text = read_tree(self.root).files["core/a.h"]
        self.assertTrue(text.endswith("\r\n"))
        self.assertIn("\N{REPLACEMENT CHARACTER}", text)

    def test_fits_this_checkout(self):
        here = os.path.dirname(os.path.abspath(__file__))
        tree = read_tree(os.path.join(here, "..", ".."))
        self.assertIn("def test_fits_this_checkout", tree.files["tests/style/rules_test.py"])
        self.assertEqual({path.split("/")[0] for path in tree.paths} - OUR_ENTRIES, set())


if __name__ == "__main__":
    unittest.main()
