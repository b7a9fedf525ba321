"""shell_examples_test.py PROGRAM ROOT: runs the shell examples of all documents of the site.

An example is a list of commands: a block marked as `sh`, or an indented block whose lines begin with
a name in COMMANDS. All examples run here, except those in ELSEWHERE. The options of all commands of
the program must be in its help.
"""

import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "web" / "site"))

from serving import serving
from stage import documents

PROGRAM, ROOT = sys.argv[1], Path(sys.argv[2])
COMMANDS = ("./vat", "cmake", "curl", "docker", "env/bin", "export", "helm",
            "kubectl", "npm", "openssl", "pip", "python3", "sudo", "vat")
PATIENCE = 120  # [s]

# First lines of examples that cannot run in this test: the test that runs them, or the reason.
ELSEWHERE = {
    "./vat test": "contains this test",
    "./vat bench validate": "takes hours; the tests cli/bench_* run short versions",
    "./vat bench speed --threads 2 --device opencl:0 --case dam-break-10k-tait "
    "--case dam-break-30k-tait --case dam-break-10k-incompressible "
    "--case dam-break-30k-incompressible --case rigid-pile-200-penalty --case deformable-50 "
    "--case dam-break-300k-tait --case dam-break-300k-incompressible "
    "--case rigid-pile-30k-penalty --case rigid-pile-300k-penalty --case deformable-30k "
    "--case deformable-300k":
        "takes minutes; cli/bench_document_test.cpp fills the table",
    "docker compose --file docker/compose.yaml up --build": "needs a container engine",
    "docker compose --file docker/compose.cluster.yaml up --build": "needs a container engine",
    "docker build --file docker/Dockerfile --tag vat .": "needs a container engine",
    "helm repo add nats https://nats-io.github.io/k8s/helm/charts/": "needs Kubernetes",
    "kubectl create secret generic vat --from-literal VAT_ADMIN_TOKEN=$(openssl rand -hex 16)":
        "needs Kubernetes",
    "export VAT_PUBLIC_NAME=vat.example.org": "needs a container engine",
    "sudo apt-get install debootstrap curl git": "installs a whole system, with the rights of root",
    "./vat prepare package": "docker/debian/package-check.sh runs it in a bare system",
    "cmake --install build/release --prefix ~/.local": "cli/installed",
    "sudo apt-get install ./build/release/vat_*.deb ./build/release/python3-vat_*.deb":
        "docker/debian/package-check.sh runs it in a bare system",
    "python3 -m venv env": "python/package installs the package without a network",
    "env/bin/python protocol/examples/lecture.py ws://127.0.0.1:8080/ws": "clients/lecture",
    "./vat serve --allow-origin http://localhost:4173": "browser/visit serves the example page",
}
INDENTED = re.compile(r"(?:^    \S.*\n)+", re.MULTILINE)
FENCED = re.compile(r"^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def examples(document: Path) -> list[tuple[str, list[str]]]:
    """Returns (place, commands) of each example."""
    text = document.read_text("utf-8")
    found = [(block.start(), block[2]) for block in FENCED.finditer(text) if block[1] == "sh"]
    outside = FENCED.sub(lambda block: "\n" * block[0].count("\n"), text)
    for block in INDENTED.finditer(outside):
        commands = re.sub("^    ", "", block[0], flags=re.MULTILINE)
        if commands.split()[0].startswith(COMMANDS):
            found.append((block.start(), commands))
    return [(f"{document.relative_to(ROOT)}:{text[:begin].count(chr(10)) + 1}",
             commands.splitlines()) for begin, commands in found]


def is_run(commands: list[str]) -> bool:
    return commands[0] not in ELSEWHERE


class ShellExamples(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.make_launcher("vat", PROGRAM)
        self.make_launcher("env/bin/python", sys.executable)
        (self.folder / "protocol").symlink_to(ROOT / "protocol")
        self.all = {place: commands for document in documents(ROOT)
                    if document.name != "tutorial.md"  # python/tutorial
                    for place, commands in examples(document)}

    def make_launcher(self, name: str, program: str) -> None:
        launcher = self.folder / name
        launcher.parent.mkdir(parents=True, exist_ok=True)
        launcher.write_text(f'#!/bin/sh\nexec "{program}" "$@"\n')
        launcher.chmod(0o755)

    def run_command(self, command: str) -> str:
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=self.folder,
                              text=True, check=False, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}")
        return done.stdout

    def follow(self, commands: list[str]) -> None:
        """Runs the commands in order. A server runs until the last command has ended."""
        for i, command in enumerate(commands):
            if not command.startswith("./vat serve"):
                self.run_command(command)
                continue
            options = command.removesuffix("&").split()[2:]
            with serving(str(self.folder / "vat"), *options, cwd=self.folder) as url:
                port = url.removesuffix("/ws").rpartition(":")[2]
                self.follow([later.replace("8080", port) for later in commands[i + 1:]])
            return

    def test_examples_run(self) -> None:
        runs = {place: commands for place, commands in self.all.items() if is_run(commands)}
        self.assertGreaterEqual(len(runs), 4)
        for place, commands in runs.items():
            with self.subTest(place):
                if any("--data FOLDER" in command for command in commands):
                    commands = ["./vat serve --data FOLDER", *commands]
                self.follow(commands)

    def test_the_list_of_other_examples_has_no_others(self) -> None:
        first = {commands[0] for commands in self.all.values()}
        self.assertEqual(set(ELSEWHERE) - first, set())

    def test_options_are_in_the_help(self) -> None:
        helps: dict[str, str] = {}
        for place, commands in self.all.items():
            for command in commands:
                words = command.split()
                if words[0] not in ("./vat", "vat") or words[1] in ("bench", "prepare", "test"):
                    continue
                if words[1] not in helps:
                    helps[words[1]] = self.run_command(f"./vat {words[1]} --help")
                for option in words[2:]:
                    if option.startswith("--"):
                        self.assertIn(f"{option} ", helps[words[1]], f"{place}: {command}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
