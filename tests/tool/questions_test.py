# SPDX-License-Identifier: Apache-2.0
"""Questions on the command line, answered in words; and --json of every command that has it."""

import json
import os
import unittest

import numpy as np

from harness import NONE, TETRA_TRIANGLES, TETRA_VERTICES, ToolTest


class Words(ToolTest):
    def ask(self, *args, mesh=None, command="cast"):
        done = self.succeed(command, mesh or self.tetra(), *args)
        self.assertEqual(done.stderr, "")
        return done.stdout.splitlines()

    def rays(self, *texts):
        return [word for text in texts for word in ("--ray", text)]

    # Through a face and out of another, into an edge, a vertex, and past everything.
    RAYS = (".25,.25,-1,0,0,1", "0.25 0.25 -0.25  0 0.25 0.25", "-1,-1 ,-1, 1,1,1", "5,5,5,1,0,0")

    def test_the_closest_hit_names_triangle_part_and_side(self):
        self.assertEqual(self.ask("--ray", ".25,.25,-1,0,0,1"), [
            "hits triangle 0 of geometry 0, front, at t = 1: u = 0.25, v = 0.25, w = 0.5"])
        self.assertEqual(self.ask(*self.rays(*self.RAYS)), [
            "ray 0: hits triangle 0 of geometry 0, front, at t = 1: u = 0.25, v = 0.25, w = 0.5",
            "ray 1: hits triangle 0 of geometry 0, front, at t = 1: u = 0.5, v = 0.25, w = 0.25",
            "ray 2: hits vertex a of triangle 0 of geometry 0, front, at t = 1: u = 0, v = 0, "
            "w = 1",
            "ray 3: misses"])
        self.assertEqual(self.ask("--ray", "0.5,0.5,-2,0,0,1"), [
            "hits edge bc of triangle 0 of geometry 0, front, at t = 2: u = 0.5, v = 0.5, w = 0"])
        self.assertEqual(self.ask("--ray=-1,0,0.25,2,0,0"), [
            "hits edge bc of triangle 3 of geometry 0, front, at t = 0.5: u = 0.75, v = 0.25, "
            "w = 0"])

    def test_every_edge_and_vertex_has_its_name(self):
        mesh = self.write_ply("one.ply", [(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(0, 1, 2)])
        for x, y, part in ((0, 0, "vertex a of "), (4, 0, "vertex b of "), (0, 4, "vertex c of "),
                           (1, 0, "edge ab of "), (2, 2, "edge bc of "), (0, 3, "edge ca of "),
                           (1, 1, "")):
            line, = self.ask("--ray", f"{x},{y},1,0,0,-1", mesh=mesh)
            self.assertTrue(line.startswith(f"hits {part}triangle 0 of geometry 0, front, at t = 1"
                                            ": "), line)

    def test_a_weight_that_is_rounded_to_zero_is_no_edge(self):
        mesh = self.write_ply("wide.ply", [(0, 0, 0), (2**60, 0, 0), (0, 2**60, 0)], [(0, 1, 2)])
        line, = self.ask("--ray", f"{2.0**-140!r},1,1,0,0,-1", mesh=mesh)
        self.assertIn("hits triangle 0 of geometry 0, front, at t = 1: u = 0, v = 8.67", line)
        line, = self.ask("--ray", "0,1,1,0,0,-1", mesh=mesh)
        self.assertIn("hits edge ca of triangle 0 of geometry 0, front, at t = 1: u = 0, v =", line)

    def test_all_other_queries(self):
        rays = self.rays(*self.RAYS)
        self.assertEqual(self.ask(*rays, "--query", "any"),
                         ["ray 0: hits", "ray 1: hits", "ray 2: hits", "ray 3: misses"])
        self.assertEqual(self.ask(*rays, "--query", "count"),
                         ["ray 0: 2 hits", "ray 1: 2 hits", "ray 2: 4 hits", "ray 3: 0 hits"])
        more = self.rays(*self.RAYS[::3], "0.25,0.25,0.25,0,0,1", "0,0,0,1,1,1")
        self.assertEqual(self.ask(*more, "--query", "crossings"),
                         ["ray 0: 2 passages, signed count 0", "ray 1: 0 passages, signed count 0",
                          "ray 2: 1 passage, signed count 1",
                          "ray 3: 1 passage, signed count 1; the origin is on the surface"])
        self.assertEqual(self.ask(*self.rays(*self.RAYS[::3]), "--query", "all"), [
            "ray 0: hits triangle 0 of geometry 0, front, at t = 1: u = 0.25, v = 0.25, w = 0.5",
            "ray 0: hits triangle 2 of geometry 0, back, at t = 1.5: u = 0.25, v = 0.5, w = 0.25",
            "ray 1: misses"])
        self.assertEqual(self.ask("--ray", self.RAYS[0], "--query", "all", "--max-hits", "1"),
                         self.ask("--ray", self.RAYS[0]))

    def test_ranges_sides_and_precision_work_as_for_files(self):
        self.assertEqual(self.ask("--ray", ".25,.25,-1,0,0,1,-inf,0.5"), ["misses"])
        self.assertIn("triangle 2", self.ask("--ray", ".25 .25 -1 0 0 1", "--sides", "back")[0])
        self.assertIn("triangle 2", self.ask("--ray", ".25,.25,-1,0,0,1,1,9", "--range",
                                             "open-start")[0])
        # 0.1 is no float: the scene is double then, unless it is told otherwise.
        self.assertIn("u = 0.1, v = 0.25, w = 0.65", self.ask("--ray", ".25,.1,-1,0,0,1")[0])
        done = self.succeed("cast", self.tetra(), "--ray", ".25,.1,-1,0,0,1", "--precision",
                            "float")
        self.assertEqual(done.stderr, "pierce: --precision float: the numbers of --ray are rounded "
                                      "to 32 bits\n")

    def test_questions_can_have_answers_in_a_file(self):
        self.succeed("cast", self.tetra(), *self.rays(*self.RAYS), "--out", "h.npy")
        self.assertEqual(self.load("h.npy")["triangle"].tolist(), [0, 0, 0, NONE])
        self.succeed("locate", self.tetra(), "--point", "1,1,1", "--out", "l.csv")
        self.assertEqual((self.dir / "l.csv").read_text(), "location\n-1\n")

    def test_points(self):
        points = ("--point", "0.25,0.25,0.25", "--point", "0.25 0.25 0", "--point", "-1,-.5,0")
        self.assertEqual(self.ask(*points, command="locate"),
                         ["point 0: inside", "point 1: on the surface", "point 2: outside"])
        self.assertEqual(self.ask(*points[:2], command="locate"), ["inside"])
        self.assertEqual(self.ask("--point", "0.25,0.125,-2", "--point", "3,0,0",
                                  "--point", "0.5,-3,-4", command="nearest"), [
            "point 0: nearest is 0.25,0.125,0 on triangle 0 of geometry 0 at distance 2: "
            "u = 0.125, v = 0.25, w = 0.625",
            "point 1: nearest is 1,0,0 on vertex c of triangle 0 of geometry 0 at distance 2: "
            "u = 0, v = 1, w = 0",
            "point 2: nearest is 0.5,0,0 on edge ca of triangle 0 of geometry 0 at distance 5: "
            "u = 0, v = 0.5, w = 0.5"])
        self.assertEqual(self.ask("--point", "3,0,0", "--radius", "1.5", command="nearest"),
                         ["no surface within the radius"])
        self.assertIn("at distance -0.0625: ", self.ask("--point", ".375,.0625,.25", "--signed",
                                                        command="nearest")[0])

    def test_mistakes_are_one_line(self):
        mesh = self.tetra()
        for args, status, line in (
                (("cast", "--ray", "1,2,3"), 2, "cast: --ray: '1,2,3' has 3 numbers; give 6 or 8: "
                                                "ox,oy,oz,dx,dy,dz[,t_min,t_max]"),
                (("cast", "--ray", "1,2,3,4,5,six"), 2, "cast: --ray: 'six' is not a number"),
                (("cast", "--ray", "1,2,,4,5,6"), 2, "cast: --ray: '' is not a number"),
                (("cast", "--ray", "0,0,0,1,0,0", "--ray", "1,2,3,0,0,0"), 1,
                 "--ray: row 1 (counted from 0): bad ray: its direction is zero; give it a "
                 "component that is not"),
                (("cast",), 2, "cast: give --rays FILE, or --ray ox,oy,oz,dx,dy,dz"),
                (("cast", "--ray", "0,0,0,1,1,1", "--rays", "r.npy"), 2,
                 "cast: --ray: cannot be given together with --rays; choose one"),
                (("locate",), 2, "locate: give --points FILE, or --point x,y,z"),
                (("nearest", "--point", "1,2"), 2, "nearest: --point: '1,2' has 2 numbers; give 3: "
                                                   "x,y,z"),
                (("nearest", "--point", "1,2,nan"), 1,
                 "--point: row 0 (counted from 0): bad point: it is not finite; give finite "
                 "coordinates"),
                (("cast", "--ray", "0,0,1e39,0,0,1", "--precision", "float", "--quiet"), 1, None)):
            done = self.run_tool(args[0], mesh, *args[1:])
            self.assertEqual((done.returncode, done.stdout), (status, ""), done.stderr)
            self.assertIn(line or "--ray: row 0: 1e+39 does not fit the range of float",
                          done.stderr)


class Json(ToolTest):
    def json(self, *args, status=0, **options):
        done = self.run_tool(*args, "--json", **options)
        self.assertEqual(done.returncode, status, done.stderr)
        self.assertEqual(done.stderr, "")

        def refuse(text):
            raise AssertionError(f"{text} is no JSON")
        return json.loads(done.stdout, parse_constant=refuse)

    def test_cast(self):
        rays = self.write_rays("r.npy", [(0.25, 0.25, -1, 0, 0, 1), (5, 5, 5, 1, 0, 0)])
        got = self.json("cast", self.tetra(), "--rays", rays, "--out", "h.npy")
        self.assertEqual(list(got),
                         ["command", "mesh", "meshes", "geometries", "triangles", "precision",
                          "build_seconds", "query", "rays", "hits", "seconds", "decisions",
                          "decisions_exact", "roundings", "roundings_exact", "out"])
        self.assertEqual([got[k] for k in ("command", "mesh", "geometries", "triangles",
                                           "precision", "query", "rays", "hits", "out")],
                         ["cast", "tetra-float.ply", 1, 4, "float", "closest", 2, 1, "h.npy"])
        self.assertEqual(got["roundings"], 1)
        self.assertEqual(len(self.load("h.npy")), 2)
        got = self.json("cast", self.tetra(), "--rays", rays, "--out", "h.npy", "--query",
                        "crossings", "--quiet")
        self.assertEqual(got["passages"], 2)

    def test_answers_of_questions(self):
        rays = ("--ray", "0.5,0.5,-2,0,0,1", "--ray", "5,5,5,1,0,0")
        got = self.json("cast", self.tetra(), *rays)
        edge = {"hit": True, "t": 2, "u": 0.5, "v": 0.5, "w": 0, "geometry": 0, "triangle": 0,
                "facing": "front", "feature": "edge bc"}
        self.assertEqual(got["answers"], [edge, {"hit": False}])
        lists = self.json("cast", self.tetra(), *rays, "--query", "all")["answers"]
        self.assertEqual([len(one["hits"]) for one in lists], [2, 0])
        self.assertEqual(lists[0]["hits"][0], edge)
        self.assertEqual(self.json("cast", self.tetra(), *rays, "--query", "any")["answers"],
                         [{"hit": True}, {"hit": False}])
        self.assertEqual(self.json("cast", self.tetra(), *rays, "--query", "count")["answers"],
                         [{"count": 2}, {"count": 0}])
        got = self.json("cast", self.tetra(), "--ray", "0,0,0,1,1,1", "--query", "crossings")
        self.assertEqual(got["answers"],
                         [{"count": 1, "signed_count": 1, "origin_on_surface": True}])
        got = self.json("locate", self.tetra(), "--point", "0,0,0", "--point", "9,9,9")
        self.assertEqual(got["answers"], [{"location": "on the surface"}, {"location": "outside"}])
        got = self.json("nearest", self.tetra(), "--point", "3,0,0", "--point", "9,9,9", "--radius",
                        "4")
        self.assertEqual(got["answers"], [
            {"found": True, "point": [1, 0, 0], "distance": 2, "u": 0, "v": 1, "w": 0,
             "geometry": 0, "triangle": 0, "feature": "vertex c"}, {"found": False}])

    def test_locate_nearest_and_voxelise(self):
        points = self.points([(0.25, 0.25, 0.25), (0, 0, 0), (9, 9, 9)])
        got = self.json("locate", self.tetra(), "--points", points, "--out", "l.npy")
        self.assertEqual([got[k] for k in ("points", "inside", "on_surface", "outside", "out")],
                         [3, 1, 1, 1, "l.npy"])
        got = self.json("nearest", self.tetra(), "--points", points, "--out", "n.npz", "--radius",
                        "1", "--signed")
        self.assertEqual([got[k] for k in ("points", "found", "inside", "out")], [3, 2, 1, "n.npz"])
        got = self.json("voxelise", self.tetra(), "--size", "4x5x6", "--out", "g.npy")
        self.assertEqual(got["size"], [4, 5, 6])
        self.assertEqual(got["cells"], 120)
        self.assertEqual(got["inside"], int(np.sum(self.load("g.npy") == 1)))
        self.assertEqual(len(got["origin"] + got["spacing"]), 6)

    def test_info(self):
        mesh = self.write_ply("open.ply", TETRA_VERTICES + [(7, 7, 7)], TETRA_TRIANGLES[:3])
        got = self.json("info", mesh)
        self.assertEqual([got[k] for k in ("command", "mesh", "coordinate_bits", "attributes",
                                           "vertices", "unused_vertices", "triangles", "bounds",
                                           "duplicates", "without_area")],
                         ["info", "open.ply", 32, [], 5, 1, 3, [[0, 0, 0], [1, 1, 1]], 0, 0])
        self.assertEqual(got["closed_by_index"],
                         {"closed": False, "balanced": False, "watertight": False, "edges": 6,
                          "open_edges": 3, "unbalanced_edges": 3, "crowded_edges": 0,
                          "in_pieces": 0})
        self.assertGreater(got["tree_bytes"], 0)
        self.assertNotIn("open_edges", got)
        got = self.json("info", mesh, "--open-edges", "e.csv")
        self.assertEqual(got["open_edges"], {"edges": 3, "out": "e.csv", "zero_width": 0,
                                             **{key: got["open_edges"][key] for key in
                                                ("narrowest", "median_width", "widest")}})
        self.assertEqual(len((self.dir / "e.csv").read_text().splitlines()), 4)

    def test_all_meshes_are_named(self):
        flat = self.write_ply("flat.ply", TETRA_VERTICES, [*TETRA_TRIANGLES, (0, 1, 1), (2, 2, 2)])
        meshes = [self.tetra(), flat, self.tetra()]
        got = self.json("locate", *meshes, "--point", "9,9,9")
        self.assertEqual((got["meshes"], got["geometries"]), (meshes, 3))
        got = self.json("info", *meshes)
        self.assertEqual((got["meshes"], got["without_area"]), (meshes, 2))
        self.assertEqual([(one["name"], one["without_area"]) for one in got["geometries"]],
                         [(name, 2 if name == flat else 0) for name in meshes])
        self.assertEqual(self.json("info", flat)["meshes"], [flat])

    def test_check(self):
        mesh = self.tetra()
        got = self.json("check", mesh, "--rays", "50")
        self.assertEqual([got[k] for k in ("command", "rays", "differences")], ["check", 100, 0])
        self.assertEqual([(one["mesh"], one["precision"], one["triangles"], one["differences"])
                          for one in got["scenes"]],
                         [(mesh, "float", 4, 0), (mesh, "double", 4, 0)])

    def test_any_name_of_a_file_is_valid_json(self):
        for name, expected in (('a"b\\c\n\t.ply', 'a"b\\c\n\t.ply'), ("\u00e4\u20ac.ply",) * 2,
                               (os.fsdecode(b"\xff\xc3.ply"), "\ufffd\ufffd.ply")):
            (self.dir / self.tetra()).rename(self.dir / name)
            self.assertEqual(self.json("info", name)["mesh"], expected)


if __name__ == "__main__":
    unittest.main()
