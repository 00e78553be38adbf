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
