# SPDX-License-Identifier: Apache-2.0
"""pierce nearest: formats byte by byte, points with known answers, and every way to go wrong."""

import unittest

import numpy as np

from harness import NONE, TETRA_TRIANGLES, TETRA_VERTICES, ToolTest, field_bytes


def nearest_type(number):
    return np.dtype([("x", number), ("y", number), ("z", number), ("distance", number),
                     ("u", number), ("v", number), ("w", number), ("geometry", "<u4"),
                     ("triangle", "<u4"), ("feature", "|u1")], align=True)


# Of the tetrahedron x, y, z >= 0, x + y + z <= 1, with the triangles (0, 2, 1), (0, 1, 3), ...:
# a point and its record. Outside below the face z = 0, beyond the vertex 1, before the edge along
# x, on a vertex, and inside, nearest to y = 0.
POINTS = [(0.25, 0.125, -2), (3, 0, 0), (0.5, -3, -4), (0, 0, 0), (0.375, 0.0625, 0.25)]
RECORDS = [(0.25, 0.125, 0, 2, 0.125, 0.25, 0.625, 0, 0, 6),
           (1, 0, 0, 2, 0, 1, 0, 0, 0, 2),
           (0.5, 0, 0, 5, 0, 0.5, 0.5, 0, 0, 5),
           (0, 0, 0, 0, 0, 0, 1, 0, 0, 0),
           (0.375, 0, 0.25, 0.0625, 0.375, 0.25, 0.375, 0, 1, 6)]


class Nearest(ToolTest):
    def asked(self, *more, points=None, mesh=None, out="n.npy"):
        return self.succeed("nearest", mesh or self.tetra(), "--points",
                            points or self.points(POINTS), "--out", out, *more)

    def test_npy_is_one_record_a_point(self):
        for number, dtype, out in (("float", "<f4", "<f4"), ("double", "<f8", "<f8"),
                                   ("float", "<f8", "<f8")):
            self.asked(mesh=self.tetra(number), points=self.points(POINTS, dtype))
            found = self.load("n.npy")
            self.assertEqual(found.dtype, nearest_type(out))
            expected = np.array(RECORDS, nearest_type(out))
            self.assertEqual(field_bytes(found), field_bytes(expected))

    def test_csv_in_and_out_has_the_same_columns_and_numbers(self):
        text = "x,y,z\n" + "\n".join(",".join(map(repr, p)) for p in POINTS) + "\n"
        self.asked(points=self.write("p.csv", text), out="n.csv")
        lines = (self.dir / "n.csv").read_text().splitlines()
        self.assertEqual(lines[0], "x,y,z,distance,u,v,w,geometry,triangle,feature")
        self.assertEqual([tuple(map(float, line.split(","))) for line in lines[1:]], RECORDS)

    def test_signed_distances_are_negative_inside_and_zero_on_the_surface(self):
        done = self.asked("--signed")
        self.assertEqual(self.load("n.npy")["distance"].tolist(), [2, 2, 5, 0, -0.0625])
        self.assertFalse(np.signbit(self.load("n.npy")["distance"][3]))
        self.assertRegex(done.stderr, r"inside +1 \(20 %\)\n")
        np.testing.assert_array_equal(abs(self.load("n.npy")["distance"]),
                                      [record[3] for record in RECORDS])

    def test_beyond_the_radius_there_is_none_and_exactly_as_far_there_is(self):
        none = (0, 0, 0, np.inf, 0, 0, 0, NONE, NONE, 6)
        self.asked("--radius", "2")
        expected = [none if record[3] > 2 else record for record in RECORDS]
        self.assertEqual(self.load("n.npy").tolist(), expected)
        done = self.asked("--radius", "0.01", "--signed")
        self.assertEqual(self.load("n.npy")["distance"].tolist(),
                         [np.inf, np.inf, np.inf, 0, -np.inf])
        self.assertRegex(done.stderr, r"within the radius +1 \(20 %\)\n")

    def test_a_radius_that_is_no_float_makes_the_scene_double(self):
        self.asked("--radius", "0.1")
        self.assertEqual(self.load("n.npy").dtype, nearest_type("<f8"))
        done = self.asked("--radius", "0.1", "--precision", "float")
        self.assertIn("the numbers of --radius are rounded to 32 bits", done.stderr)
        self.assertEqual(self.load("n.npy").dtype, nearest_type("<f4"))

    def test_summary_counts_on_stderr_and_quiet_says_nothing(self):
        done = self.asked()
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"points +5\n")
        self.assertRegex(done.stderr, r"within the radius +5 \(100 %\)\n")
        self.assertNotIn("inside", done.stderr)
        done = self.asked("--quiet")
        self.assertEqual(done.stdout + done.stderr, "")

    def test_no_points_give_an_empty_file(self):
        self.asked(points=self.points([]))
        self.assertEqual(self.load("n.npy").shape, (0,))
        self.assertEqual(self.load("n.npy").dtype, nearest_type("<f4"))

    def test_threads_do_not_change_a_byte(self):
        rng = np.random.default_rng(5)
        points = self.points(np.round(rng.uniform(-0.5, 1.5, (3000, 3)) * 16) / 16)
        files = []
        for threads in (1, 2, 5):
            self.asked("--signed", "--threads", threads, points=points)
            files.append((self.dir / "n.npy").read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])
        found, given = self.load("n.npy"), np.load(self.dir / points)
        nearest = np.stack([found[axis] for axis in "xyz"], 1)
        np.testing.assert_allclose(np.linalg.norm(nearest - given, axis=1),
                                   abs(found["distance"]), rtol=1e-5, atol=1e-6)


