# SPDX-License-Identifier: Apache-2.0
"""pierce check, triangle and textbook from the outside."""

import unittest
import xml.etree.ElementTree

from harness import ToolTest


class Check(ToolTest):
    def test_suite_finds_no_difference(self):
        done = self.succeed("check", "--suite", "--rays", "40", self.tetra())
        lines = done.stdout.splitlines()
        meshes = [line.split()[0] for line in lines[1:-1]]
        self.assertEqual(len(meshes), len(set(meshes)) * 2)  # float and double
        self.assertIn("tetra-float.ply", meshes)
        for line in lines[1:-1]:
            self.assertEqual(line.split()[-1], "0")
        self.assertEqual(lines[-1], f"{grouped(40 * len(meshes))} rays on {len(meshes)} scenes: "
                                    "0 differences")

    def test_hard_rays_hit_edges_and_need_exact_arithmetic(self):
        done = self.succeed("check", "--generate", "voxels", "--rays", "1000")
        for line in done.stdout.splitlines()[1:-1]:
            _, _, _, rays, hits, on_edges, exact, _, wrong = line.split()
            self.assertEqual((rays, wrong), ("1000", "0"))
            self.assertGreater(int(on_edges), 300)
            self.assertGreater(int(exact), 0)
            self.assertGreater(int(hits), 1000)

    def test_precision_chooses_the_scenes(self):
        done = self.succeed("check", "--generate", "one", "--rays", "50", "--precision", "float")
        self.assertIn("on 1 scene:", done.stdout)

    def test_numbers_beyond_float_are_checked_in_double_only(self):
        huge = self.write_ply("huge.ply", [(0, 0, 0), (1e300, 0, 0), (0, 1e300, 0)], [(0, 1, 2)],
                              "double")
        done = self.succeed("check", huge, "--rays", "50")
        self.assertIn("not checked in float: huge.ply: vertex 1", done.stderr)
        self.assertIn("on 1 scene:", done.stdout)

    def test_same_seed_same_rays(self):
        def table(*args):
            lines = self.succeed("check", "--generate", "soup", "--rays", "200", *args).stdout
            return [line.split()[:6] for line in lines.splitlines()]
        self.assertEqual(table(), table("--threads", "1"))
        self.assertNotEqual(table(), table("--seed", "2"))


def grouped(number):
    return f"{number:,}"


class Triangle(ToolTest):
    def test_every_method_is_beside_the_exact_answer(self):
        text = self.succeed("triangle", "--triangle", "0,0,0,1,0,0,0,1,0", "--ray",
                            "0.25,0x1p-2,1,0,0,-1").stdout
        for method in ("cramer", "determinants", "plane_then_edges", "moller_trumbore",
                       "watertight", "baldwin_weber"):
            self.assertIn(method, text)
        self.assertIn("1/4", text)

    def test_range_may_be_infinite(self):
        self.succeed("triangle", "--triangle", "0,0,0,1,0,0,0,1,0", "--ray",
                     "0.25,0.25,1,0,0,-1,-inf,inf")

    def test_fractions_steps_and_a_drawing(self):
        ask = ("triangle", "--triangle", "0,0,0,1,0,0,0,1,0", "--ray", "1/3,-1/4,1,0,0,-2/1")
        text = self.succeed(*ask, "--steps", "moller_trumbore", "--svg", "x.svg").stdout
        self.assertIn("(0.3333333333333333, -0.25, 1) + t (0, 0, -2)", text)
        self.assertIn("in float: miss, since v < 0", text)
        drawn = xml.etree.ElementTree.parse(self.dir / "x.svg").getroot()
        self.assertEqual(drawn.find("{http://www.w3.org/2000/svg}title").text, "miss: v < 0")
        self.assertTrue(self.succeed(*ask, "--svg", "-").stdout.startswith("<svg"))
        self.fail_with(2, *ask, "--steps", "nix")
        for bad in ("1/0", "1/2/3", "/3", "1/", "inf/2"):
            self.fail_with(2, "triangle", "--triangle", "0,0,0,1,0,0,0,1,0", "--ray",
                           f"{bad},0,1,0,0,-1")

    def test_wrong_counts_and_directions_are_refused(self):
        good = "0,0,0,1,0,0,0,1,0"
        for triangle, ray, status in (("0,0,0", "0,0,1,0,0,-1", 2), (good, "0,0,1,0,0", 2),
                                      (good, "0,0,1,0,0,0", 1)):
            self.fail_with(status, "triangle", "--triangle", triangle, "--ray", ray)


class Textbook(ToolTest):
    def test_table_has_every_method(self):
        text = self.succeed("textbook", "--rays", "200").stdout
        for method in ("cramer", "determinants", "plane_then_edges", "plane_then_barycentric",
                       "moller_trumbore", "precomputed_normal", "watertight", "baldwin_weber"):
            self.assertIn(method, text)


if __name__ == "__main__":
    unittest.main()
