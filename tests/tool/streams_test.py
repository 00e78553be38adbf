# SPDX-License-Identifier: Apache-2.0
"""Standard input and output in place of files: pipes, files, nobody who reads."""

import io
import os
import signal
import subprocess
import unittest

import numpy as np

from harness import PATIENCE, TOOL, ToolTest, field_bytes

RAYS = np.float32([(0.25, 0.25, -1, 0, 0, 1), (0, 0, 5, 0, 0, -1), (2, 2, 2, 1, 0, 0)] * 2000)
CSV = "ox,oy,oz,dx,dy,dz\n0.25,0.25,-1,0,0,1\n5,5,5,1,0,0\n"


def npy(array):
    buffer = io.BytesIO()
    np.save(buffer, array)
    return buffer.getvalue()


class Streams(ToolTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.tetra()
        np.save(self.dir / "r.npy", RAYS)
        self.succeed("cast", self.mesh, "--rays", "r.npy", "--out", "h.npy", "--quiet")
        self.expected = self.load("h.npy")

    def piped(self, *args, stdin, status=0):
        """What comes out, as bytes, and what is said on stderr."""
        done = subprocess.run([TOOL, *map(str, args)], cwd=self.dir, input=stdin,
                              capture_output=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stdout, done.stderr.decode()

    def test_npy_through_pipes(self):
        out, said = self.piped("cast", self.mesh, "--rays", "-", "--out", "-", "--format", "npy",
                               stdin=npy(RAYS))
        self.assertEqual(out, (self.dir / "h.npy").read_bytes())
        self.assertRegex(said, r"wrote +standard output\n")
        fortran, _ = self.piped("cast", self.mesh, "--rays", "-", "--out", "-", "--format", "npy",
                                stdin=npy(np.asfortranarray(RAYS)))
        self.assertEqual(fortran, out)
        for query in ("all", "any", "count", "crossings"):
            self.succeed("cast", self.mesh, "--rays", "r.npy", "--out", "q.npy", "--query", query)
            out, _ = self.piped("cast", self.mesh, "--rays", "-", "--out", "-", "--format", "npy",
                                "--query", query, stdin=npy(RAYS))
            self.assertEqual(out, (self.dir / "q.npy").read_bytes())

    def test_csv_is_told_by_content_and_is_what_comes_out_by_default(self):
        out, said = self.piped("cast", self.mesh, "--rays", "-", "--out", "-", "--quiet",
                               stdin=CSV.encode())
        self.assertEqual(out.decode(), "t,u,v,w,geometry,triangle,facing\n1,0.25,0.25,0.5,0,0,0\n"
                                       "inf,0,0,0,4294967295,4294967295,0\n")
        self.assertEqual(said, "")
        out, _ = self.piped("locate", self.mesh, "--points", "-", "--out", "-",
                            stdin=b"0.25,0.25,0.25\n1,1,1\n")
        self.assertEqual(out, b"location\n1\n-1\n")
        out, _ = self.piped("nearest", self.mesh, "--points", "-", "--out", "-", "--format", "csv",
                            stdin=npy(np.float32([(0.25, 0.125, -2)])))
        self.assertEqual(out, b"x,y,z,distance,u,v,w,geometry,triangle,feature\n"
                              b"0.25,0.125,0,2,0.125,0.25,0.625,0,0,6\n")

    def test_a_file_as_standard_input_is_read_from_where_it_stands(self):
        self.write("two.npy", b"before" + npy(RAYS))
        with open(self.dir / "two.npy", "rb") as file:
            file.seek(6)
            for order in (RAYS, np.asfortranarray(RAYS)):
                self.write("two.npy", b"before" + npy(order))
                done = subprocess.run([TOOL, "cast", self.mesh, "--rays", "-", "--out", "s.npy"],
                                      cwd=self.dir, stdin=file, capture_output=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(field_bytes(self.load("s.npy")), field_bytes(self.expected))

    def test_commands_in_a_row(self):
        rays = subprocess.Popen([TOOL, "rays", self.mesh, "--size", "64x64", "--out", "-"],
                                cwd=self.dir, stdout=subprocess.PIPE)
        done = subprocess.run([TOOL, "cast", self.mesh, "--rays", "-", "--out", "p.npy"],
                              cwd=self.dir, stdin=rays.stdout, capture_output=True)
        rays.stdout.close()
        self.assertEqual((rays.wait(), done.returncode), (0, 0), done.stderr)
        self.succeed("rays", self.mesh, "--size", "64x64", "--out", "c.npy")
        self.succeed("cast", self.mesh, "--rays", "c.npy", "--out", "q.npy")
        self.assertEqual((self.dir / "p.npy").read_bytes(), (self.dir / "q.npy").read_bytes())
        grid, _ = self.piped("voxelise", self.mesh, "--size", "8", "--out", "-", stdin=b"")
        self.succeed("voxelise", self.mesh, "--size", "8", "--out", "g.npy")
        self.assertEqual(grid, (self.dir / "g.npy").read_bytes())

    def test_errors_name_standard_input_and_nothing_comes_out(self):
        bad = RAYS.copy()
        bad[5432, 3:] = 0
        for stdin, words in ((npy(bad), "row 5432 (counted from 0): bad ray"),
                             (npy(RAYS)[:-1], "it was cut off"), (b"", "is empty"),
                             (b"a,b\n", "standard input:1: the titles"),
                             (b"1,2,3,4,5,6\n1,2,3\n", "standard input:2: expected 6 fields"),
                             (b"\x93NUMPY", "is no .npy file"), (b"PK\x03\x04..", "archive")):
            out, said = self.piped("cast", self.mesh, "--rays", "-", "--out", "-", stdin=stdin,
                                   status=1)
            self.assertEqual(out, b"")
            self.assertTrue(said.startswith("pierce: standard input:"), said)
            self.assertIn(words, said)
            self.assertEqual(said.count("\n"), 1, said)

    def test_contradictions_are_bad_usage(self):
        cast = ("cast", self.mesh, "--rays", "r.npy")
        for more, words in ((("--out", "h.csv", "--format", "npy"), "--format: is for --out -"),
                            (("--out", "-", "--json"), "--json: standard output gets the answers"),
                            (("--out", "-", "--format", "npz"), "--format"), ((), "--out: name"),
                            (("--out", "h.txt"), "must end in .npy or .npz or .csv"),
                            (("--out", "-", "--ray", "1,1,1,1,1,1"), "together with --rays")):
            self.assertIn(words, self.fail_with(2, *cast, *more))

    def test_mistakes_are_told_before_anything_is_read(self):
        reader, writer = os.pipe()  # from which nothing comes, and which does not end
        for command, rays in (("cast", "--rays"), ("locate", "--points")):
            process = self.start(command, self.mesh, rays, "-", "--out", "h.txt", stdin=reader,
                                 stderr=subprocess.PIPE)
            _, said = process.communicate(timeout=PATIENCE)
            self.assertEqual((process.returncode, said.count(b"\n")), (2, 1), said)
            self.assertIn(b"'h.txt' must end in .npy or .npz or .csv", said)
        os.close(reader)
        os.close(writer)

    def test_a_reader_that_has_gone_ends_it_quietly(self):
        before = self.files()
        for more in ((), ("--format", "npy")):
            reader, writer = os.pipe()
            os.close(reader)
            process = self.start("cast", self.mesh, "--rays", "r.npy", "--out", "-", *more,
                                 stdout=writer, stderr=subprocess.PIPE)
            os.close(writer)
            _, said = process.communicate(timeout=PATIENCE)
            self.assertEqual((process.returncode, said), (128 + signal.SIGPIPE, b""))
        self.assertEqual(self.files(), before)

    def test_full_and_closed_standard_output_are_errors(self):
        with open("/dev/full", "wb") as full:
            process = self.start("cast", self.mesh, "--rays", "r.npy", "--out", "-", stdout=full,
                                 stderr=subprocess.PIPE)
            _, said = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 1)
        self.assertTrue(said.startswith(b"pierce: standard output: cannot be written: No space"))
        process = self.start("cast", self.mesh, "--rays", "r.npy", "--out", "-",
                             stderr=subprocess.PIPE, preexec_fn=lambda: os.close(1))
        _, said = process.communicate(timeout=PATIENCE)
        self.assertEqual(process.returncode, 1)
        self.assertIn(b"standard output", said)

    def test_no_folder_for_temporary_files_is_an_error(self):
        line = self.fail_with(1, "cast", self.mesh, "--rays", "r.npy", "--out", "-",
                              env={**os.environ, "TMPDIR": "/proc"})
        self.assertIn("standard output: cannot be prepared in the folder for temporary files", line)


if __name__ == "__main__":
    unittest.main()
