# SPDX-License-Identifier: Apache-2.0
"""pierce info: the figures of small meshes, and why a mesh is not closed."""

import json
import unittest

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest


class Info(ToolTest):
    def info(self, mesh, *more):
        rows = {}
        for line in self.succeed("info", mesh, *more).stdout.splitlines():
            name, value = line.split("  ", 1)
            rows[name] = value.strip()
        return rows

    def test_closed_mesh(self):
        rows = self.info(self.tetra())
        for name, value in (("file", "tetra-float.ply"), ("coordinates", "32-bit"),
                            ("format", "PLY, binary little endian"), ("attributes", "none"),
                            ("vertices", "4, 0 of them unused"), ("triangles", "4"),
                            ("bounds", "0,0,0 to 1,1,1"), ("duplicates", "0"),
                            ("closed by index", "yes"), ("closed by position", "yes"),
                            ("volume", "0.16666666666666666"), ("components", "1"),
                            ("Euler number", "2"), ("facing", "neighbours face the same way"),
                            ("without area", "0")):
            self.assertEqual(rows[name], value)
        self.assertNotIn("self-intersections", rows)
        for name in ("build", "tree nodes", "tree leaves", "SAH cost", "tree memory"):
            self.assertIn(name, rows)

    def test_declared_types_decide_the_precision(self):
        """The same triangle, whose 0.1 is a float, or not, by what the file says of it."""
        body = "0.1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        for number, coordinates, x in (("float", "32-bit", np.float32(0.1)),
                                       ("double", "64-bit", 0.1)):
            xyz = "".join(f"property {number} {axis}\n" for axis in "xyz")
            self.write("m.ply", f"ply\nformat ascii 1.0\nelement vertex 3\n{xyz}"
                                "element face 1\nproperty list uchar int vertex_indices\n"
                                "end_header\n" + body)
            self.assertEqual(self.info("m.ply")["coordinates"], coordinates)
            rays = self.write_rays("r.npy", [(x, 0, 1, 0, 0, -1)], x.dtype if x != 0.1 else "<f8")
            self.succeed("cast", "m.ply", "--rays", rays, "--out", "h.npy")
            hit = self.load("h.npy")[0]
            self.assertEqual((hit["t"].itemsize, hit["w"], hit["triangle"]),
                             (np.dtype(type(x)).itemsize, 1, 0))
            # Doubles computed with what was declared a float are that float.
            rays = self.write_rays("r.npy", [(x, 0, 1, 0, 0, -1)], "<f8")
            self.succeed("cast", "m.ply", "--rays", rays, "--out", "h.npy", "--precision",
                         "double")
            self.assertEqual(self.load("h.npy")[0]["w"], 1)

    def test_text_mesh_holds_doubles(self):
        obj = self.write_obj("t.obj", TETRA_VERTICES, TETRA_TRIANGLES)
        self.assertEqual(self.info(obj)["coordinates"], "64-bit")

    def test_hole_is_named(self):
        rows = self.info(self.write_ply("m.ply", TETRA_VERTICES, TETRA_TRIANGLES[:3]))
        self.assertEqual(rows["closed by index"],
                         "no: 3 of 6 edges open, 0 more not used once each way; the first: edge "
                         "0-2 of triangle 0, (0, 0, 0) to (0, 1, 0), belongs to no other triangle")

    def test_reversed_triangle_is_named(self):
        triangles = [*TETRA_TRIANGLES[:3], TETRA_TRIANGLES[3][::-1]]
        rows = self.info(self.write_ply("m.ply", TETRA_VERTICES, triangles))
        self.assertEqual(rows["closed by index"],
                         "no: 0 of 6 edges open, 3 more not used once each way; the first: edge "
                         "0-2 of triangle 0, (0, 0, 0) to (0, 1, 0), runs the same way in "
                         "triangle 3")

    def test_measures(self):
        triangles = [*TETRA_TRIANGLES[:3], TETRA_TRIANGLES[3][::-1]]
        rows = self.info(self.write_ply("m.ply", TETRA_VERTICES, triangles),
                         "--self-intersections")
        self.assertEqual(rows["facing"],
                         "some neighbours face opposite ways; all could agree")
        self.assertEqual(rows["self-intersections"], "none")
        # Two triangles through each other, and one more at their corners.
        vertices = [(0, 0, 0), (4, 0, 0), (0, 4, 0), (1, 1, -1), (1, 1, 1), (9, 9, 0), (9, 0, 0)]
        mesh = self.write_ply("m.ply", vertices, [(0, 1, 2), (3, 4, 5), (5, 6, 1)])
        rows = self.info(mesh, "--self-intersections")
        self.assertEqual(rows["self-intersections"],
                         "1 pair of triangles; the first: triangle 0 and triangle 1")
        self.assertEqual((rows["components"], rows["Euler number"]), ("1", "1"))
        found = json.loads(self.succeed("info", mesh, "--self-intersections", "--json").stdout)
        self.assertEqual([found[x] for x in ("self_intersections", "components", "euler",
                                             "consistent", "orientable")], [1, 1, 1, True, True])
        self.assertGreater(found["area"], 8)

    def test_plurals(self):
        # The edge 0-2 of a tetrahedron, also of three fins: used twice, and three times the other.
        fins = [(0, 2, 4), (0, 2, 5), (4, 2, 0)]
        vertices = [*TETRA_VERTICES, (9, 0, 0), (0, 0, -9)]
        rows = self.info(self.write_ply("m.ply", vertices, [*TETRA_TRIANGLES, *fins]))
        self.assertIn("edge 0-2 of triangle 0, (0, 0, 0) to (0, 1, 0), is used 3 times that way, "
                      "2 times the other", rows["closed by index"])
        rows = self.info(self.write_ply("m.ply", vertices, [*TETRA_TRIANGLES, fins[0]]))
        self.assertIn("is used 2 times that way, once the other", rows["closed by index"])
        for name, text in (("p.ply", "1 vertex"), ("q.ply", "2 vertices")):
            mesh = self.write_ply(name, TETRA_VERTICES[:int(text[0])], [])
            self.assertIn(f"holds no triangle ({text});", self.fail_with(1, "info", mesh))

    def test_unshared_corners_are_closed_by_position_only(self):
        vertices = [TETRA_VERTICES[v] for t in TETRA_TRIANGLES for v in t]
        rows = self.info(self.write_ply("m.ply", vertices, [(i, i + 1, i + 2)
                                                            for i in range(0, 12, 3)]))
        self.assertTrue(rows["closed by index"].startswith("no: 12 of 12 edges open"))
        self.assertEqual(rows["closed by position"], "yes")

    def test_surfaces_that_touch_in_an_edge_are_told(self):
        turned = [(-x, -y, z) for x, y, z in TETRA_VERTICES]
        triangles = TETRA_TRIANGLES + [tuple(v + 4 for v in t) for t in TETRA_TRIANGLES]
        rows = self.info(self.write_ply("m.ply", TETRA_VERTICES + turned, triangles))
        self.assertEqual(rows["closed by index"], "yes")
        self.assertIn("yes, but surfaces meet in 1 of 11 edges", rows["closed by position"])

    def test_t_junctions_are_told_from_gaps(self):
        triangles = [(0, 2, 4), (4, 2, 1), *TETRA_TRIANGLES[1:]]
        rows = self.info(self.write_ply("m.ply", [*TETRA_VERTICES, (0.5, 0, 0)], triangles))
        self.assertTrue(rows["closed by index"].startswith("no: 3 of 9 edges open"))
        self.assertEqual(rows["closed by position"],
                         "yes, with T-junctions: 3 of 9 edges pair piece by piece; the first: edge "
                         "4-0 of triangle 0, (0.5, 0, 0) to (0, 0, 0), belongs to no other "
                         "triangle")

    def test_triangles_back_to_back_are_told(self):
        turned = [t[::-1] for t in TETRA_TRIANGLES[:3]]
        rows = self.info(self.write_ply("m.ply", TETRA_VERTICES, [*TETRA_TRIANGLES, *turned]))
        self.assertEqual(rows["duplicates"], "3; 6 triangles lie back to back and cancel: what is "
                                             "inside may be found with --rule unique")

    def test_degenerate_duplicate_and_unused_are_counted(self):
        triangles = [*TETRA_TRIANGLES, (0, 1, 1), (1, 3, 0), (4, 4, 4)]
        vertices = [*TETRA_VERTICES, (0.5, 0.5, 0.5), (9, 9, 9)]
        rows = self.info(self.write_ply("m.ply", vertices, triangles))
        self.assertEqual(rows["without area"], "2")
        self.assertEqual(rows["duplicates"], "1")
        self.assertEqual(rows["vertices"], "6, 1 of them unused")
        self.assertEqual(rows["bounds"], "0,0,0 to 1,1,1")

    def test_attributes_are_listed(self):
        mesh = self.write_ply("m.ply", TETRA_VERTICES, TETRA_TRIANGLES, extra={
            "nx": ("float", 0), "ny": ("float", 0), "nz": ("float", 1), "red": ("uchar", 1),
            "green": ("uchar", 1), "blue": ("uchar", 1)})
        self.assertEqual(self.info(mesh)["attributes"], "normals, colours")

    def test_bad_meshes_are_errors(self):
        self.assertIn("no.ply", self.fail_with(1, "info", "no.ply"))
        message = self.fail_with(1, "info", self.write_ply("m.ply", TETRA_VERTICES, [(0, 1, 7)]))
        self.assertTrue(message.startswith("m.ply: "), message)
        message = self.fail_with(1, "info", self.write_ply(
            "inf.ply", [(0, 0, 0), (1, 0, 0), (0, float("inf"), 0)], [(0, 1, 2)]))
        self.assertTrue(message.startswith("inf.ply: "), message)


if __name__ == "__main__":
    unittest.main()
