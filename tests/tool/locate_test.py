# SPDX-License-Identifier: Apache-2.0
"""pierce locate: formats byte by byte, points with known answers, and every way to go wrong."""

import unittest

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest

# In the tetrahedron x, y, z >= 0, x + y + z <= 1.
POINTS = [(0.25, 0.25, 0.25), (0.125, 0.5, 0.25), (0, 0, 0), (1, 0, 0), (0.5, 0.5, 0), (0.25, 0, 0),
          (0.25, 0.25, 0.5), (0.25, 0.25, 0), (-0.25, 0, 0), (0.5, 0.5, 0.5), (1e30, -1e30, 0)]
EXPECTED = [1, 1, 0, 0, 0, 0, 0, 0, -1, -1, -1]


class Locate(ToolTest):
    def test_npy_is_one_int8_a_point(self):
        for number, dtype in (("float", "<f4"), ("double", "<f8"), ("float", "<f8")):
            self.succeed("locate", self.tetra(number), "--points", self.points(POINTS, dtype),
                         "--out", "l.npy")
            locations = self.load("l.npy")
            self.assertEqual(locations.dtype, np.int8)
            self.assertEqual(locations.tolist(), EXPECTED)
            self.assertIn(b"'descr': '|i1'", (self.dir / "l.npy").read_bytes()[:128])

    def test_csv_in_and_out(self):
        text = "x,y,z\n" + "\n".join(",".join(map(repr, p)) for p in POINTS) + "\n"
        self.succeed("locate", self.tetra(), "--points", self.write("p.csv", text), "--out",
                     "l.csv")
        lines = (self.dir / "l.csv").read_text().splitlines()
        self.assertEqual(lines, ["location"] + [str(x) for x in EXPECTED])

    def test_summary_counts_on_stderr_and_quiet_says_nothing(self):
        done = self.succeed("locate", self.tetra(), "--points", self.points(POINTS), "--out",
                            "l.npy")
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"points +11\n")
        self.assertRegex(done.stderr, r"inside +2 \(18\.2 %\)\n")
        self.assertRegex(done.stderr, r"on the surface +6 \(")
        self.assertRegex(done.stderr, r"outside +3 \(")
        done = self.succeed("locate", self.tetra(), "--points", self.points(POINTS), "--out",
                            "l.npy", "--quiet")
        self.assertEqual(done.stdout + done.stderr, "")

    def test_no_points_give_an_empty_file(self):
        self.succeed("locate", self.tetra(), "--points", self.points([]), "--out", "l.npy")
        self.assertEqual(self.load("l.npy").shape, (0,))
        self.assertEqual(self.load("l.npy").dtype, np.int8)

    def test_threads_do_not_change_a_byte(self):
        rng = np.random.default_rng(5)
        points = self.points(np.round(rng.uniform(-0.2, 1.2, (30000, 3)) * 16) / 16)
        files = []
        for threads in (1, 2, 5):
            self.succeed("locate", self.tetra(), "--points", points, "--out", "l.npy",
                         "--threads", threads)
            files.append((self.dir / "l.npy").read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])
        x, y, z = np.load(self.dir / points).T
        inside = (x > 0) & (y > 0) & (z > 0) & (x + y + z < 1)
        outside = (x < 0) | (y < 0) | (z < 0) | (x + y + z > 1)
        expected = inside.astype(np.int8) - outside.astype(np.int8)
        self.assertEqual(self.load("l.npy").tolist(), expected.tolist())

    def test_rule_nonzero_unites_overlapping_solids(self):
        shifted = [(x + 0.125, y + 0.125, z + 0.125) for x, y, z in TETRA_VERTICES]
        mesh = self.write_ply("two.ply", TETRA_VERTICES + shifted, TETRA_TRIANGLES +
                              [tuple(v + 4 for v in t) for t in TETRA_TRIANGLES])
        points = self.points([(0.25, 0.25, 0.25), (0.0625, 0.25, 0.25), (2, 2, 2)])
        self.succeed("locate", mesh, "--points", points, "--out", "l.npy")
        self.assertEqual(self.load("l.npy").tolist(), [-1, 1, -1])
        self.succeed("locate", mesh, "--points", points, "--out", "l.npy", "--rule", "nonzero")
        self.assertEqual(self.load("l.npy").tolist(), [1, 1, -1])

    def test_an_edge_that_is_split_on_one_side_only_is_no_gap(self):
        triangles = [(0, 2, 4), (4, 2, 1), *TETRA_TRIANGLES[1:]]
        points = self.points([(0.25, 0.25, 0.25), (0.5, 0, 0), (2, 2, 2)])
        for middle, status in ((0.5, 0), (0.5000001, 0)):  # anywhere on the line
            mesh = self.write_ply("t.ply", [*TETRA_VERTICES, (middle, 0, 0)], triangles)
            for rule in ("odd", "nonzero", "unique"):
                self.succeed("locate", mesh, "--points", points, "--out", "l.npy", "--rule", rule)
                self.assertEqual(self.load("l.npy").tolist(), [1, 0, -1])
        leaking = self.write_ply("u.ply", [*TETRA_VERTICES, (0.5, -1e-30, 0)], triangles)
        line = self.fail_with(1, "locate", leaking, "--points", points, "--out", "l.npy")
        self.assertIn("is not closed", line)

    def test_rule_unique_counts_faces_that_are_there_twice_once(self):
        mesh = self.write_ply("two.ply", TETRA_VERTICES, TETRA_TRIANGLES +
                              [t[::-1] for t in TETRA_TRIANGLES])
        points = self.points([(0.25, 0.25, 0.25), (2, 2, 2)])
        for rule, inside in (("odd", -1), ("nonzero", -1), ("unique", 1)):
            self.succeed("locate", mesh, "--points", points, "--out", "l.npy", "--rule", rule)
            self.assertEqual(self.load("l.npy").tolist(), [inside, -1])


