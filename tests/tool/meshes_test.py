# SPDX-License-Identifier: Apache-2.0
"""Several meshes on one command line, the parts of files, and the list of open edges."""

import csv
import unittest

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest

SQUARE = [(0, 1, 2), (0, 2, 3)]


def square(z, size=1):
    return [(0, 0, z), (size, 0, z), (size, size, z), (0, size, z)]


class MeshesTest(ToolTest):
    def squares(self):
        """One square at z = 1 and a smaller one at z = 2, in two files."""
        return (self.write_ply("low.ply", square(1), SQUARE),
                self.write_ply("high.ply", square(2, 0.5), SQUARE))

    def parts_obj(self):
        """The same two squares as groups, whose faces are mixed."""
        vertices = "".join(f"v {x} {y} {z}\n" for x, y, z in square(1) + square(2, 0.5))
        return self.write("parts.obj", vertices + "g low\nf 1 2 3\ng high\nf 5 6 7\ng low\n"
                                                  "f 1 3 4\ng high\nf 5 7 8\n")

    def rays(self):
        """Down through both squares, through the lower one, past both; each near a diagonal."""
        return self.write_rays("r.npy", [(0.25, 0.125, 5, 0, 0, -1), (0.5, 0.75, 5, 0, 0, -1),
                                         (3, 3, 5, 0, 0, -1)])

    def info(self, *args):
        """The rows of each block of `pierce info`."""
        blocks = self.succeed("info", *args).stdout.split("\n\n")
        return [{line[:20].strip(): line.split("  ", 1)[1].strip()
                 for line in block.splitlines()} for block in map(str.strip, blocks)]


