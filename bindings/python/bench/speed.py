#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How much slower 10^7 rays are from Python than from C++, and how much memory they take.

  cmake --build BUILD --target pierce_python_speed       BUILD: pip's build/python/TAG
  speed.py BUILD/bindings/python/pierce_python_speed [--rays N] [--times K]

Both sides cast the same rays at the same mesh in turns; the best of K times counts. Each Python
call makes new arrays for its answers, the C++ program fills the same ones again.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import pierce
from pierce import rays as make


def bumpy_sphere(n: int) -> tuple[np.ndarray, np.ndarray]:
    """2 n^2 triangles."""
    across = np.linspace(0, 2 * np.pi, n, endpoint=False)
    down = np.linspace(0.01, np.pi - 0.01, n)
    a, b = np.meshgrid(across, down)
    r = 1 + 0.05 * np.sin(9 * a) * np.sin(7 * b)
    vertices = np.stack([r * np.sin(b) * np.cos(a), r * np.sin(b) * np.sin(a), r * np.cos(b)], -1)
    i, j = np.meshgrid(np.arange(n - 1), np.arange(n), indexing="ij")
    p, q = i * n + j, i * n + (j + 1) % n
    corners = [np.stack([p, p + n, q], -1), np.stack([q, p + n, q + n], -1)]
    return vertices.reshape(-1, 3), np.concatenate(corners).reshape(-1, 3).astype(np.uint32)


def camera(count: int) -> np.ndarray:
    side = round(count**0.5)
    six = make.pinhole(side, side, fov=45, center=(0, 0, 0), eye=(0, -3, 1), up=(0, 0, 1))
    ends = np.broadcast_to([0, np.inf], (*six.shape[:-1], 2))
    return np.concatenate([six, ends], axis=-1).reshape(-1, 8)


def scattered(count: int) -> np.ndarray:
    rng = np.random.default_rng(1)
    rays = np.empty((count, 8))
    rays[:, :3] = rng.uniform(-1.5, 1.5, (count, 3))
    rays[:, 3:6] = rng.standard_normal((count, 3))
    rays[:, 6:] = [0, np.inf]
    return rays


def peak() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rays", type=int, default=10_000_000)
    parser.add_argument("--times", type=int, default=5)
    given = parser.parse_args()
    vertices, triangles = bumpy_sphere(190)
    scene = pierce.Scene(vertices, triangles)
    print(f"{len(triangles)} triangles, float64, closest hit, best of {given.times}")
    with tempfile.TemporaryDirectory() as folder:
        paths = [str(Path(folder) / name) for name in ("vertices", "triangles", "rays")]
        vertices.tofile(paths[0])
        triangles.tofile(paths[1])
        for kind in (camera, scattered):
            rays = kind(given.rays)
            rays.tofile(paths[2])
            for threads in (1, 2):
                compare(given, scene, rays, paths, kind.__name__, threads)


def compare(given: argparse.Namespace, scene: pierce.Scene, rays: np.ndarray, paths: list[str],
            kind: str, threads: int) -> None:
    cpp, python, extra = [], [], []
    for _ in range(given.times):  # in turns, so that a busy machine is busy for both
        done = subprocess.run([given.program, *paths, str(threads), "2"], check=True,
                              capture_output=True, text=True)
        cpp += [float(line) for line in done.stdout.split()]
        for _ in range(2):
            before = peak()
            start = time.perf_counter()
            hits = scene.closest_hit(rays, threads=threads)
            python.append(time.perf_counter() - start)
            output = sum(column.nbytes for column in hits._columns.values())
            extra.append((peak() - before, output))
            del hits
    more = max(grown - output for grown, output in extra) / 2**20
    rate = len(rays) / min(python) / 1e6
    print(f"{kind:9} {len(rays)} rays, {threads} threads: C++ {min(cpp):.3f} s, Python "
          f"{min(python):.3f} s ({100 * (min(python) / min(cpp) - 1):+.1f} %), {rate:.2f} Mrays/s, "
          f"memory beside the answers {max(more, 0):.0f} MiB")


if __name__ == "__main__":
    main()
