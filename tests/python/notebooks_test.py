"""notebooks_test.py PROGRAM: executes the notebooks, and checks the outputs of their cells."""

import os
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

import nbformat
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))

from serving import serving

PROGRAM = sys.argv.pop(1)
NOTEBOOKS = ROOT / "protocol" / "python" / "notebooks"
PICTURE = r'<iframe src="data:text/html;base64,\w'

#: For each notebook, expressions that its outputs contain, in this order.
EXPECTED = {
    "error_and_run_time": [
        # The observed orders of the second halving are near the orders of the methods.
        r"symplectic_euler .*\n.*\n.* 1\.[01]\d ", r"velocity_verlet .*\n.*\n.* (2\.0|1\.9)\d ",
        r"heun .*\n.*\n.* (2\.0|1\.9)\d ", r"runge_kutta_4 .*\n.*\n.* (4\.0|3\.9)\d "],
    "first_steps": [PICTURE, r"mass: 128\.0 kg", r"the front has moved by 0\.\d", r"earth: front",
                    r"moon: front", PICTURE],
    # The first rebound is 0.635 m = e^2 m; the others differ by their errors.
    "fitting": [r"restitution 0\.(79\d|80\d)\n", r"rebound 0\.6[34]\d m, measured 0\.635 m"],
    "shared_session": [r'<iframe src="http://127\.0\.0\.1:\d+/\?session=s1"',
                       r"( *\d+\.\d\d s: greatest speeds \[m/s\] \{'\w+.*\n){10}",
                       r"gravity: \[0.*-1\.62\]"],
}


def output_of(notebook: Any) -> str:
    """Returns the texts and the HTML of all cells."""
    texts = []
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            # A stream arrives in several parts.
            texts.append(output.get("text") or data.get("text/html", "") + "\n")
    return "".join(texts)


class Notebooks(unittest.TestCase):
    def test_all_are_expected(self) -> None:
        self.assertEqual(sorted(file.stem for file in NOTEBOOKS.glob("*.ipynb")), sorted(EXPECTED))

    def test_notebooks_are_stored_without_outputs(self) -> None:
        for name in EXPECTED:
            notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", 4)
            nbformat.validate(notebook)
            self.assertEqual(output_of(notebook), "", name)

    def test_outputs(self) -> None:
        with tempfile.TemporaryDirectory() as folder, serving(PROGRAM) as url:
            os.environ.update(VAT_URL=url, HOME=folder, IPYTHONDIR=folder)
            for name, patterns in EXPECTED.items():
                with self.subTest(name):
                    notebook = nbformat.read(NOTEBOOKS / f"{name}.ipynb", 4)
                    NotebookClient(notebook, timeout=300, kernel_name="python3",
                                   resources={"metadata": {"path": folder}}).execute()
                    output = output_of(notebook)
                    for pattern in patterns:
                        self.assertRegex(output, pattern)


if __name__ == "__main__":
    unittest.main()
