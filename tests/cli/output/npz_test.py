"""Reads the .npz files of `vat simulate` with NumPy, and compares them with the .csv files.

Usage: npz_test.py VAT FOLDER_OF_SCENES CATALOGUE
"""

import sys
import unittest
import zipfile

import numpy
from output_case import CATALOGUE, SCENES, OutputCase

SHAPES = {"time": (), "count": (), "body": (0,), "number": (0,), "position": (0, 3), "velocity": (0, 3)}
TYPES = {"time": "<f8", "count": "<i8", "body": "<i4", "number": "<i4", "position": "<f8",
         "velocity": "<f8"}


class NpzTest(OutputCase):
    def both(self, scene, *options):
        """Returns the arrays, and the rows of the table."""
        arrays = numpy.load(self.run_vat(scene, "run.npz", *options))
        return arrays, self.rows(self.run_vat(scene, "run.csv", *options))

    def compare(self, arrays, rows):
        self.assertEqual({name: arrays[name].dtype.str for name in arrays.files}, TYPES)
        times, most = arrays["position"].shape[:2]
        for name, (*rest,) in SHAPES.items():
            expected = (times, *(most if extent == 0 else extent for extent in rest))
            self.assertEqual(arrays[name].shape, expected, name)
        exists = numpy.arange(most) < arrays["count"][:, None]
        names = list(dict.fromkeys(row["body"] for row in rows))
        self.assertEqual([names[body] for body in arrays["body"][exists]],
                         [row["body"] for row in rows])
        for name, columns in (("position", ("x", "y", "z")), ("velocity", ("vx", "vy", "vz"))):
            expected = numpy.array([[float(row[column]) for column in columns] for row in rows])
            numpy.testing.assert_array_equal(arrays[name][exists], expected)
            self.assertTrue(numpy.isnan(arrays[name][~exists]).all())
        times = numpy.broadcast_to(arrays["time"][:, None], exists.shape)
        numpy.testing.assert_array_equal(times[exists], [float(row["time"]) for row in rows])
        for name in ("body", "number"):
            self.assertTrue((arrays[name][~exists] == -1).all())

    def test_constant_number_of_particles(self):
        arrays, rows = self.both(f"{SCENES}/mixed.json", "--until", "0.1", "--every", "0.03")
        self.compare(arrays, rows)
        self.assertEqual(len(arrays["time"]), 5)
        self.assertTrue((arrays["count"] == arrays["position"].shape[1]).all())
        expected = [int(row["particle"]) for row in rows[:arrays["count"][0]]]
        self.assertEqual(arrays["number"][0].tolist(), expected)

    def test_emitter_and_drain(self):
        arrays, rows = self.both(f"{CATALOGUE}/pour.json", "--until", "0.4", "--every", "0.1")
        self.compare(arrays, rows)
        self.assertGreater(arrays["count"][-1], arrays["count"][0])
        # One body, whose drained particles leave gaps in the numbers.
        liquid = arrays["number"][-1][arrays["body"][-1] == 1]
        self.assertTrue((numpy.diff(liquid) > 0).all())

    def test_archive_is_intact_and_the_same_in_each_run(self):
        contents = []
        for name in ("a.npz", "b.npz"):
            file = self.run_vat(f"{SCENES}/pair.json", name, "--until", "0.1")
            self.assertIsNone(zipfile.ZipFile(file).testzip())
            contents.append(file.read_bytes())
        self.assertEqual(*contents)

    def test_failed_run_leaves_its_outputs(self):
        file = self.run_vat(f"{SCENES}/unstable.json", "run.npz", "--until", "1", "--every", "0.001",
                            exit_code=1)
        self.assertFalse(file.exists())
        with open(f"{file}.part", "rb") as part:
            arrays = numpy.load(part)
            count, time = arrays["count"], arrays["time"]
        written = int((count > 0).sum())
        self.assertTrue(0 < written < len(count))
        self.assertTrue((count[:written] == count[0]).all())
        self.assertTrue((numpy.diff(time[:written]) > 0).all())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
