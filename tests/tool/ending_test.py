# SPDX-License-Identifier: Apache-2.0
"""How the program ends: done, stopped, stopped in a hurry, its readers gone, its disk full."""

import os
import pty
import resource
import signal
import subprocess
import unittest

import numpy as np

from harness import PATIENCE, ToolTest


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

    def test_interrupt_stops_promptly_and_leaves_nothing(self):
        for sent, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            args = self.slow_cast()
            before = self.files()
            process = self.start(*args, stderr=subprocess.PIPE, text=True)
            self.wait_for_output(before)
            self.assertFalse((self.dir / "h.npy").exists())
            message, seconds = self.interrupt(process, sent)
            self.assertLess(seconds, 10)  # of the processor: the clock depends on the neighbours
            self.assertEqual(process.returncode, status)
            self.assertEqual(message, "pierce: stopped\n")
            self.assertEqual(self.files(), before)

    def needs_bench(self):
        if "\n  bench " not in self.succeed("--help").stdout:
            self.skipTest("built without the benchmark")

    def test_second_interrupt_ends_at_once_and_leaves_nothing(self):
        args = self.slow_cast()
        before = self.files()
        for _ in range(2):
            process = self.start(*args, stderr=subprocess.DEVNULL)
            self.wait_for_output(before)
            process.send_signal(signal.SIGINT)
            process.send_signal(signal.SIGTERM)
            self.assertIn(process.wait(timeout=PATIENCE), (130, 143))
            self.assertEqual(self.files(), before)

    def test_reader_that_leaves_a_long_benchmark_leaves_no_file(self):
        self.needs_bench()
        mesh = self.tetra()
        reader, writer = os.pipe()
        os.close(reader)
        process = self.start("bench", mesh, "--json", "b.json", "--side", "16", "--rounds", "1",
                             stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, message), (128 + signal.SIGPIPE, b""))
        self.assertEqual(self.files(), [mesh])

    def test_benchmark_does_not_replace_its_mesh(self):
        self.needs_bench()
        mesh = self.tetra()
        before = (self.dir / mesh).read_bytes()
        message = self.fail_with(2, "bench", mesh, "--json", mesh)
        self.assertEqual(message, f"bench: --json: '{mesh}' is an input file; choose another name")
        self.assertEqual((self.dir / mesh).read_bytes(), before)

    def test_benchmark_without_standard_output_does_not_print_into_its_file(self):
        self.needs_bench()
        mesh = self.tetra()
        process = self.start("bench", mesh, "--json", "b.json", "--side", "16", "--rounds", "1",
                             stderr=subprocess.PIPE, text=True, preexec_fn=lambda: os.close(1))
        _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual((process.returncode, message),
                         (1, "pierce: standard output: Bad file descriptor\n"))
        self.assertEqual(self.files(), [mesh])

    def test_file_size_limit_is_an_error_and_leaves_nothing(self):
        mesh, rays = self.tetra(), self.write_rays("r.npy", np.ones((20000, 6)))
        before = self.files()
        message = self.fail_with(
            1, "cast", mesh, "--rays", rays, "--out", "h.npy", "--quiet",
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000)))
        self.assertEqual(message, "h.npy: cannot be written: File too large: free some space or "
                                  "write elsewhere")
        self.assertEqual(self.files(), before)

    def test_closed_streams_do_not_lead_into_the_output(self):
        mesh, rays = self.tetra(), self.write_rays("r.npy", np.ones((9, 6)))
        command = ["cast", mesh, "--rays", rays, "--out"]
        self.succeed(*command, "h.npy")
        process = self.start(*command, "closed.npy", preexec_fn=lambda: os.closerange(0, 3))
        self.assertEqual(process.wait(timeout=PATIENCE), 0)
        self.assertEqual((self.dir / "closed.npy").read_bytes(),
                         (self.dir / "h.npy").read_bytes())

    def test_progress_is_shown_on_a_terminal_and_erased(self):
        main, side = pty.openpty()
        process = self.start(*self.slow_cast(), stderr=side)
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
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.assertIn(b"\r\x1b[K", shown)

    def test_closed_pipe_ends_quietly(self):
        reader, writer = os.pipe()
        os.close(reader)
        process = self.start("info", self.tetra(), stdout=writer, stderr=subprocess.PIPE)
        os.close(writer)
        _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual(message, b"")
        self.assertEqual(process.returncode, 128 + signal.SIGPIPE)

    def test_full_disk_on_stdout_is_an_error(self):
        with open("/dev/full", "wb") as full:
            process = self.start("info", self.tetra(), stdout=full, stderr=subprocess.PIPE,
                                 text=True)
            _, message = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 1)
        self.assertEqual(message, "pierce: standard output: No space left on device\n")


if __name__ == "__main__":
    unittest.main()