class Refusals(ToolTest):
    def refused(self, status, *more, points=None, mesh=None):
        mesh, points = mesh or self.tetra(), points or self.points(POINTS)
        before = self.files()
        line = self.fail_with(status, "nearest", mesh, "--points", points, "--out", "n.npy", *more)
        self.assertEqual(self.files(), before)
        return line

    def test_bad_point_is_named_by_file_and_row(self):
        for more in ((), ("--signed",)):
            bad = [*POINTS, (0, float("nan"), 0)]
            self.assertEqual(self.refused(1, *more, points=self.points(bad)),
                             "p.npy: row 5 (counted from 0): bad point: it is not finite; give "
                             "finite coordinates")

    def test_open_mesh_has_no_sign_unless_told_otherwise(self):
        mesh = self.write_ply("open.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3])
        line = self.refused(1, "--signed", mesh=mesh)
        self.assertTrue(line.startswith("open.ply: the surface is not closed: edge 0-2"), line)
        points = self.points(POINTS)
        for more in ((), ("--signed", "--open-mesh")):
            self.succeed("nearest", mesh, "--points", points, "--out", "n.npy", *more)

    def test_bad_radius_and_options_of_the_sign_alone_are_one_line(self):
        self.assertEqual(self.refused(2, "--radius", "-1"),
                         "nearest: --radius: -1 is not 0 or more")
        self.assertEqual(self.refused(2, "--radius", "nan"),
                         "nearest: --radius: nan is not 0 or more")
        self.assertIn("--signed", self.refused(2, "--rule", "odd"))
        self.assertIn("--signed", self.refused(2, "--open-mesh"))
        self.refused(2, "--radius", "far")

    def test_wrong_columns_and_missing_options_are_one_line(self):
        np.save(self.dir / "six.npy", np.zeros((4, 6), "<f4"))
        self.assertIn("six.npy", self.refused(1, points="six.npy"))
        self.fail_with(2, "nearest", self.tetra(), "--out", "n.npy")
        self.fail_with(2, "nearest", self.tetra(), "--points", self.points(POINTS), "--out",
                       "p.npy")

    def test_ctrl_c_leaves_no_file(self):
        self.expect_ctrl_c_leaves_no_file("nearest", self.tetra(), "--points",
                                          self.endless_points(), "--out", "n.npy", "--signed")


if __name__ == "__main__":
    unittest.main()
