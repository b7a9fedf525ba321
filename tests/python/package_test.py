"""package_test.py PACKAGE: installs the package with pip, in a folder of its own.

PACKAGE is the built package, so that the test compiles nothing.
"""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PACKAGE = sys.argv.pop(1)
SOURCE = Path(__file__).resolve().parents[2] / "protocol" / "python"

PROGRAM = """
import pathlib, sys, vat
assert pathlib.Path(vat.__file__).is_relative_to(sys.argv[1]), vat.__file__
simulation = vat.Simulation("sliding-vat-solids")
simulation.advance(0.05)
print(simulation.hash)
"""


def output_of(*command: str, **environment: str) -> str:
    done = subprocess.run(command, env={**os.environ, **environment}, text=True, check=False,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    assert done.returncode == 0, done.stdout
    return done.stdout


class Package(unittest.TestCase):
    def test_an_installed_package_needs_no_sources(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            output_of(sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--quiet",
                      "--disable-pip-version-check", "--root-user-action", "ignore",
                      "--config-settings", f"package={PACKAGE}", "--target", folder, str(SOURCE))
            installed = output_of(sys.executable, "-c", PROGRAM, folder, PYTHONPATH=folder)
            files = [file for file in Path(folder, "vat").rglob("*") if file.is_symlink()]
            self.assertEqual(files, [])
            info, = Path(folder).glob("vat-*.dist-info")
            self.assertIn("Requires-Dist: numpy", (info / "METADATA").read_text())
        built = output_of(sys.executable, "-c", PROGRAM, str(Path(PACKAGE).parent))
        self.assertEqual(installed, built)


if __name__ == "__main__":
    unittest.main()
