# SPDX-License-Identifier: Apache-2.0
"""pierce weld: against its definition over fractions; what it writes is read back bit by bit."""

import json
import unittest
from fractions import Fraction

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest


def welded(vertices, triangles, distance):
    """The definition: (vertices, triangles)."""
    limit = Fraction(float(distance)) ** 2
    kept, vertex_of = [], []
    for vertex in vertices:
        for i, other in enumerate(kept):
            if not np.isfinite(vertex).all() or not np.isfinite(other).all():
                continue
            if sum((Fraction(float(p)) - Fraction(float(q))) ** 2
                   for p, q in zip(vertex, other)) <= limit:
                vertex_of.append(i)
                break
        else:
            vertex_of.append(len(kept))
            kept.append(vertex)
    corners = [tuple(vertex_of[v] for v in t) for t in triangles]
    return np.array(kept), [t for t in corners if len(set(t)) == 3]


class Weld(ToolTest):
    def expect(self, vertices, triangles, distance, number="float"):
        dtype = {"float": "<f4", "double": "<f8"}[number]
        vertices = np.asarray(vertices, dtype).reshape(-1, 3)
        mesh = self.write_ply("m.ply", vertices, triangles, number)
        got = json.loads(self.succeed("weld", mesh, "--distance", repr(float(distance)), "--out",
                                      "w.npz", "--json").stdout)
        points, corners = welded(vertices, triangles, distance)
        with np.load(self.dir / "w.npz") as arrays:
            self.assertEqual(arrays["vertices"].dtype, np.dtype(dtype))
            self.assertEqual(arrays["vertices"].tobytes(), points.astype(dtype).tobytes())
            self.assertEqual(arrays["triangles"].tolist(), [list(t) for t in corners])
        self.assertEqual((got["vertices"], got["triangles"], got["collapsed"]),
                         (len(points), len(corners), len(triangles) - len(corners)))
        self.assertLessEqual(got["moved"], float(distance) * (1 + 1e-15))
        return got

    def test_corners_of_triangles_become_vertices(self):
        soup = [TETRA_VERTICES[v] for t in TETRA_TRIANGLES for v in t]
        negative = np.array(soup, float) * [1, 1, 1]
        negative[::2][negative[::2] == 0] = -0.0
        for vertices in (soup, negative):
            got = self.expect(vertices, np.arange(12).reshape(4, 3).tolist(), 0)
            self.assertEqual((got["vertices_before"], got["vertices"], got["open_edges"]),
                             (12, 4, 0))

    def test_distances_are_decided_exactly(self):
        d = 0.1
        for number, dtype in (("float", np.float32), ("double", np.float64)):
            ends = [dtype(0.1), *(np.nextafter(dtype(0.1), dtype(x)) for x in (0, 1))]
            for far in ends:
                self.expect([(0, 0, 0), (far, 0, 0), (5, 5, 5), (5, 5 + far, 5), (9, 0, 0),
                             (0, 9, 0)], [(0, 2, 4), (1, 3, 5), (0, 1, 5)], d, number)
        # 3, 4 and 5, scaled by powers of two down to where squares are lost.
        for scale in (1.0, 2.0**-40, 2.0**-540, 2.0**-1070, 2.0**500):
            for nudge in (0, 1):
                x = np.array([(0, 0, 0), (3, 4, 0), (0, 40, 0), (0, 0, 90), (40, 1, 1)]) * scale
                if nudge:
                    x[1, 1] = np.nextafter(x[1, 1], np.inf)
                self.expect(x, [(0, 2, 3), (1, 2, 4), (0, 1, 2)], 5 * scale, "double")

    def test_chains_do_not_run_away(self):
        line = [(i * 0.4, 0, 0) for i in range(12)] + [(0, 9, 0)]
        self.expect(line, [(i, i + 1, 12) for i in range(11)], 1)

    def test_random_points_against_the_definition(self):
        rng = np.random.default_rng(9)
        for spread, distance in ((1, 0.1), (1, 0.5), (4, 3), (1e-3, 1e-4), (1e6, 2e5), (3, 2**-60)):
            for number in ("float", "double"):
                points = rng.uniform(-1, 1, (150, 3)) * spread
                points[100:] = points[:50] + rng.uniform(-1, 1, (50, 3)) * distance * 0.6
                points[10] = points[20]
                points[30:40] = np.round(points[30:40] / distance) * distance
                triangles = rng.integers(0, 150, (120, 3)).tolist()
                self.expect(points, triangles, distance, number)

    def test_huge_beside_tiny(self):
        points = [(1e300, 0, 0), (1e300, 0, 0), (1e-300, 0, 0), (2e-300, 0, 0), (0, 1e-310, 0),
                  (1, 1, 1), (-1e300, 1, 0)]
        self.expect(points, [(0, 2, 5), (1, 3, 5), (4, 5, 6), (2, 3, 5)], 1e-300, "double")
        self.expect(points, [(0, 2, 5), (1, 3, 5), (4, 5, 6), (2, 3, 5)], 0, "double")

    def test_unused_vertices_may_be_anything(self):
        nan, inf = float("nan"), float("inf")
        self.expect([(nan, 0, 0), (nan, 0, 0), (inf, 0, 0), (inf, 0, 0), *TETRA_VERTICES],
                    [tuple(v + 4 for v in t) for t in TETRA_TRIANGLES], 0.25)

    def test_every_format_is_read_back(self):
        rng = np.random.default_rng(3)
        for number in ("float", "double"):
            dtype = "<f4" if number == "float" else "<f8"
            points = rng.uniform(-1, 1, (40, 3)).astype("<f4").astype(dtype)
            if number == "double":
                points += 2.0**-45
            triangles = [(i, i + 1, i + 2) for i in range(38)]
            mesh = self.write_ply("m.ply", points, triangles, number)
            for out in ("o.ply", "o.OBJ", "o.stl"):
                more = ["--precision", "float"] if out == "o.stl" and number == "double" else []
                if more:
                    line = self.fail_with(1, "weld", mesh, "--out", out)
                    self.assertIn("STL holds floats, and vertex 0 has the coordinate", line)
                self.succeed("weld", mesh, "--out", out, *more)
                self.succeed("weld", out, "--out", "back.npz")
                expected = points.astype("<f4") if more else points
                with np.load(self.dir / "back.npz") as arrays:
                    corners = arrays["vertices"][arrays["triangles"]]
                np.testing.assert_array_equal(corners, expected[np.array(triangles)])

    def test_several_files_become_one(self):
        halves = [self.write_ply(f"h{i}.ply", np.array(TETRA_VERTICES) + i * 1e-5,
                                 TETRA_TRIANGLES[i::2]) for i in (0, 1)]
        text = self.succeed("weld", *halves, "--out", "t.ply").stderr
        self.assertIn("open edges  8, by position 8 before", text)
        text = self.succeed("weld", *halves, "--distance", "1e-4", "--out", "t.ply").stderr
        self.assertIn("vertices    4 of 8", text)
        self.assertIn("open edges  0, by position 8 before", text)
        self.assertIn("closed by index     yes", self.succeed("info", "t.ply").stdout)

    def test_what_cannot_be_is_refused(self):
        mesh = self.tetra()
        self.assertIn("--distance", self.fail_with(2, "weld", mesh, "--out", "o.ply", "--distance",
                                                   "-1"))
        self.assertIn("--distance", self.fail_with(2, "weld", mesh, "--out", "o.ply", "--distance",
                                                   "nan"))
        self.assertIn("must end in .ply or .obj or .stl or .npz",
                      self.fail_with(2, "weld", mesh, "--out", "o.off"))
        self.assertIn("is an input file", self.fail_with(2, "weld", mesh, "--out", mesh))
        self.assertEqual(self.fail_with(1, "weld", mesh, "--out", "o.ply", "--distance", "9"),
                         f"{mesh}: every triangle collapses; weld by a smaller distance")
        self.succeed("build", mesh, "--out", "s.pierce")
        self.assertIn("is a scene file", self.fail_with(2, "weld", "s.pierce", "--out", "o.ply"))
        self.assertEqual(self.files(), ["s.pierce", mesh])


if __name__ == "__main__":
    unittest.main()
