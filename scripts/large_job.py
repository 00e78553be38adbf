#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the table "A real run" of docs/large_jobs.md: a billion rays that are stored nowhere.

A height field of 999,698 triangles; a billion rays of a camera, streamed by one command and
reduced to bits, on one thread and on two; the same as a job; and, in turns with these, the same
rays in memory, made beforehand, through the library by way of the Python package. Every hit of the
rays in memory must be the streamed one. What counts is processor time, as the machine may have
other work.

usage: large_job.py [--tool TOOL] [--write] [--side N] [--rounds N] [--folder FOLDER]
By the Python of an environment with the package. --side: rays of the camera are side x side
[31623]; --write puts the table into the page; --folder: where to work, 400 MB [a temporary one].
"""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

import pierce
import pierce.job

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "large_jobs.md"
BEGIN, END = "<!-- real run: begin (scripts/large_job.py) -->", "<!-- real run: end -->"
POINTS = 708  # along a side of the height field
BATCH = 1 << 21  # rays in memory at a time
SAMPLES = 24  # batches in memory: spread evenly over the picture


def height_field(path):
    """Hills of seven sizes, and a little noise, as a binary PLY."""
    random = np.random.default_rng(1)
    line = np.linspace(0, 1, POINTS)
    x, y = np.meshgrid(line, line)
    z = random.uniform(-1, 1, x.shape) * 0.2 / POINTS
    for k in range(1, 8):
        for _ in range(3):
            a, b = random.uniform(-1, 1, 2) * 2 ** k
            z += np.sin(2 * np.pi * (a * x + b * y) + random.uniform(0, 6)) * 0.1 / 2 ** k
    i = np.arange(POINTS * (POINTS - 1)).reshape(-1, POINTS)[:, :-1].reshape(-1, 1)
    triangles = np.hstack([i, i + 1, i + POINTS, i + 1, i + POINTS + 1, i + POINTS]).reshape(-1, 3)
    vertices = np.stack([x, y, z], -1).reshape(-1, 3).astype("<f4")
    faces = np.zeros(len(triangles), [("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, triangles
    with open(path, "wb") as out:
        out.write("ply\nformat binary_little_endian 1.0\n"
                  f"element vertex {len(vertices)}\n"
                  "property float x\nproperty float y\nproperty float z\n"
                  f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
                  "end_header\n".encode() + vertices.tobytes() + faces.tobytes())


def memory_of(process):
    """The most it has had, in MiB."""
    lines = pathlib.Path(f"/proc/{process}/status").read_text().splitlines()
    return sum(int(line.split()[1]) for line in lines if line.startswith("VmHWM")) / 1024


class Run:
    """A command that is run: its processor time, wall time, and the most memory it had."""

    def __init__(self, *command):
        begin = time.perf_counter()
        process = subprocess.Popen([str(word) for word in command])
        self.memory, ended = 0, 0
        while not ended:  # the kernel's own figure counts what this process had when it forked
            self.memory = max(self.memory, memory_of(process.pid))
            time.sleep(0.005)
            ended, status, used = os.wait4(process.pid, os.WNOHANG)
        process.returncode = status
        if status != 0:
            sys.exit(f"failed: {' '.join(map(str, command))}")
        self.wall = time.perf_counter() - begin
        self.processor = used.ru_utime + used.ru_stime

    def better(self, other):
        return self if other is None or self.processor < other.processor else other


def rays_of(made, first, count):
    """Rays first, first + 1, ... of a camera as its job.json has it: what the tool makes."""
    row, column = np.divmod(np.arange(first, first + count), made["width"])
    s = (2 * column.astype(float) + 1) / made["width"] - 1
    t = 1 - (2 * row.astype(float) + 1) / made["height"]
    forward, right, up = (np.array(made[name]) for name in ("forward", "right", "up"))
    rays = np.empty((count, 6), np.float32)
    rays[:, :3] = np.array(made["origin"])
    rays[:, 3:] = forward + s[:, None] * right + t[:, None] * up
    return rays


class InMemory:
    """Batches of the camera's rays: the library's processor time a ray, and whether the answers
    are the streamed ones."""

    def __init__(self, scene, made):
        self.scene = pierce.open(scene)
        total = made["width"] * made["height"]
        count = min(BATCH, total // 8 * 8)
        self.first = [(total - count) * k // (SAMPLES - 1) // 8 * 8 for k in range(SAMPLES)]
        self.rays = [rays_of(made, first, count) for first in self.first]

    def cast(self, threads):
        begin = time.process_time()
        self.hits = [self.scene.any_hit(rays, threads=threads) for rays in self.rays]
        return (time.process_time() - begin) / sum(map(len, self.rays))

    def compare(self, bits):
        streamed = np.load(bits, mmap_mode="r")
        for first, hits in zip(self.first, self.hits):
            part = np.unpackbits(streamed[first // 8:(first + len(hits)) // 8])
            if not np.array_equal(part, hits[:len(part)]):
                sys.exit(f"other answers than in memory from ray {first} on")


class Streamed:
    """The same rays by one command."""

    def __init__(self, tool, scene, side, out):
        self.command = [tool, "cast", scene, "--camera", "--size", f"{side}x{side}", "--reduce",
                        "bits", "--out", out, "--quiet", "--threads"]

    def cast(self, threads):
        return Run(*self.command, threads)


def size_of(folder):
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def row(name, run, disk, rays=None):
    """A line of the table."""
    rate = rays / run.processor * 1e-6 if rays else 0
    count = f"{rays:,}" if rays else ""
    return (f"| {name} | {count} | {run.processor:.1f} s | {run.wall:.0f} s | "
            f"{f'{rate:.{int(rate < 10)}f} M' if rays else ''} | {run.memory:.0f} MiB | "
            f"{disk / 2 ** 20:.0f} MiB |")


def measure(tool, side, rounds, folder):
    mesh, scene = folder / "hills.ply", folder / "hills.pierce"
    height_field(mesh)
    Run(tool, "build", mesh, "--out", scene, "--quiet")
    job, bits = folder / "job", folder / "bits.npy"
    Run(tool, "job", "create", scene, "--camera", "--size", f"{side}x{side}", "--reduce", "bits",
        "--chunk", max(side * side // 30, 8), "--job", job, "--quiet")
    memory = InMemory(scene, json.loads((job / "job.json").read_text())["rays"])
    streamed = Streamed(tool, scene, side, bits)
    best, batches = {1: None, 2: None}, {1: [], 2: []}
    for _ in range(rounds):
        for threads in (1, 2):
            batches[threads].append(memory.cast(threads))
            best[threads] = streamed.cast(threads).better(best[threads])
            batches[threads].append(memory.cast(threads))
    memory.compare(bits)
    rays = side * side
    rows = ["| | rays | processor time | wall time | rays a second and core | memory | disk |",
            "| --- | --- | --- | --- | --- | --- | --- |"]
    for threads, run in best.items():
        words = "one thread" if threads == 1 else "two threads"
        rows.append(row(f"`pierce cast`, camera {side}x{side}, bits, {words}", run,
                        bits.stat().st_size, rays))
    run = Run(tool, "job", "run", job, "--quiet")
    rows.append(row("the same by `pierce job run`, 30 chunks", run, size_of(job), rays))
    merged = folder / "merged.npy"
    rows.append(row("`pierce job merge` of it",
                    Run(tool, "job", "merge", job, "--out", merged, "--quiet"),
                    merged.stat().st_size))
    if merged.read_bytes() != bits.read_bytes():
        sys.exit("the job's bytes are not those of one command")
    chords = max(rays // 100, 1)
    seen = folder / "seen.npy"
    run = Run(tool, "cast", scene, "--sphere", chords, "--reduce", "triangles", "--out", seen,
              "--quiet", "--threads", 1)
    rows.append(row("`pierce cast`, random chords, triangles, one thread", run,
                    seen.stat().st_size, chords))
    lines = rows + [""]
    for threads, words in ((1, "One thread"), (2, "Two threads")):
        one = best[threads].processor / rays * 1e9
        all_of = sorted(1e9 * cost for cost in batches[threads])
        lines.append(f"{words}: {one:.1f} ns of processor time a ray for all of the command; "
                     f"{all_of[0]:.1f} to {all_of[-1]:.1f} ns for batches of {BATCH:,} rays "
                     f"in memory, which were made before.")
    hits = np.load(seen).sum() / chords
    share = int(np.bitwise_count(np.load(bits)).sum()) / rays
    lines += ["", f"{share:.0%} of the camera's rays and {hits:.0%} of the chords hit."]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", type=pathlib.Path, default=pierce.job.tool_path())
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--side", type=int, default=31623)
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--folder", type=pathlib.Path)
    options = parser.parse_args()
    folder = options.folder or pathlib.Path(tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    try:
        text = measure(options.tool.resolve(), options.side, options.rounds, folder)
    finally:
        if options.folder is None:
            shutil.rmtree(folder)
    print(text)
    if options.write:
        page = PAGE.read_text()
        before, rest = page.split(BEGIN)
        PAGE.write_text(before + BEGIN + "\n" + text + "\n" + END + rest.split(END)[1])


if __name__ == "__main__":
    main()