class Several(MeshesTest):
    def test_files_are_geometries_in_order(self):
        low, high = self.squares()
        for meshes, near, far in (((low, high), 1, 0), ((high, low), 0, 1)):
            done = self.succeed("cast", *meshes, "--rays", self.rays(), "--out", "h.npy")
            hits = self.load("h.npy")
            self.assertEqual(hits["geometry"].tolist()[:2], [near, far])
            self.assertEqual(hits["triangle"].tolist()[:2], [0, 1])
            self.assertEqual(hits["t"].tolist()[:2], [3, 4])
            self.assertIn("geometries        2\ntriangles         4\n", done.stderr)

    def test_parts_are_geometries(self):
        obj = self.parts_obj()
        self.succeed("cast", obj, "--parts", "--rays", self.rays(), "--out", "p.npy")
        self.succeed("cast", obj, "--rays", self.rays(), "--out", "f.npy")
        parts, file = self.load("p.npy"), self.load("f.npy")
        self.assertEqual(parts[["geometry", "triangle"]].tolist()[:2], [(1, 0), (0, 1)])
        self.assertEqual(file[["geometry", "triangle"]].tolist()[:2], [(0, 1), (0, 2)])
        self.assertEqual(parts["t"].tolist(), file["t"].tolist())

    def test_answers_about_points_are_of_all_meshes_together(self):
        # Two halves of a tetrahedron, neither closed.
        halves = [self.write_ply(f"half{i}.ply", TETRA_VERTICES, TETRA_TRIANGLES[i::2])
                  for i in (0, 1)]
        points = self.points([(0.125, 0.125, 0.125), (1, 1, 1), (0, 0, 0.5)])
        self.succeed("locate", *halves, "--points", points, "--out", "l.npy")
        self.assertEqual(self.load("l.npy").tolist(), [1, -1, 0])
        self.succeed("nearest", *halves, "--points", points, "--out", "n.npy", "--signed")
        self.assertEqual(self.load("n.npy")["geometry"].tolist(), [0, 0, 1])
        self.succeed("voxelise", *halves, "--size", "4", "--out", "v.npy")
        self.succeed("voxelise", self.tetra(), "--size", "4", "--out", "w.npy")
        self.assertEqual(self.load("v.npy").tolist(), self.load("w.npy").tolist())
        line = self.fail_with(1, "locate", halves[0], "--points", points, "--out", "m.npy")
        self.assertTrue(line.startswith("half0.ply: the surface is not closed"), line)
        third = self.write_ply("third.ply", TETRA_VERTICES, TETRA_TRIANGLES[:1])
        line = self.fail_with(1, "locate", *halves, third, "--points", points, "--out", "m.npy")
        self.assertTrue(line.startswith("half0.ply and 2 others: the surface is not closed: edge "
                                        "0-2 of triangle 0 of geometry 0"), line)

    def test_camera_sees_all_meshes(self):
        low, high = self.squares()
        both = self.write_ply("both.ply", square(1) + square(2, 0.5),
                              [*SQUARE, (4, 5, 6), (4, 6, 7)])
        for meshes, out in (((low, high), "two"), ((both,), "one")):
            self.succeed("rays", *meshes, "--size", "8x8", "--out", out + ".npy")
            for shade in ("normal", "clay"):
                self.succeed("render", *meshes, "--size", "32x32", "--shade", shade, "--out",
                             f"{out}-{shade}.png")
        self.assertEqual(self.load("two.npy").tolist(), self.load("one.npy").tolist())
        for shade in ("normal", "clay"):
            self.assertEqual(*((self.dir / f"{n}-{shade}.png").read_bytes()
                               for n in ("one", "two")))

    def test_attributes_belong_to_their_mesh(self):
        red = self.write_ply("red.ply", square(1), SQUARE, extra={
            "red": ("uchar", 255), "green": ("uchar", 0), "blue": ("uchar", 0)})
        plain = self.write_ply("plain.ply", square(2, 0.5), SQUARE)
        self.succeed("render", red, plain, "--shade", "color", "--out", "p.png", "--size", "16x16")
        message = self.fail_with(1, "render", plain, plain, "--shade", "color", "--out", "q.png")
        self.assertIn("plain.ply and plain.ply: has no vertex colours", message)

    def test_one_file_of_doubles_makes_all_double(self):
        low, high = self.squares()
        wide = self.write_ply("wide.ply", square(2, 0.5), SQUARE, "double")
        for meshes, size in (((low, high), 4), ((low, wide), 8)):
            self.succeed("cast", *meshes, "--rays", self.rays(), "--out", "h.npy")
            self.assertEqual(self.load("h.npy").dtype["t"].itemsize, size)
        done = self.succeed("cast", low, wide, "--rays", self.rays(), "--out", "h.npy",
                            "--precision", "float")
        self.assertIn("the numbers of wide.ply are rounded to 32 bits", done.stderr)

    def test_the_file_at_fault_is_named(self):
        low, _ = self.squares()
        bad = self.write_ply("bad.ply", [(0, 0, 0), (1, 0, 0), (0, np.nan, 0)], [(0, 1, 2)])
        line = self.fail_with(1, "cast", low, bad, "--rays", self.rays(), "--out", "h.npy")
        self.assertTrue(line.startswith("bad.ply: triangle 0"), line)
        line = self.fail_with(2, "cast", low, "x.ply", "--rays", "r.npy", "--out", low)
        self.assertIn("is an input file", line)

    def test_check_takes_files_by_themselves_or_together(self):
        low, high = self.squares()
        text = self.succeed("check", low, high, "--rays", "50").stdout
        self.assertIn("200 rays on 4 scenes: 0 differences", text)
        text = self.succeed("check", low, high, "--rays", "50", "--together").stdout
        self.assertIn("100 rays on 2 scenes: 0 differences", text)
        self.assertRegex(text, r"low.ply and high.ply +float +4 ")
        text = self.succeed("check", self.parts_obj(), "--parts", "--rays", "500").stdout
        self.assertIn("1,000 rays on 2 scenes: 0 differences", text)


