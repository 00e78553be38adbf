# SPDX-License-Identifier: Apache-2.0
"""The command line itself: help, versions and mistakes."""

import os
import unittest
from pathlib import Path

import numpy as np

from harness import ToolTest

COMMANDS = ["cast", "locate", "voxelise", "nearest", "render", "rays", "triangle", "textbook",
            "info", "check"]
SOURCE = Path(__file__).resolve().parents[2]


class Help(ToolTest):
    def test_version_is_that_of_the_tree(self):
        version = (SOURCE / "VERSION").read_text().strip()
        self.assertEqual(self.succeed("--version").stdout, f"pierce {version}\n")

    def test_help_names_every_command(self):
        text = self.succeed("--help").stdout
        for command in COMMANDS:
            self.assertIn(f"\n  {command} ", text)

    def test_help_of_every_command_has_an_example(self):
        for command in COMMANDS:
            text = self.succeed(command, "--help").stdout
            self.assertIn("Examples:\n  pierce " + command, text)
            self.assertTrue(text.isascii())

    def test_no_command_prints_the_help_and_is_bad_usage(self):
        done = self.run_tool()
        self.assertEqual(done.returncode, 2)
        self.assertIn("render", done.stdout)


class Mistakes(ToolTest):
    def test_unknown_command_suggests_the_nearest(self):
        self.assertEqual(self.fail_with(2, "rendr", "x"),
                         "'rendr' is not a command; did you mean 'render'?")
        self.assertEqual(self.fail_with(2, "tirangle"),
                         "'tirangle' is not a command; did you mean 'triangle'?")
        self.assertEqual(self.fail_with(2, "xyzzy"),
                         "'xyzzy' is not a command; try 'pierce --help'")

    def test_unknown_option_suggests_the_nearest(self):
        message = self.fail_with(2, "cast", "m.ply", "--rays", "r", "--out", "h", "--querry=any")
        self.assertEqual(message, "cast: '--querry' was not expected; did you mean '--query'?")

    def test_suggestions_are_near_or_none(self):
        tail = ("m.ply", "--rays", "r", "--out", "h")
        for typed, meant in (("--treads", "--threads"), ("--max-hit", "--max-hits"),
                             ("--otu", "--out"), ("--prec", "--precision"),
                             ("--quite", "--quiet"), ("--rnage", "--range"),
                             ("--output", "--out"), ("--output-file", "--out"),
                             ("--Out", "--out"), ("--rays-file", "--rays")):
            self.assertEqual(self.fail_with(2, "cast", *tail, typed),
                             f"cast: '{typed}' was not expected; did you mean '{meant}'?")
        for typed in ("--foo", "--x", "--verbose", "--tree", "-o"):
            self.assertEqual(self.fail_with(2, "cast", *tail, typed),
                             f"cast: '{typed}' was not expected; try 'pierce cast --help'")
        for typed, meant in (("cst", "cast"), ("raycast", None), ("voxelize", "voxelise"),
                             ("foo", None), ("x", None), ("show", None), ("closest", None)):
            cure = f"did you mean '{meant}'?" if meant else "try 'pierce --help'"
            self.assertEqual(self.fail_with(2, typed), f"'{typed}' is not a command; {cure}")

    def test_options_without_the_one_that_they_belong_to(self):
        cast = ("cast", self.tetra(), "--rays", "r.npy", "--out", "h.npy")
        for option, value, needed in (
                ("--size", "8x8", "--camera"), ("--eye", "1,2,3", "--camera"),
                ("--look-at", "1,2,3", "--camera"), ("--up", "0,0,1", "--camera"),
                ("--fov", "40", "--camera"), ("--along", "x", "--grid"),
                ("--at", "1,2,3", "--lidar"), ("--elevations", "0,9", "--lidar"),
                ("--seed", "2", "--sphere")):
            self.assertEqual(self.fail_with(2, *cast, option, value),
                             f"cast: {option} requires {needed}; try 'pierce cast --help'")

    def test_a_wrong_choice_lists_the_right_ones(self):
        tetra = self.tetra()
        cast = ("cast", tetra, "--rays", "r.npy", "--out", "h.npy")
        for args, text in (
                ((*cast, "--query", "ANY"), "--query: 'ANY' is none of closest, any, all, count, "
                 "crossings; did you mean 'any'?"),
                ((*cast, "--query", "nearest"), "--query: 'nearest' is none of closest, any, all, "
                 "count, crossings"),
                ((*cast, "--query", "closets"), "--query: 'closets' is none of closest, any, all, "
                 "count, crossings; did you mean 'closest'?"),
                ((*cast, "--sides", "fornt"), "--sides: 'fornt' is none of both, front, back; did "
                 "you mean 'front'?"),
                ((*cast, "--range", "open"), "--range: 'open' is none of closed, open-start; did "
                 "you mean 'open-start'?"),
                ((*cast, "--precision", "half"), "--precision: 'half' is none of auto, float, "
                 "double"),
                (("locate", tetra, "--points", "p", "--out", "l", "--rule", "even"),
                 "--rule: 'even' is none of odd, nonzero, unique, winding"),
                (("voxelise", tetra, "--size", "4", "--out", "v.npy", "--type", "u8"),
                 "--type: 'u8' is none of int8, bool"),
                (("render", tetra, "--out", "p.png", "--shade", "pretty"), "--shade: 'pretty' is "
                 "none of normal, depth, barycentric, uv, triangle, facing, ao, color, texcoord, "
                 "clay")):
            message = self.fail_with(2, *args)
            self.assertEqual(message, f"{args[0]}: {text}; try 'pierce {args[0]} --help'")

    def test_extensions_are_the_same_in_any_case(self):
        tetra = self.tetra()
        self.write("M.PLY", (self.dir / tetra).read_bytes())
        self.write("M.STL", "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\n"
                            "vertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n")
        for mesh in ("M.PLY", "M.STL"):
            self.succeed("rays", mesh, "--size", "2x2", "--out", "R.NPY")
            self.succeed("render", mesh, "--size", "2x2", "--out", "P.PNG")
            self.succeed("cast", mesh, "--rays", "R.NPY", "--out", "H.NPY")
        self.succeed("voxelise", "M.PLY", "--size", "2", "--out", "V.Npy")
        self.succeed("info", "M.PLY", "--open-edges", "E.CSV")
        self.assertEqual((self.dir / "P.PNG").read_bytes()[1:4], b"PNG")
        self.assertTrue((self.dir / "E.CSV").read_text().startswith("geometry,"))
        self.assertEqual(self.fail_with(2, "render", tetra, "--out", "p.JPG"),
                         "render: --out: 'p.JPG' must end in .png")

    def test_wrong_word_of_a_list_is_answered_with_the_choices(self):
        if self.run_tool("bench", "--list").returncode != 0:
            self.skipTest("this command was built without the benchmark")
        line = self.fail_with(2, "bench", "--suite", "--queries", "any,closets")
        self.assertEqual(line, "bench: --queries: 'closets' is none of closest, any; did you mean "
                               "'closest'?; try 'pierce bench --help'")

    def test_bench_that_was_not_built_says_so(self):
        done = self.run_tool("bench", "--list")
        if done.returncode == 0:
            self.skipTest("this command was built with the benchmark")
        line = self.fail_with(2, "bench", "--list")
        self.assertTrue(line.startswith("bench: this command was built without the benchmark"))
        self.assertIn("-DPIERCE_BUILD_BENCH=ON", line)

    def test_unknown_option_before_any_command_is_named(self):
        self.assertEqual(self.fail_with(2, "--verbose"),
                         "'--verbose' was not expected; try 'pierce --help'")

    def test_missing_option_is_named(self):
        self.assertIn("--out", self.fail_with(2, "cast", "m.ply", "--rays", "r.npy"))
        self.assertIn("MESH", self.fail_with(2, "info"))
        self.assertIn("give a mesh file", self.fail_with(2, "check"))

    def test_bad_values_name_their_option(self):
        tetra = self.tetra()
        cast = ("cast", tetra, "--rays", "r.npy", "--out", "h.npy")
        render = ("render", tetra, "--out", "p.png")
        for args, named in (
                ((*cast, "--query", "nearest"), "--query"),
                ((*cast, "--precision", "half"), "--precision"),
                ((*cast, "--threads", "-1"), "--threads"),
                ((*cast, "--threads", "two"), "--threads"),
                ((*render, "--size", "10"), "--size"), ((*render, "--size", "0x5"), "--size"),
                ((*render, "--size", "10x-5"), "--size"), ((*render, "--size", "x"), "--size"),
                ((*render, "--size", "10x20x30"), "--size"),
                ((*render, "--size", "99999x1"), "--size"),
                ((*render, "--eye", "1,2"), "--eye"), ((*render, "--eye", "1,2,three"), "three"),
                ((*render, "--eye", "1,2,inf"), "--eye"), ((*render, "--eye", "1,,2"), "--eye"),
                ((*render, "--eye", "1,2,3,4"), "--eye"), ((*render, "--eye", "1,2,--3"), "--3"),
                ((*render, "--eye", "1,2,1e999"), "1e999"),
                ((*render, "--up", "0,0,0"), "--up"), ((*render, "--fov", "180"), "--fov"),
                ((*render, "--fov", "0"), "--fov"), ((*render, "--fov", "nan"), "--fov"),
                ((*render, "--fov", "wide"), "--fov"),
                ((*render, "--eye", "0,0,5", "--look-at", "0,0,0", "--up", "0,0,-2"), "--up"),
                ((*render, "--eye", "1,2,3", "--look-at", "1,2,3"), "--eye"),
                ((*render, "--samples", "0"), "--samples"),
                ((*render, "--shade", "pretty"), "--shade"),
                (("render", tetra, "--out", "p.jpg"), "--out"),
                (("check", "--generate", "neddles"), "did you mean 'needles'?"),
                (("triangle", "--triangle", "1,2,3", "--ray", "1,2,3,4,5,6"), "triangle"),
                (("triangle", "--triangle", "0,0,0,1,0,0,0,1,0", "--ray", "1,2,x"), "--ray")):
            message = self.fail_with(2, *args)
            self.assertTrue(message.startswith(args[0] + ": "), message)
            self.assertIn(named, message)
        self.assertEqual(self.files(), [tetra])

    def test_negative_numbers_are_values_not_options(self):
        for eye in ("-1,2,3", "-.5,2,3", "-1e0,-2,-3"):
            self.succeed("rays", self.tetra(), "--out", "r.npy", "--size", "2x2", "--eye", eye)
            expected = [float(x) for x in eye.split(",")]
            self.assertEqual(np.load(self.dir / "r.npy")[0, :3].tolist(), expected)

    def test_unknown_kernel_is_bad_usage(self):
        message = self.fail_with(2, "info", self.tetra(),
                                 env={**os.environ, "PIERCE_KERNEL": "abacus"})
        self.assertIn("abacus", message)


if __name__ == "__main__":
    unittest.main()
