#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds builds of the command against each other: the same answers, byte for byte.

    scripts/same_bytes.py build/{release,debug,release-clang}/tool/pierce
    scripts/same_bytes.py build/release/tool/pierce build/arm/pierce      (see scripts/arm.sh)

Makes hard meshes with rays and points at their hard places, asks every given program with every
kernel that it has and with one thread and two, and compares what they write with what the first
program writes. Needs NumPy. Exit status: 0 if all bytes are the same, 1 if not.
"""
import argparse
import itertools
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

KERNELS = ["avx512", "avx2", "sse4", "neon", "plain"]
UNKNOWN_KERNEL = "no such kernel"


def ball(steps):
    """A closed grid on a ball: vertices, triangles."""
    turn = np.arange(2 * steps) * np.pi / steps
    tilt = np.arange(1, steps) * np.pi / steps
    ring = [(np.sin(b) * np.cos(a), np.sin(b) * np.sin(a), np.cos(b)) for b in tilt for a in turn]
    top, bottom, around = len(ring), len(ring) + 1, 2 * steps
    faces = []
    for i in range(around):
        j = (i + 1) % around
        last = (steps - 2) * around
        faces += [(top, i, j), (bottom, last + j, last + i)]
        for k in range(0, last, around):
            faces += [(k + i, k + around + i, k + around + j), (k + i, k + around + j, k + j)]
    return np.array([*ring, (0, 0, 1), (0, 0, -1)]), np.array(faces)


def box_of_cells(cells):
    """A closed box on a grid of whole numbers, whose faces are cut into squares."""
    index, faces = {}, []
    number = lambda p: index.setdefault(p, len(index))
    for axis, side in itertools.product(range(3), (0, cells)):
        for i, j in itertools.product(range(cells), repeat=2):
            corner = lambda u, v: tuple(np.roll((side, i + u, j + v), axis))
            a, b, c, d = (number(corner(*p)) for p in ((0, 0), (1, 0), (1, 1), (0, 1)))
            faces += [(a, b, c), (a, c, d)] if side else [(a, c, b), (a, d, c)]
    return np.array(list(index), dtype=float), np.array(faces)


def needles(random, count):
    """Triangles as long as the box and next to nothing across, some without area."""
    a, b = random.uniform(-1, 1, (2, count, 3))
    across = random.normal(size=(count, 3)) * 2.0 ** -random.integers(10, 60, (count, 1))
    c = a + random.uniform(0, 1, (count, 1)) * (b - a) + across
    return np.stack([a, b, c], 1).reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def meshes(random):
    """name -> vertices, triangles, whether closed."""
    vertices, faces = ball(24)
    bumpy = vertices * (1 + 0.2 * random.random((len(vertices), 1)))
    yield "ball", bumpy, faces, True
    yield "far", bumpy * 40 + (512345.678, 5412345.678, 312.5), faces, True
    yield "huge", bumpy * 1e30, faces, True
    yield "tiny", bumpy * 1e-30, faces, True
    yield "cells", *box_of_cells(6), True
    vertices, faces = needles(random, 1500)
    yield "needles", vertices, np.concatenate([faces, faces[:200]]), False


def write_ply(path, vertices, faces, kind):
    name = {"f4": "float", "f8": "double"}[kind]
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
            + "".join(f"property {name} {axis}\n" for axis in "xyz")
            + f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    records = np.zeros(len(faces), dtype=[("n", "u1"), ("v", "<i4", 3)])
    records["n"], records["v"] = 3, faces
    path.write_bytes(head.encode() + vertices.astype("<" + kind).tobytes() + records.tobytes())


def hard_points(random, vertices, faces, count):
    """On vertices, edges and faces, a little beside them, and anywhere."""
    of = vertices[faces[random.integers(len(faces), size=count)]]
    weights = random.random((count, 3)) * random.integers(0, 2, (count, 3))
    weights[weights.sum(1) == 0, 0] = 1
    points = (of * (weights / weights.sum(1, keepdims=True))[:, :, None]).sum(1)
    low, high = vertices.min(0), vertices.max(0)
    anywhere = random.uniform(low - 0.2 * (high - low), high + 0.2 * (high - low), (count, 3))
    beside = np.nextafter(points, anywhere)
    choice = random.integers(0, 3, (count, 1))
    return np.where(choice == 0, points, np.where(choice == 1, beside, anywhere))


def hard_rays(random, vertices, faces, count):
    origins = hard_points(random, vertices, faces, count)
    targets = hard_points(random, vertices, faces, count)
    directions = targets - origins
    along = random.integers(0, 4, count) == 0
    directions[along] *= np.eye(3)[random.integers(3, size=along.sum())]
    directions[np.abs(directions.astype("<f4")).max(1) == 0] = (1, 0, 0)
    return np.concatenate([origins, directions], 1)


def asked(closed):
    for query in ("closest", "all", "crossings", "count", "any"):
        yield ["cast", "--query", query], "rays"
    yield ["cast", "--query", "closest", "--sides", "front"], "rays"
    open_mesh = [] if closed else ["--open-mesh"]
    yield ["locate", *open_mesh], "points"
    yield ["voxelise", "--size", "24", *open_mesh], None
    yield ["nearest"], "points"
    yield ["nearest", "--signed", *open_mesh], "points"


class Comparison:
    def __init__(self, programs, folder):
        self.programs, self.folder = programs, folder
        self.kernels = {p: [k for k in KERNELS if self.knows(p, k)] for p in programs}
        self.compared = self.different = 0

    def run(self, program, kernel, arguments):
        return subprocess.run([program, *arguments], cwd=self.folder, text=True,
                              capture_output=True, env=dict(os.environ, PIERCE_KERNEL=kernel))

    def knows(self, program, kernel):
        done = self.run(program, kernel, ["info", "probe.ply"])
        return UNKNOWN_KERNEL not in done.stderr

    def answer(self, program, kernel, threads, arguments):
        out = self.folder / "answer.npy"
        out.unlink(missing_ok=True)
        done = self.run(program, kernel,
                        [*arguments, "--threads", str(threads), "--out", str(out), "--quiet"])
        # What is refused must be refused by all, and in the same words.
        return out.read_bytes() if done.returncode == 0 else done.stderr

    def ask(self, arguments):
        first = None
        every = ((p, k, n) for p in self.programs for k in self.kernels[p] for n in (1, 2))
        for program, kernel, threads in every:
            answer = self.answer(program, kernel, threads, arguments)
            if first is None:
                first = answer
                if isinstance(answer, str):
                    print(f"refused: {' '.join(arguments)}: {answer.strip()}", flush=True)
                continue
            self.compared += 1
            if answer != first:
                self.different += 1
                print(f"different: {program} {kernel} {threads} threads: {' '.join(arguments)}",
                      flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("programs", nargs="+", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--rays", type=int, default=4000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        write_ply(folder / "probe.ply", *ball(4), "f4")
        comparison = Comparison(options.programs, folder)
        for name, vertices, faces, closed in meshes(random):
            rays = hard_rays(random, vertices, faces, options.rays)
            points = hard_points(random, vertices, faces, options.rays)
            for kind in ("f4", "f8"):
                write_ply(folder / "mesh.ply", vertices, faces, kind)
                np.save(folder / "rays.npy", rays.astype("<" + kind))
                np.save(folder / "points.npy", points.astype("<" + kind))
                for words, data in asked(closed):
                    comparison.ask([words[0], "mesh.ply", *words[1:]]
                                   + ([f"--{data}", f"{data}.npy"] if data else []))
            print(f"{name}: {comparison.compared} answers compared", flush=True)
    for program, kernels in comparison.kernels.items():
        print(f"{program}: kernels {' '.join(kernels)}, 1 and 2 threads")
    print(f"{comparison.compared} answers compared with the first, {comparison.different} differ")
    return 1 if comparison.different else 0


if __name__ == "__main__":
    sys.exit(main())
