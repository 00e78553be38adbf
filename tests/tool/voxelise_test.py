# SPDX-License-Identifier: Apache-2.0
"""pierce voxelise: the file byte by byte, cells with known answers, grids that make no sense."""

import sys
import unittest

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest


def tetra_locations(x, y, z):
    """In the tetrahedron x, y, z >= 0, x + y + z <= 1."""
    inside = (x > 0) & (y > 0) & (z > 0) & (x + y + z < 1)
    outside = (x < 0) | (y < 0) | (z < 0) | (x + y + z > 1)
    return inside.astype(np.int8) - outside.astype(np.int8)


def centres(origin, spacing, size):
    return np.meshgrid(*[o + (np.arange(n) + 0.5) * s for o, s, n in zip(origin, spacing, size)],
                       indexing="ij")


class Voxelise(ToolTest):
    def grid(self, *args, mesh=None):
        done = self.succeed("voxelise", mesh or self.tetra(), "--out", "g.npy", *args)
        return self.load("g.npy"), done

    def test_size_alone_covers_the_mesh_with_cubes(self):
        cells, done = self.grid("--size", 16)
        self.assertEqual(cells.shape, (16, 16, 16))
        self.assertEqual(cells.dtype, np.int8)
        self.assertTrue(cells.flags.c_contiguous)
        expected = tetra_locations(*centres((0, 0, 0), [1 / 16] * 3, (16, 16, 16)))
        np.testing.assert_array_equal(cells, expected)
        self.assertEqual({-1, 1}, set(np.unique(cells)))
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"cells +4,096 = 16x16x16\n")
        self.assertRegex(done.stderr, r"origin +0,0,0\n")
        self.assertRegex(done.stderr, r"spacing +0.0625,0.0625,0.0625\n")
        self.assertRegex(done.stderr, rf"inside +{np.sum(cells == 1)} \(")

    def test_a_flat_box_gets_fewer_cells_on_its_short_sides(self):
        vertices = [(x, y / 2, z / 4) for x, y, z in TETRA_VERTICES]
        mesh = self.write_ply("flat.ply", vertices, TETRA_TRIANGLES)
        self.assertEqual(self.grid("--size", 8, mesh=mesh)[0].shape, (8, 4, 2))
        self.assertEqual(self.grid("--size", "8x8x8", mesh=mesh)[0].shape, (8, 8, 8))

    def test_no_layer_is_there_for_a_number_that_was_rounded(self):
        # 0.3 / 3 is less than 0.1, so 0.2 would take three cells.
        for kind, size, from_ in [("double", (3, 2, 1), 0), ("float", (3, 2, 1), 0),
                                  ("double", (3, 2, 1), 100.7), ("float", (12, 8, 4), 7.3)]:
            unit = 0.3 / size[0]
            vertices = [[from_ + unit * n * c for n, c in zip(size, v)] for v in TETRA_VERTICES]
            mesh = self.write_ply("slab.ply", vertices, TETRA_TRIANGLES, kind)
            self.assertEqual(self.grid("--size", size[0], mesh=mesh)[0].shape, size)
            vertices[3] = [x + 1e-3 * unit * (k == 2) for k, x in enumerate(vertices[3])]
            mesh = self.write_ply("slab.ply", vertices, TETRA_TRIANGLES, kind)
            self.assertEqual(self.grid("--size", size[0], mesh=mesh)[0].shape,
                             (*size[:2], size[2] + 1))

    def test_origin_and_spacing_place_the_grid(self):
        size, origin, spacing = (11, 12, 13), (-0.375, -0.5, -0.25), (0.125, 0.25, 0.125)
        cells, _ = self.grid("--size", "11x12x13", "--origin", "-0.375,-0.5,-0.25", "--spacing",
                             "0.125,0.25,0.125")
        np.testing.assert_array_equal(cells, tetra_locations(*centres(origin, spacing, size)))
        cells, _ = self.grid("--size", 9, "--origin", "-.625,-.625,-.625", "--spacing",
                             "0.25")
        self.assertEqual({-1, 0, 1}, set(np.unique(cells)))
        np.testing.assert_array_equal(
            cells, tetra_locations(*centres([-0.625] * 3, [0.25] * 3, (9, 9, 9))))

    def test_bool_is_true_inside_and_on_the_surface(self):
        int8, _ = self.grid("--size", 12)
        as_bool, _ = self.grid("--size", 12, "--type", "bool")
        self.assertEqual(as_bool.dtype, np.dtype("|b1"))
        np.testing.assert_array_equal(as_bool, int8 >= 0)

    def test_numbers_that_are_no_floats_make_the_scene_double(self):
        _, done = self.grid("--size", 4, "--spacing", "0.25")
        self.assertRegex(done.stderr, r"precision +float\n")
        _, done = self.grid("--size", 4, "--spacing", "0.3")
        self.assertRegex(done.stderr, r"precision +double\n")
        _, done = self.grid("--size", 4, "--spacing", "0.3", "--precision", "float")
        self.assertIn("the numbers of --origin and --spacing are rounded to 32 bits", done.stderr)

    def test_is_what_locate_says_of_the_centres(self):
        # A spacing that is no double times no float; every centre is rounded once.
        cells, _ = self.grid("--size", 7, "--spacing", "0.15", "--origin", "-0.05,0,0")
        x, y, z = centres((-0.05, 0, 0), [0.15] * 3, (7, 7, 7))
        np.save(self.dir / "p.npy", np.stack([x.ravel(), y.ravel(), z.ravel()], 1))
        self.succeed("locate", self.tetra(), "--points", "p.npy", "--out", "l.npy")
        same = self.load("l.npy") == cells.ravel()
        self.assertGreater(np.mean(same), 0.97)  # NumPy rounds twice on the way to a centre

    def test_threads_do_not_change_a_byte(self):
        files = []
        for threads in (1, 2):
            self.grid("--size", 40, "--threads", threads, "--quiet")
            files.append((self.dir / "g.npy").read_bytes())
        self.assertEqual(files[0], files[1])