class InfoOfSeveral(MeshesTest):
    def test_parts_are_named_and_told_by_themselves(self):
        together, low, high = self.info(self.parts_obj(), "--parts")
        self.assertEqual((together["geometries"], together["triangles"]), ("2", "4"))
        self.assertEqual(low["geometry 0"], "parts.obj, part 'low'")
        self.assertEqual(high["geometry 1"], "parts.obj, part 'high'")
        self.assertEqual(high["bounds"], "0,0,2 to 0.5,0.5,2")
        self.assertEqual((low["vertices"], low["triangles"]), ("4, 0 of them unused", "2"))
        self.assertNotIn("closed by index", together)

    def test_two_open_halves_are_closed_together(self):
        halves = [self.write_ply(f"half{i}.ply", TETRA_VERTICES, TETRA_TRIANGLES[i::2])
                  for i in (0, 1)]
        together, *each = self.info(*halves)
        self.assertEqual(together["closed by position"], "yes")
        for one in each:
            self.assertTrue(one["closed by position"].startswith("no: 4 of 5 edges open"), one)

    def test_degenerates_and_duplicates_are_counted_by_geometry_and_together(self):
        flat = self.write_ply("flat.ply", TETRA_VERTICES, [(0, 1, 1), (0, 2, 1)])
        together, one, two = self.info(self.tetra(), flat)
        for rows, degenerate, duplicates in ((together, "1", "1"), (one, "0", "0"),
                                             (two, "1", "0")):
            self.assertEqual(rows["without area"], degenerate)
            self.assertEqual(rows["duplicates"], duplicates)

    def test_edge_of_a_later_geometry_is_named(self):
        hole = self.write_ply("hole.ply", [(x + 5, y, z) for x, y, z in TETRA_VERTICES],
                              TETRA_TRIANGLES[1:])
        together = self.info(self.tetra(), hole)[0]
        self.assertIn("the first: edge 0-1 of triangle 0 of geometry 1, (5, 0, 0) to (6, 0, 0), "
                      "belongs to no other triangle", together["closed by position"])


