"""The base class of the tests of output files. Their arguments: VAT FOLDER_OF_SCENES CATALOGUE."""

import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest

VAT, SCENES, CATALOGUE = sys.argv[1:4]


class OutputCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_vat(self, scene, name, *options, exit_code=0):
        """Runs `vat simulate` with the output `name`. Returns the path of the output."""
        file = self.folder / name
        command = [VAT, "simulate", scene, "--output", str(file), *options]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return file

    def rows(self, file):
        with file.open(newline="") as table:
            return list(csv.DictReader(table))
