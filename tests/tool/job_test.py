#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Rays made on the fly, answers reduced, and jobs: whatever is killed, the bytes are the same."""

import json
import os
import random
import signal
import subprocess
import time
import unittest

import numpy as np

from harness import TOOL, ToolTest, TETRA_TRIANGLES, TETRA_VERTICES

RAYS = 40000


class JobTest(ToolTest):
    def setUp(self):
        super().setUp()
        rows = ["OFF", f"{len(TETRA_VERTICES)} {len(TETRA_TRIANGLES)} 0"]
        rows += [" ".join(map(str, v)) for v in TETRA_VERTICES]
        rows += ["3 " + " ".join(map(str, t)) for t in TETRA_TRIANGLES]
        (self.dir / "a.off").write_text("\n".join(rows) + "\n")

    def cast(self, *args, out="cast.npy"):
        self.succeed("cast", "a.off", *args, "--out", out, "--quiet")
        return (self.dir / out).read_bytes()

    def create(self, folder, *args):
        self.succeed("job", "create", "a.off", *args, "--job", folder, "--quiet")

    def merged(self, folder):
        self.succeed("job", "merge", folder, "--out", "merged.npy", "--quiet")
        return (self.dir / "merged.npy").read_bytes()


class MadeRays(JobTest):
    def test_a_camera_makes_the_rays_of_pierce_rays(self):
        self.succeed("rays", "a.off", "--size", "37x21", "--out", "rays.npy", "--quiet")
        self.assertEqual(self.cast("--camera", "--size", "37x21"),
                         self.cast("--rays", "rays.npy", out="file.npy"))

    def test_other_sources_hit_what_they_should(self):
        self.cast("--grid", "64x64", "--along", "-z", "--reduce", "depth")
        depth = np.load(self.dir / "cast.npy")
        self.assertEqual(depth.shape, (64, 64))
        # Seen along -z, the tetrahedron is a right triangle: half of the square, and its diagonal.
        self.assertEqual(np.isfinite(depth).sum(), 64 * 65 // 2)
        self.cast("--lidar", "90x8", "--at", "0.1,0.1,0.1", "--elevations", "-80,80",
                  "--query", "any")
        self.assertTrue(np.load(self.dir / "cast.npy").all())  # from within
        self.cast("--sphere", str(RAYS), "--query", "any")
        first = np.load(self.dir / "cast.npy")
        # A chord meets a convex body with the chance of their surfaces.
        surface = 1.5 + np.sqrt(3) / 2
        self.assertAlmostEqual(first.mean(), surface / (4 * np.pi * 0.75), delta=0.02)
        self.cast("--sphere", str(RAYS), "--seed", "2", "--query", "any")
        self.assertFalse(np.array_equal(first, np.load(self.dir / "cast.npy")))

    def test_reductions_are_of_the_answers(self):
        rays = ("--sphere", str(RAYS + 3))
        self.cast(*rays)
        hits = np.load(self.dir / "cast.npy")
        hit = hits["triangle"] != 4294967295
        self.cast(*rays, "--reduce", "bits")
        bits = np.unpackbits(np.load(self.dir / "cast.npy"))[:RAYS + 3]
        self.assertTrue(np.array_equal(bits == 1, hit))
        self.cast(*rays, "--reduce", "depth")
        self.assertTrue(np.array_equal(np.load(self.dir / "cast.npy"), hits["t"]))
        self.cast(*rays, "--reduce", "triangles")
        self.assertTrue(np.array_equal(np.load(self.dir / "cast.npy"),
                                       np.bincount(hits["triangle"][hit], minlength=4)))
        self.cast(*rays, "--reduce", "parts")
        self.assertEqual(np.load(self.dir / "cast.npy").tolist(), [hit.sum()])
        self.cast(*rays, "--reduce", "histogram", "--bins", "8", "--t-range", "0.25,0.75")
        t = hits["t"][hit].astype(float)
        part = np.floor((t[(t >= 0.25) & (t < 0.75)] - 0.25) / 0.5 * 8).astype(int)
        self.assertTrue(np.array_equal(np.load(self.dir / "cast.npy"),
                                       np.bincount(part, minlength=8)))

    def test_what_makes_no_sense_is_said(self):
        for args, words in (
                (["--camera", "--grid", "2x2"], "not several"),
                (["--sphere", "9", "--ray", "0,0,1,0,0,1"], "cannot be given together"),
                (["--sphere", "9", "--reduce", "depth", "--query", "all"], "is of first hits"),
                (["--sphere", "9", "--reduce", "histogram"], "give --t-range"),
                (["--grid", "2x2", "--along", "w"], "is none of x, y, z"),
                (["--lidar", "2x2", "--elevations", "9,-9"], "--elevations")):
            self.assertIn(words, self.fail_with(2, "cast", "a.off", *args, "--out", "x.npy"))


class Jobs(JobTest):
    def test_merged_bytes_are_those_of_cast(self):
        sphere = ("--sphere", "5003", "--seed", "9")
        for n, args in enumerate((["--query", "closest"], ["--query", "all", "--max-hits", "3"],
                                  ["--query", "count", "--sides", "back"], ["--query", "any"],
                                  ["--query", "crossings"], ["--reduce", "bits"],
                                  ["--reduce", "depth"], ["--reduce", "triangles"],
                                  ["--reduce", "histogram", "--t-range", "0,1"],
                                  ["--precision", "float"])):
            self.create(f"job{n}", *sphere, *args, "--chunk", "1001")
            parts = [self.start("job", "run", f"job{n}", "--part", f"{i}/2", "--quiet")
                     for i in range(2)]
            self.assertEqual([part.wait() for part in parts], [0, 0])
            self.assertEqual(self.merged(f"job{n}"), self.cast(*sphere, *args), args)
            self.succeed("job", "verify", f"job{n}", "--chunks", "1", "--quiet")

    def test_rays_of_a_file_and_two_workers_on_the_same_chunks(self):
        random_rays = np.random.default_rng(1).uniform(-2, 2, (3000, 6))
        np.save(self.dir / "rays.npy", random_rays)
        self.create("job", "--rays", "rays.npy", "--chunk", "100")
        workers = [self.start("job", "run", "job", "--quiet") for _ in range(3)]
        self.assertEqual([worker.wait() for worker in workers], [0, 0, 0])
        self.assertEqual(self.merged("job"), self.cast("--rays", "rays.npy"))
        random_rays[0, 0] += 1
        np.save(self.dir / "rays.npy", random_rays)
        self.assertIn("its checksum is another", self.fail_with(1, "job", "verify", "job"))
        np.save(self.dir / "rays.npy", random_rays[1:])
        self.assertIn("is not the file of rays", self.fail_with(1, "job", "run", "job"))

    def test_killed_at_any_moment(self):
        args = ("--sphere", str(RAYS), "--query", "all")
        self.create("job", *args, "--chunk", "64")
        moments, killed = random.Random(3), 0
        for _ in range(20):
            worker = self.start("job", "run", "job", "--quiet")
            time.sleep(0.02 + 0.1 * moments.random())
            worker.send_signal(signal.SIGKILL)
            killed += worker.wait() == -signal.SIGKILL
        self.assertGreater(killed, 0)
        told = json.loads(self.succeed("job", "status", "job", "--json").stdout)
        self.assertEqual(told["chunks"], (RAYS + 63) // 64)
        lines = self.succeed("job", "run", "job", "--json").stdout.splitlines()
        self.assertEqual(len(lines), told["chunks"] - told["done"])
        for line in lines:
            self.assertIn("rays_per_second", json.loads(line))
        self.assertEqual(self.merged("job"), self.cast(*args))

    def test_a_full_disk(self):
        disk = self.dir / "small"
        disk.mkdir()
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1m", "none", disk],
                               capture_output=True, check=False)
        if mount.returncode != 0:
            self.skipTest("may not mount")
        self.addCleanup(subprocess.run, ["umount", disk], check=False)
        args = ("--sphere", str(RAYS))
        self.create("small/job", *args, "--chunk", "1000")
        self.assertIn("No space left", self.fail_with(1, "job", "run", "small/job"))
        told = json.loads(self.succeed("job", "status", "small/job", "--json").stdout)
        self.assertTrue(0 < told["done"] < told["chunks"], told)
        self.assertEqual(told["unfinished_files"], 0)
        subprocess.run(["mount", "-o", "remount,size=9m", disk], check=True)
        self.succeed("job", "run", "small/job", "--quiet")
        self.assertEqual(self.merged("small/job"), self.cast(*args))

    def run_in(self, **variables):
        """A run with these environment variables; the chunks that are there afterwards."""
        clean = {name: value for name, value in os.environ.items()
                 if not name.startswith(("OMPI_", "PMI_", "SLURM_"))}
        done = subprocess.run([TOOL, "job", "run", "job"], cwd=self.dir, capture_output=True,
                              text=True, check=False, env={**clean, **variables})
        there = sorted(int(file.stem) for file in (self.dir / "job" / "chunks").iterdir())
        for chunk in (self.dir / "job" / "chunks").iterdir():
            chunk.unlink()
        return there, done

    def test_parts_that_others_name(self):
        self.create("job", "--sphere", "800", "--chunk", "100")
        array = {"SLURM_ARRAY_TASK_ID": "7", "SLURM_ARRAY_TASK_MIN": "5",
                 "SLURM_ARRAY_TASK_STEP": "2", "SLURM_ARRAY_TASK_COUNT": "2"}
        batch = {"SLURM_PROCID": "0", "SLURM_NTASKS": "2"}  # and no srun: the only process
        step = {"SLURM_PROCID": "1", "SLURM_NTASKS": "4", "SLURM_STEP_NUM_TASKS": "4"}
        ranks = {"OMPI_COMM_WORLD_RANK": "1", "OMPI_COMM_WORLD_SIZE": "2"}
        for variables, chunks in (
                ({}, range(8)), (batch, range(8)), (ranks, range(1, 8, 2)), (step, [1, 5]),
                ({"PMI_RANK": "3", "PMI_SIZE": "4"}, [3, 7]), (array, range(1, 8, 2)),
                ({**array, **batch}, range(1, 8, 2)), ({**array, **step}, [5]),
                ({**array, **batch, **ranks}, [3, 7]), ({**ranks, **step}, range(1, 8, 2))):
            there, done = self.run_in(**variables)
            self.assertEqual(there, list(chunks), variables)
            self.assertEqual("part" in done.stderr, len(there) < 8, done.stderr)
        there, done = self.run_in(**{**array, "SLURM_ARRAY_TASK_ID": "8"})
        self.assertEqual((there, done.returncode), ([], 2))
        self.assertIn("give --part", done.stderr)

    def test_what_is_wrong(self):
        self.create("job", "--sphere", "800", "--chunk", "100")
        self.assertIn("holds a job already", self.fail_with(
            2, "job", "create", "a.off", "--sphere", "8", "--job", "job"))
        self.assertIn("give one of --rays,", self.fail_with(2, "job", "create", "a.off", "--job",
                                                            "none"))
        (self.dir / "none.csv").write_text("ox,oy,oz,dx,dy,dz\n")
        done = self.run_tool("job", "create", "a.off", "--rays", "none.csv", "--job", "none")
        self.assertEqual(done.returncode, 1)
        self.assertIn("pierce: none.csv: holds no rays: give some", done.stderr)
        self.assertFalse((self.dir / "none").exists())
        self.assertIn("is not i/n", self.fail_with(2, "job", "run", "job", "--part", "2/2"))
        self.assertIn("holds no job", self.fail_with(1, "job", "run", "none"))
        self.assertIn("chunk 0 is not there yet (0 of 8",
                      self.fail_with(1, "job", "merge", "job", "--out", "x.npy"))
        self.succeed("job", "run", "job", "--quiet")
        chunk = self.dir / "job" / "chunks" / "000000003.npy"
        whole = chunk.read_bytes()
        for end in (0, 9, len(whole) - 1):  # cut off
            chunk.write_bytes(whole[:end])
            for command in (("run", "job"), ("status", "job"), ("verify", "job"),
                            ("merge", "job", "--out", "x.npy")):
                self.assertIn("000000003.npy: is not this chunk of this job, or was cut off",
                              self.fail_with(1, "job", *command))
        for at in range(8, len(whole), len(whole) // 12):  # a bit flipped, anywhere
            chunk.write_bytes(whole[:at] + bytes([whole[at] ^ 16]) + whole[at + 1:])
            self.assertIn("000000003.npy", self.fail_with(1, "job", "merge", "job", "--out",
                                                          "x.npy"))
            self.assertFalse((self.dir / "x.npy").exists())
        chunk.write_bytes(whole[:-25] + b"\1" + whole[-24:])
        self.assertIn("is not as it was written",
                      self.fail_with(1, "job", "merge", "job", "--out", "x.npy"))
        self.assertIn("is not what its rays give",
                      self.fail_with(1, "job", "verify", "job", "--all"))
        chunk.write_bytes((chunk.parent / "000000002.npy").read_bytes())  # of another's rays
        for command in (("run", "job"), ("status", "job"), ("verify", "job"),
                        ("merge", "job", "--out", "x.npy")):
            self.assertIn("000000003.npy: is not this chunk of this job",
                          self.fail_with(1, "job", *command))
        chunk.unlink()
        self.succeed("job", "run", "job", "--quiet")
        self.assertEqual(chunk.read_bytes(), whole)
        self.assertFalse([f for f in chunk.parent.iterdir() if f.suffix != ".npy"])
        self.succeed("build", "a.off", "--quality", "fast", "--precision", "float", "--out",
                     "job/scene.pierce", "--quiet")
        chunk.unlink()
        self.assertIn("is not the scene of this job", self.fail_with(1, "job", "run", "job"))
        self.assertIn("is not the scene of this job", self.fail_with(1, "job", "verify", "job"))
        self.create("new", "--sphere", "800")
        self.assertIn("has no chunk that could be cast anew",
                      self.fail_with(1, "job", "verify", "new"))

    def test_rays_that_change_while_the_job_runs(self):
        rays = np.random.default_rng(0).normal(size=(1000, 6))
        np.save(self.dir / "good.npy", rays)
        rays[700:, 2] += 1
        np.save(self.dir / "bad.npy", rays)
        names = {name: (self.dir / f"{name}.npy").read_bytes() for name in ("good", "bad")}
        (self.dir / "rays.npy").write_bytes(names["good"])
        self.create("job", "--rays", "rays.npy", "--chunk", "104")
        self.succeed("job", "run", "job", "--part", "0/2", "--quiet")
        (self.dir / "rays.npy").write_bytes(names["bad"])  # of the same size
        self.run_tool("job", "run", "job", "--quiet")
        (self.dir / "rays.npy").write_bytes(names["good"])
        said = self.fail_with(1, "job", "merge", "job", "--out", "x.npy")
        self.assertIn("000000007.npy: was cast from other rays than the job's: remove it", said)
        self.assertFalse((self.dir / "x.npy").exists())
        (self.dir / "job" / "chunks" / "000000007.npy").unlink()
        (self.dir / "job" / "chunks" / "000000009.npy").unlink()
        self.succeed("job", "run", "job", "--quiet")
        self.assertEqual(self.merged("job"), self.cast("--rays", "rays.npy"))

    def test_job_json_is_damaged_or_edited(self):
        random_rays = np.random.default_rng(1).uniform(-2, 2, (300, 6))
        np.save(self.dir / "rays.npy", random_rays)
        self.create("job", "--rays", "rays.npy", "--chunk", "104", "--query", "count")
        path = self.dir / "job" / "job.json"
        text = path.read_text()
        self.succeed("job", "run", "job", "--quiet")
        changed = "was changed since the job was created"
        for old, new, words in (
                ('"chunk": 104', '"chunk": 3', "do not fit"),
                ('"query": "count"', '"query": "any"', changed),
                ('"both"', '"back"', changed), ('"closed"', '"open-start"', changed),
                ('"bins": 100', '"bins": 99', changed), ('"bins": 100', '"bins": -1', "bins"),
                ('"double"', '"float"', changed), ('"double"', '"half"', "neither float nor"),
                ('"none"', '"bits"', "does not fit the query"),
                ('"pierce_job": 3', '"pierce_job": 2', "another version"),
                ('"pierce_job": 3', '"pierce_job": ' + 100000 * "[" + 100000 * "]",
                 "expected a whole number, found array"),
                ("}\n", "", "is no JSON from here on"), (text, "", "is empty"),
                (text, "[]", "is no job"), ("rays.npy", "a.off", "is not the file of rays")):
            path.write_text(text.replace(old, new))
            self.assertIn(words, self.fail_with(1, "job", "merge", "job", "--out", "x.npy"))
        path.write_text(text.replace('"bins": 100', '"bins": 99'))
        self.assertIn(changed, self.fail_with(1, "job", "run", "job"))
        # The rays are elsewhere; the scene is.
        path.write_text(text.replace("rays.npy", "none.npy"))
        self.assertIn("the file of rays of the job: bring it back, or write into job.json",
                      self.fail_with(1, "job", "run", "job"))
        path.write_text(text.replace("scene.pierce", "none.pierce"))
        self.assertIn("the scene of the job: bring it back, or write into job.json",
                      self.fail_with(1, "job", "run", "job"))
        # Other rays under the same name, of the same size.
        path.write_text(text)
        random_rays[7, 0] += 1
        np.save(self.dir / "rays.npy", random_rays)
        self.assertIn("its checksum is another",
                      self.fail_with(1, "job", "merge", "job", "--out", "x.npy"))
        # A path may change, and a job without its chunks is none of the next one.
        (self.dir / "rays.npy").rename(self.dir / "moved.npy")
        random_rays[7, 0] -= 1
        np.save(self.dir / "moved.npy", np.random.default_rng(1).uniform(-2, 2, (300, 6)))
        path.write_text(text.replace("rays.npy", "moved.npy"))
        self.assertEqual(self.merged("job"),
                         self.cast("--rays", "moved.npy", "--query", "count"))
        path.unlink()
        self.assertIn("holds chunks of another job", self.fail_with(
            2, "job", "create", "a.off", "--sphere", "8", "--job", "job"))
        # As if somebody had copied them there.
        self.create("other", "--sphere", "300", "--chunk", "104", "--query", "count")
        (self.dir / "job" / "chunks" / "000000001.npy").rename(
            self.dir / "other" / "chunks" / "000000001.npy")
        self.assertIn("is not this chunk of this job", self.fail_with(1, "job", "run", "other"))

    def test_where_nothing_can_be_written(self):
        disk = self.dir / "small"
        disk.mkdir()
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=9m", "none", disk],
                               capture_output=True, check=False)
        if mount.returncode != 0:
            self.skipTest("may not mount")
        self.addCleanup(subprocess.run, ["umount", disk], check=False)
        args = ("--sphere", "800")
        self.create("small/job", *args, "--chunk", "100")
        self.succeed("job", "run", "small/job", "--part", "0/2", "--quiet")
        subprocess.run(["mount", "-o", "remount,ro", disk], check=True)
        self.assertIn("Read-only file system", self.fail_with(1, "job", "run", "small/job"))
        self.assertIn("Read-only file system", self.fail_with(
            1, "job", "create", "a.off", *args, "--job", "small/other"))
        self.succeed("job", "status", "small/job")
        subprocess.run(["mount", "-o", "remount,rw", disk], check=True)
        self.succeed("job", "run", "small/job", "--quiet")
        self.assertEqual(self.merged("small/job"), self.cast(*args))

    def test_clocks_that_do_not_agree(self):
        self.create("job", "--sphere", "800", "--chunk", "100")
        self.succeed("job", "run", "job", "--quiet")
        chunks = self.dir / "job" / "chunks"
        for name, when in (("000000001.0.new", 0), ("000000002.1.new", 2**32)):
            (chunks / name).write_bytes(b"half a chunk")
            os.utime(chunks / name, (when, when))
        for chunk in chunks.glob("*.npy"):
            os.utime(chunk, (2**32, 2**32))
        told = json.loads(self.succeed("job", "status", "job", "--json").stdout)
        self.assertEqual((told["done"], told["unfinished_files"]), (8, 2))
        self.assertEqual(self.merged("job"), self.cast("--sphere", "800"))
        self.assertEqual(len(list(chunks.glob("*.new"))), 1)  # the old one is gone


if __name__ == "__main__":
    unittest.main()