class Refusals(ToolTest):
    def refused(self, status, *args):
        line = self.fail_with(status, "voxelise", self.tetra(), "--out", "g.npy", *args)
        self.assertNotIn("g.npy", self.files())
        return line

    def test_bad_grids_are_one_line(self):
        self.assertIn("'12x' is not a number of cells", self.refused(2, "--size", "12x"))
        self.refused(2, "--size", "0")
        self.refused(2, "--size", "3x4")
        self.refused(2, "--size", "3x4x5x6")
        self.refused(2, "--size", "-3")
        self.refused(2)
        self.assertEqual(self.refused(2, "--size", "3", "--spacing", "0"),
                         "voxelise: --spacing: 0 is not greater than 0")
        self.refused(2, "--size", "3", "--spacing", "1,2")
        self.refused(2, "--size", "3", "--origin", "1,2")
        self.assertIn("give --spacing", self.refused(2, "--size", "3", "--origin", "5,5,5"))
        for size in ("4000000x1x1", "2097153"):
            self.assertIn("at most 2097152", self.refused(2, "--size", size))
        if sys.platform == "linux":  # a thousand petabytes, which no disk has, are not begun
            self.assertRegex(self.refused(1, "--size", "1000000x1000000x1000000"),
                             "^g.npy: has no room for 1,000,000,000,000,000,... bytes: ")
        self.fail_with(2, "voxelise", self.tetra(), "--out", "g.csv", "--size", "3")

    def test_open_mesh_is_refused_unless_told_otherwise(self):
        mesh = self.write_ply("open.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3])
        line = self.fail_with(1, "voxelise", mesh, "--out", "g.npy", "--size", "8")
        self.assertTrue(line.startswith("open.ply: the surface is not closed: edge 0-2"), line)
        self.assertEqual(self.files(), ["open.ply"])
        self.succeed("voxelise", mesh, "--out", "g.npy", "--size", "8", "--open-mesh")

    def test_ctrl_c_leaves_no_file(self):
        self.expect_ctrl_c_leaves_no_file("voxelise", self.tetra(), "--size", "3000", "--out",
                                          "g.npy")


if __name__ == "__main__":
    unittest.main()
