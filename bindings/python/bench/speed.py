#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How much slower 10^7 rays are from Python than from C++, and how much memory they take.

  cmake --build BUILD --target pierce_python_speed       BUILD: pip's build/python/TAG
  speed.py BUILD/bindings/python/pierce_python_speed [--rays N] [--times K]

Both sides cast the same rays at the same mesh, batch by batch in turns, so that a busy machine is
busy for both; medians of K are compared, of the time and of what processors worked, which a busy
machine disturbs less. Either both make new arrays for their answers in each call, or both fill the
same ones again (`out` in Python), whose pages are there already. Memory is Linux's count of the
largest resident size during a call, less what was there before and what the answers take. 5 GB.
"""

from __future__ import annotations

import argparse
import re
import statistics
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


def resident(which: str) -> int:
    """Bytes: VmRSS now, VmHWM at most since forget_peak()."""
    status = Path("/proc/self/status").read_text()
    found = re.search(rf"^{which}:\s+(\d+) kB$", status, re.MULTILINE)
    assert found is not None
    return 1024 * int(found[1])


def forget_peak() -> None:
    Path("/proc/self/clear_refs").write_text("5")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rays", type=int, default=10_000_000)
    parser.add_argument("--times", type=int, default=7)
    given = parser.parse_args()
    vertices, triangles = bumpy_sphere(190)
    scene = pierce.Scene(vertices, triangles)
    print(f"{len(triangles)} triangles, float64, closest hit, medians of {given.times}")
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
    times: dict[tuple[str, str], list[tuple[float, float]]] = {}
    extra = []
    same = scene.closest_hit(rays)
    with subprocess.Popen([given.program, *paths, str(threads)], text=True, bufsize=1,
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE) as program:
        assert program.stdin is not None and program.stdout is not None
        for _ in range(1 + given.times):  # the first warms up
            for arrays in ("new", "same"):
                program.stdin.write(arrays + "\n")
                took, worked = program.stdout.readline().split()
                times.setdefault((arrays, "C++"), []).append((float(took), float(worked)))
                forget_peak()
                before = resident("VmRSS")
                start, work = time.perf_counter(), time.process_time()
                hits = scene.closest_hit(rays, threads=threads,
                                         out=same if arrays == "same" else None)
                spent = time.perf_counter() - start, time.process_time() - work
                times.setdefault((arrays, "Python"), []).append(spent)
                output = sum(column.nbytes for column in hits._columns.values())
                extra.append(resident("VmHWM") - before - (0 if hits is same else output))
                del hits
        program.stdin.close()
    print(f"{kind}, {len(rays)} rays, {threads} threads: memory beside the answers "
          f"{max(*extra, 0) / 2**20:.0f} MiB")
    for arrays in ("new", "same"):
        for which, name in enumerate(("time", "processor time")):
            there, here = (statistics.median(pair[which] for pair in times[arrays, side][1:])
                           for side in ("C++", "Python"))
            print(f"  {arrays:4} arrays, {name:14}: C++ {there:.3f} s, Python {here:.3f} s, "
                  f"{100 * (here / there - 1):+.1f} %", flush=True)


if __name__ == "__main__":
    main()
