# SPDX-License-Identifier: Apache-2.0
"""The command line itself: help, versions, mistakes, and how the program ends."""

import os
import pty
import signal
import subprocess
import time
import unittest
from pathlib import Path

import numpy as np

from harness import TOOL, ToolTest

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


class Ending(ToolTest):
    def slow_cast(self):
        """Arguments of a cast that would take minutes: many rays through very many triangles."""
        corners = [(-1, -1, 0), (1, -1, 0), (0, 1, 0)]
        mesh = self.write_ply("copies.ply", corners, [(0, 1, 2)] * 2000)
        rng = np.random.default_rng(1)
        rays = rng.uniform(-0.2, 0.2, (200000, 6))
        rays[:, 5] = 1
        rays[:, 2] = -1
        return ("cast", mesh, "--rays", self.write_rays("r.npy", rays), "--query", "all", "--out",
                "h.npy")

    def start(self, *args, **options):
        return subprocess.Popen([TOOL, *args], cwd=self.dir, stdin=subprocess.DEVNULL, **options)

    def test_interrupt_stops_promptly_and_leaves_nothing(self):
        for sent, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            args = self.slow_cast()
            before = self.files()
            process = self.start(*args, stderr=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            deadline = time.monotonic() + 60
            while self.files() == before and time.monotonic() < deadline:
                time.sleep(0.02)  # until the output is begun, under another name
            self.assertNotEqual(self.files(), before)
            self.assertFalse((self.dir / "h.npy").exists())
            begin = time.monotonic()
            process.send_signal(sent)
            _, message = process.communicate(timeout=60)
            self.assertLess(time.monotonic() - begin, 10)
            self.assertEqual(process.returncode, status)
            self.assertEqual(message, "pierce: stopped\n")
            self.assertEqual(self.files(), before)

    def test_progress_is_shown_on_a_terminal_and_erased(self):
        main, side = pty.openpty()
        process = self.start(*self.slow_cast(), stderr=side)
        self.addCleanup(process.kill)
        os.close(side)
        shown = b""
        while b"cast [" not in shown:
            shown += os.read(main, 4096)
        process.send_signal(signal.SIGINT)
        try:
            while chunk := os.read(main, 4096):
                shown += chunk
        except OSError:
            pass  # Linux: the other side is closed
        os.close(main)
        self.assertEqual(process.wait(timeout=60), 130)
        self.assertIn(b"\r\x1b[K", shown)

    def test_closed_pipe_ends_quietly(self):
        reader, writer = os.pipe()
        os.close(reader)
        process = self.start("info", self.tetra(), stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        _, message = process.communicate(timeout=60)
        self.assertEqual(message, b"")
        self.assertEqual(process.returncode, 128 + signal.SIGPIPE)

    def test_full_disk_on_stdout_is_an_error(self):
        with open("/dev/full", "wb") as full:
            process = self.start("info", self.tetra(), stdout=full, stderr=subprocess.PIPE,
                                 text=True)
            _, message = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertEqual(message, "pierce: standard output: No space left on device\n")


if __name__ == "__main__":
    unittest.main()
