"""Reads the .abc files of `vat simulate`, and compares them with the tables.

Usage: abc_test.py VAT FOLDER_OF_SCENES CATALOGUE
"""

import pathlib
import sys
import unittest

import abc_reader
import numpy
from output_case import CATALOGUE, SCENES, OutputCase


def columns(rows, names):
    return numpy.array([[float(row[name]) for name in names] for row in rows])


class AbcTest(OutputCase):
    def bodies(self, scene, *options):
        """Returns the objects of the bodies, the rows of the particles, and the archive."""
        archive = abc_reader.Archive(self.run_vat(scene, "run.abc", *options))
        self.assertEqual(list(archive.objects), ["vat"])
        tables = [option for option in options if option != "--surface"]
        return archive.objects["vat"], self.rows(self.run_vat(scene, "run.csv", *tables)), archive

    def compare_points(self, points, rows, times):
        self.assertEqual(points.meta["schema"], "AbcGeom_Points_v1")
        found = points.properties
        self.assertEqual(found["P"].times, times)
        for i, time in enumerate(times):
            now = [row for row in rows if float(row["time"]) == time]
            positions = columns(now, "xyz")
            numpy.testing.assert_array_equal(found["P"].samples[i], positions.astype("f4"))
            numpy.testing.assert_array_equal(found[".velocities"].samples[i],
                                             columns(now, ("vx", "vy", "vz")).astype("f4"))
            bounds = numpy.concatenate([positions.min(axis=0), positions.max(axis=0)])
            numpy.testing.assert_array_equal(found[".selfBnds"].samples[i][0], bounds)
            ids = found[".pointIds"].samples
            ids = ids[i if len(ids) > 1 else 0]
            self.assertEqual(len(ids), len(now))
            self.assertTrue((numpy.diff(ids.astype("i8")) > 0).all())

    def test_particles_have_positions_velocities_and_ids(self):
        root, rows, archive = self.bodies(f"{SCENES}/mixed.json", "--until", "0.1", "--every", "0.03")
        times = tuple(dict.fromkeys(float(row["time"]) for row in rows))
        self.assertEqual(archive.samplings[1], (len(times), sys.float_info.max / 32, times))
        for name in ("pool", "cube"):
            self.compare_points(root.objects[name], [row for row in rows if row["body"] == name], times)
            numpy.testing.assert_array_equal(root.objects[name].properties[".widths"].samples,
                                             [[numpy.float32(0.05)]])
        self.assertIn("interpretation=point", root.objects["pool"].properties["P"].meta)

    def test_emitted_particles_keep_their_ids(self):
        root, rows, _ = self.bodies(f"{CATALOGUE}/pour.json", "--until", "0.4", "--every", "0.1")
        times = tuple(dict.fromkeys(float(row["time"]) for row in rows))
        water = root.objects["water"]
        self.compare_points(water, [row for row in rows if row["body"] == "water"], times)
        first, *_, last = water.properties[".pointIds"].samples
        self.assertGreater(last[-1], first[-1])

    def test_rigid_bodies_have_their_poses(self):
        diagnostics = self.folder / "d.csv"
        root, _, _ = self.bodies(f"{SCENES}/mixed.json", "--until", "0.1", "--every", "0.05",
                                 "--diagnostics", str(diagnostics))
        ball = root.objects['ball, "red"']
        self.assertEqual(ball.meta["schema"], "AbcGeom_Xform_v3")
        self.assertEqual(ball.properties[".ops"].samples[0].tolist(), [0x30])
        for sample, row in zip(ball.properties[".vals"].samples, self.rows(diagnostics), strict=True):
            matrix = sample.reshape(4, 4)
            w, x, y, z = (float(row[f'ball, "red".{name}']) for name in ("qw", "qx", "qy", "qz"))
            place = [float(row[f'ball, "red".{axis}']) for axis in "xyz"]
            numpy.testing.assert_allclose(matrix[3], [*place, 1], atol=1e-12)
            # The first row is the image of the x axis.
            image = [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0]
            numpy.testing.assert_allclose(matrix[0], image, atol=1e-12)
        numpy.testing.assert_array_equal(  # (x, y, z) becomes (x, z, -y)
            root.properties[".vals"].samples[0].reshape(4, 4)[:3, :3], [[1, 0, 0], [0, 0, -1], [0, 1, 0]])

    def test_meshes_are_closed_and_clockwise(self):
        root, _, _ = self.bodies(f"{CATALOGUE}/rigid-stack.json", "--until", "0")
        for body in root.objects.values():
            mesh = body.objects["shape"].properties
            corners = mesh["P"].samples[0][mesh[".faceIndices"].samples[0]].reshape(-1, 3, 3)
            self.assertTrue((mesh[".faceCounts"].samples[0] == 3).all())
            a, b, c = corners.astype("f8").transpose(1, 0, 2)
            self.assertLess(numpy.einsum("ij,ij->", a, numpy.cross(b, c)), 0)
            numpy.testing.assert_allclose(numpy.cross(b - a, c - a).sum(axis=0), 0, atol=1e-6)

    def test_liquid_surfaces_are_closed_and_enclose_the_particles(self):
        root, rows, _ = self.bodies(f"{CATALOGUE}/pour.json", "--until", "0.4", "--every", "0.2",
                                    "--surface")
        mesh = root.objects["water surface"].properties
        self.assertEqual(root.objects["water surface"].meta["schema"], "AbcGeom_PolyMesh_v1")
        times = tuple(dict.fromkeys(float(row["time"]) for row in rows))
        self.assertEqual(mesh["P"].times, times)
        radius = root.objects["water"].properties[".widths"].samples[0][0] / 2
        for i, time in enumerate(times):
            points = columns([row for row in rows if float(row["time"]) == time
                              and row["body"] == "water"], "xyz")
            positions = mesh["P"].samples[i].astype("f8")
            faces = mesh[".faceIndices"].samples[i].reshape(-1, 3)
            self.assertTrue((mesh[".faceCounts"].samples[i] == 3).all())
            edges = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
            self.assertEqual(sorted(map(tuple, edges)), sorted(map(tuple, edges[:, ::-1])))
            # The surface is at most 1.3 radii and half a cell of its grid beyond the particles.
            for sign in (1, -1):
                beyond = (sign * positions).max(axis=0) - (sign * points).max(axis=0)
                self.assertTrue((beyond > 0).all() and (beyond < 1.8 * radius).all(), beyond)

    def test_samples_are_identified_by_their_content(self):
        file = self.run_vat(f"{SCENES}/mixed.json", "run.abc", "--until", "0.1")
        archive = abc_reader.Archive(file)
        keys = []
        group = archive.group(archive.group(int.from_bytes(file.read_bytes()[8:16], "little"))[2])
        stack = list(group)
        while stack:
            place = stack.pop()
            if not place & abc_reader.IS_DATA:
                stack += archive.group(place)
            elif len(data := archive.data(place)) > 1000:  # samples of P, velocities and ids
                keys.append((data[:16], data[16:]))
        self.assertEqual(len({key for key, _ in keys}), len({content for _, content in keys}))

    def test_failed_run_leaves_its_outputs(self):
        file = self.run_vat(f"{SCENES}/unstable.json", "run.abc", "--until", "1", "--every", "0.001",
                            exit_code=1)
        self.assertFalse(file.exists())
        archive = abc_reader.Archive(pathlib.Path(f"{file}.part"))
        self.assertGreater(len(archive.samplings[1][2]), 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