class Refusals(ToolTest):
    def open_tetra(self):
        return self.write_ply("open.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3])

    def test_open_mesh_is_refused_with_the_first_open_edge_and_the_cure(self):
        line = self.fail_with(1, "locate", self.open_tetra(), "--points", self.points(POINTS),
                              "--out", "l.npy")
        self.assertEqual(line, "open.ply: the surface is not closed: edge 0-2 of triangle 0 "
                               "belongs to no other triangle (the first of 3 such edges); close "
                               "it, or go on regardless with --open-mesh; 'pierce info MESH "
                               "--open-edges FILE' lists all such edges")
        self.assertNotIn("l.npy", self.files())
        self.fail_with(1, "locate", self.open_tetra(), "--points", self.points([]), "--out",
                       "l.npy")

    def test_triangles_that_face_both_ways_are_refused_with_the_rule_that_would_do(self):
        turned = self.write_ply("turned.ply", TETRA_VERTICES,
                                [*TETRA_TRIANGLES[:3], TETRA_TRIANGLES[3][::-1]])
        line = self.fail_with(1, "locate", turned, "--points", self.points(POINTS), "--out",
                              "l.npy", "--rule", "nonzero")
        self.assertIn("take --rule odd, or go on regardless with --open-mesh", line)
        for word in ("::", "_", "option", "Odd"):
            self.assertNotIn(word, line)
        # Names of files are nobody's spelling.
        mesh = self.write_ply("my_open_mesh.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3])
        line = self.fail_with(1, "locate", mesh, "--points", self.points(POINTS), "--out", "l.npy")
        self.assertTrue(line.startswith("my_open_mesh.ply: the surface is not closed"), line)

    def test_open_mesh_option_goes_on_with_the_crossings_along_z(self):
        points = self.points([(0.25, 0.25, 0.25), (0.25, 0.25, -1), (0.25, 0.25, 1),
                              (0.25, 0.25, 0)])
        # Without x = 0 the tetrahedron is still closed above and below.
        mesh = self.write_ply("open.ply", TETRA_VERTICES,
                              [t for t in TETRA_TRIANGLES if t != (2, 0, 3)])
        self.succeed("locate", mesh, "--points", points, "--out", "l.npy", "--open-mesh")
        self.assertEqual(self.load("l.npy").tolist(), [1, -1, -1, 0])
        # Without z = 0 what is below counts as inside.
        mesh = self.write_ply("open.ply", TETRA_VERTICES, TETRA_TRIANGLES[1:])
        self.succeed("locate", mesh, "--points", points, "--out", "l.npy", "--open-mesh")
        self.assertEqual(self.load("l.npy").tolist(), [1, 1, -1, 1])

    def test_flipped_triangle_matters_to_the_rule_nonzero_only(self):
        a, b, c = TETRA_TRIANGLES[0]
        mesh = self.write_ply("flipped.ply", TETRA_VERTICES, [(a, c, b)] + TETRA_TRIANGLES[1:])
        points = self.points(POINTS)
        self.succeed("locate", mesh, "--points", points, "--out", "l.npy")
        self.assertEqual(self.load("l.npy").tolist(), EXPECTED)
        line = self.fail_with(1, "locate", mesh, "--points", points, "--out", "l.npy", "--rule",
                              "nonzero")
        self.assertIn("the triangles do not all face the same way: edge 0-1 of triangle 0", line)
        self.assertIn("take --rule odd", line)

    def test_bad_point_is_named_by_file_and_row(self):
        bad = list(POINTS)
        bad[7] = (0, float("nan"), 0)
        line = self.fail_with(1, "locate", self.tetra(), "--points", self.points(bad), "--out",
                              "l.npy")
        self.assertEqual(line, "p.npy: row 7 (counted from 0): bad point: it is not finite; give "
                               "finite coordinates")
        self.assertNotIn("l.npy", self.files())

    def test_wrong_columns_and_missing_options_are_one_line(self):
        np.save(self.dir / "six.npy", np.zeros((4, 6), "<f4"))
        line = self.fail_with(1, "locate", self.tetra(), "--points", "six.npy", "--out", "l.npy")
        self.assertIn("six.npy", line)
        self.fail_with(2, "locate", self.tetra(), "--out", "l.npy")
        self.fail_with(2, "locate", self.tetra(), "--points", self.points(POINTS), "--out", "p.npy")
        self.fail_with(2, "locate", self.tetra(), "--points", self.points(POINTS), "--out", "l.txt")
        self.fail_with(2, "locate", self.tetra(), "--points", self.points(POINTS), "--out", "l.npy",
                       "--rule", "even")

    def test_ctrl_c_leaves_no_file(self):
        self.expect_ctrl_c_leaves_no_file("locate", self.tetra(), "--points",
                                          self.endless_points(), "--out", "l.npy")


class BackToBack(ToolTest):
    def test_triangles_that_cancel_are_remarked_upon_where_nothing_is_inside(self):
        turned = [tuple(reversed(t)) for t in TETRA_TRIANGLES]
        both = self.write_ply("both.ply", TETRA_VERTICES, [*TETRA_TRIANGLES, *turned])
        remark = ("pierce: nothing is inside, and 8 of 8 triangles lie back to back and cancel: "
                  "--rule unique counts each place once\n")
        for rule in ("odd", "nonzero"):
            done = self.succeed("locate", both, "--point", "0.1,0.1,0.1", "--rule", rule)
            self.assertEqual((done.stdout, done.stderr), ("outside\n", remark))
        points = self.points([(0.125, 0.125, 0.125)])
        done = self.succeed("locate", both, "--points", points, "--out", "l.npy", "--quiet")
        self.assertEqual(done.stderr, remark)
        done = self.succeed("locate", both, "--point", "0.1,0.1,0.1", "--rule", "unique")
        self.assertEqual((done.stdout, done.stderr), ("inside\n", ""))
        done = self.succeed("locate", self.tetra(), "--point", "9,9,9")
        self.assertEqual((done.stdout, done.stderr), ("outside\n", ""))


if __name__ == "__main__":
    unittest.main()