class OpenEdges(MeshesTest):
    def test_all_are_listed(self):
        mesh = self.write_ply("open.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3])
        rows = self.info(mesh, "--open-edges", "e.csv")[0]
        self.assertEqual(rows["wrote"],
                         "e.csv: 3 edges not used as often one way as the other")
        with open(self.dir / "e.csv", newline="", encoding="ascii") as file:
            edges = list(csv.DictReader(file))
        self.assertEqual([(e["triangle"], e["from_vertex"], e["to_vertex"]) for e in edges],
                         [("0", "0", "2"), ("1", "3", "0"), ("2", "2", "3")])
        self.assertEqual([float(edges[1][k]) for k in ("from_x", "from_y", "from_z", "to_x",
                                                       "to_y", "to_z")], [0, 0, 1, 0, 0, 0])
        self.assertEqual({(e["geometry"], e["forward"], e["backward"]) for e in edges},
                         {("0", "1", "0")})

    def test_ply_has_the_edges_of_a_viewer(self):
        # As separate corners: three edges, of three vertices by position.
        vertices = [TETRA_VERTICES[v] for t in TETRA_TRIANGLES[:3] for v in t]
        mesh = self.write_ply("open.ply", vertices, [(0, 1, 2), (3, 4, 5), (6, 7, 8)])
        self.succeed("info", mesh, "--open-edges", "e.PLY")
        data = (self.dir / "e.PLY").read_bytes()
        header, body = data.split(b"end_header\n")
        self.assertIn(b"element vertex 3\n", header)
        self.assertIn(b"element edge 3\n", header)
        points = np.frombuffer(body[:36], "<f4").reshape(3, 3)
        edges = np.frombuffer(body[36:], "<u4").reshape(3, 2)
        ends = {tuple(map(tuple, points[pair].tolist())) for pair in edges}
        self.assertEqual(ends, {((0, 0, 0), (0, 1, 0)), ((0, 0, 1), (0, 0, 0)),
                                ((0, 1, 0), (0, 0, 1))})

    def test_as_many_as_are_counted(self):
        """On a soup of triangles over few vertices, with edges used up to many times."""
        rng = np.random.default_rng(5)
        vertices = rng.integers(0, 2, (40, 3)).astype(float)  # equal positions, and -0
        vertices[::3] *= -1
        triangles = rng.integers(0, 40, (60, 3))
        mesh = self.write_ply("soup.ply", vertices, triangles)
        rows = self.info(mesh, "--open-edges", "e.csv")[0]
        closed = rows["closed by position"].split()
        count = int(closed[1]) + int(closed[closed.index("open,") + 1])
        self.assertGreater(count, 5)
        self.assertEqual(len((self.dir / "e.csv").read_text().splitlines()), count + 1)
        first = (self.dir / "e.csv").read_text().splitlines()[1].split(",")
        self.assertIn(f"the first: edge {first[2]}-{first[3]} of triangle {first[1]},",
                      rows["closed by position"])

    def widths(self, vertices, triangles):
        mesh = self.write_ply("m.ply", vertices, triangles, "double")
        rows = self.info(mesh, "--open-edges", "e.csv")[0]
        with open(self.dir / "e.csv", newline="", encoding="ascii") as file:
            return [float(e["width"]) for e in csv.DictReader(file)], rows["cracks"]

    def test_widths_are_those_of_cracks_and_holes(self):
        # Two strips of squares along x, from 0 to 4, 2 wide, and a crack of 1/8 between them.
        def strip(y, first):
            vertices = [(x, y + dy, 0) for x in range(5) for dy in (0, 2)]
            corners = [(2 * x, 2 * x + 2, 2 * x + 3) for x in range(4)]
            corners += [(2 * x, 2 * x + 3, 2 * x + 1) for x in range(4)]
            return vertices, [tuple(v + first for v in t) for t in corners]
        (low, one), (high, two) = strip(0, 0), strip(2.125, 10)
        widths, text = self.widths(low + high, one + two)
        self.assertEqual(sorted(widths)[:8], [0.125] * 8)
        self.assertTrue(text.startswith("0.125 to 1.5 wide"), text)
        # The upper one moved down: they share vertices, and then lie on each other's edges.
        widths, text = self.widths(low + [(x / 2, y - 0.125, z) for x, y, z in high], one + two)
        self.assertEqual(widths.count(0), 6)
        self.assertIn(" 6 of them 0;", text)
        # A square hole, 1 wide, in a wall 3 wide: across, and to the outer border.
        outer = [(0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 3, 0)]
        inner = [(1, 1, 0), (2, 1, 0), (2, 2, 0), (1, 2, 0)]
        ring = [t for i in range(4) for t in ((i, (i + 1) % 4, 4 + i),
                                              (4 + i, (i + 1) % 4, 4 + (i + 1) % 4))]
        widths, _ = self.widths(outer + inner, ring)
        self.assertEqual(sorted(widths), [1] * 8)
        # The three edges of a triangle alone: to the foot on the next side.
        widths, _ = self.widths([(0, 0, 0), (2, 0, 0), (1, 3**0.5, 0)], [(0, 1, 2)])
        np.testing.assert_allclose(widths, [0.75**0.5] * 3, rtol=1e-14)

    def test_widths_against_all_pairs(self):
        rng = np.random.default_rng(8)
        vertices = rng.uniform(-1, 1, (300, 3))
        triangles = np.arange(300).reshape(100, 3).tolist()
        triangles += [(t[0], t[1], u[2]) for t, u in zip(triangles[:20], triangles[20:])]
        widths, _ = self.widths(vertices, triangles)
        with open(self.dir / "e.csv", newline="", encoding="ascii") as file:
            ends = np.array([[[float(e[k + axis]) for axis in "xyz"] for k in ("from_", "to_")]
                             for e in csv.DictReader(file)])
        a, d = ends[:, 0], ends[:, 1] - ends[:, 0]
        for edge, width in zip(ends, widths):
            t = np.clip(((edge.mean(0) - a) * d).sum(1) / (d * d).sum(1), 0, 1)
            foot = a + t[:, None] * d
            distance = np.linalg.norm(edge.mean(0) - foot, axis=1)
            for k in (0, 1):  # not where they meet
                distance[(foot == edge[k]).all(1)] = np.inf
            distance[((ends == edge).all(2)).all(1)] = np.inf
            self.assertAlmostEqual(width, distance.min(), delta=1e-12)

    def test_unused_vertices_may_be_anything(self):
        nan = float("nan")
        vertices = [(nan, 0, 0), *TETRA_VERTICES, (0, nan, 1), (0, 1, float("inf"))] * 3
        triangles = [tuple(v + 1 for v in t) for t in TETRA_TRIANGLES[1:]]
        mesh = self.write_ply("m.ply", vertices, triangles)
        self.assertIn("e.csv: 3 edges", self.info(mesh, "--open-edges", "e.csv")[0]["wrote"])

    def test_closed_mesh_has_none(self):
        rows = self.info(self.tetra(), "--open-edges", "e.csv")[0]
        self.assertEqual(rows["wrote"], "e.csv: 0 edges not used as often one way as the other")
        self.assertEqual(len((self.dir / "e.csv").read_text().splitlines()), 1)

    def test_other_files_are_refused(self):
        mesh = self.tetra()
        self.assertIn("must end in .csv or .ply",
                      self.fail_with(2, "info", mesh, "--open-edges", "e.npy"))
        self.assertIn("is an input file", self.fail_with(2, "info", mesh, "--open-edges", mesh))


if __name__ == "__main__":
    unittest.main()
