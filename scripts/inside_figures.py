#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Speed and wrong answers of point location on the Stanford bunny: pierce, CGAL, Open3D.

    ninja -C build/release bench_inside open3d_ray_mask
    scripts/inside_figures.py build/release/bench/bench_inside

Prints a table in Markdown; docs/decisions/0008-inside.md holds one. Nanoseconds of processor time,
one thread each, the same float vertices and points for all. CGAL is Side_of_triangle_mesh over
exact predicates. Open3D is RaycastingScene.compute_occupancy of Debian's python3-open3d, version
0.16, which takes one vote; bench/inside/open3d_ray_mask.cpp says what it takes to make that package
work. If it is not there, it is left out. An answer is wrong if it differs from pierce's, which the
tests hold against rational arithmetic. Open3D knows no surface, so points exactly on it are not
held against it.
"""
import ctypes
import json
import pathlib
import subprocess
import sys
import tempfile

from figures import arguments, nanoseconds, open3d_asker, print_row, read_obj, write_ply
import numpy as np


def point_sets(vertices, faces):
    rng = np.random.default_rng(1)
    low, high = vertices.min(0), vertices.max(0)
    random = rng.uniform(low, high, (1_000_000, 3)).astype(np.float32)
    used = vertices[np.unique(faces)]
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]],
                                              faces[:, [2, 0]]]), axis=1), axis=0)
    middles = (vertices[edges].astype(float).sum(1) / 2).astype(np.float32)
    level = np.stack([rng.choice(used[:, axis], 200_000) for axis in range(3)], 1)
    above = used[rng.integers(len(used), size=200_000)].copy()
    above[:, 2] = rng.uniform(low[2], high[2], len(above))
    ahead = used[rng.integers(len(used), size=200_000)].copy()
    ahead[:, 0] = rng.uniform(low[0], high[0], len(ahead))
    return {"random in the box": random, "vertices": used, "edge midpoints, rounded": middles,
            "level with vertices in x, y and z": level, "above and below vertices": above,
            "level with a vertex along x": ahead}


def open3d_locate(vertices, faces, ray_mask):
    """See open3d_asker: whether points are inside."""
    try:
        ctypes.CDLL(ray_mask, ctypes.RTLD_GLOBAL)
    except OSError:
        return None
    locate = open3d_asker(vertices, faces, lambda scene, points:
                          scene.compute_occupancy(points, nthreads=1).numpy() != 0)
    if locate is not None and not locate(vertices.mean(0, keepdims=True))[1].all():
        print("Open3D does not find the middle of the bunny inside", file=sys.stderr)
    return locate


def main():
    options = arguments(__doc__, "bench_inside")
    vertices, faces = read_obj(options.mesh)
    sets = point_sets(vertices, faces)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_ply(folder / "mesh.ply", vertices, faces)
        for number, points in enumerate(sets.values()):
            np.save(folder / f"{number}.npy", points)
        run = subprocess.run([options.bench_inside, folder / "mesh.ply", folder / "out",
                              *(folder / f"{number}.npy" for number in range(len(sets)))],
                             capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(run.stderr)
        figures = [json.loads(line) for line in run.stdout.splitlines()]
        answers = np.fromfile(folder / "out", np.int8)
    locate = open3d_locate(vertices, faces,
                           options.bench_inside.resolve().parent / "libopen3d_ray_mask.so")
    print_row(["points", "number", "on the surface", "pierce batch, ns", "pierce single, ns",
               "CGAL, ns", "Open3D, ns", "CGAL wrong", "Open3D wrong"])
    print_row(["---"] * 9)
    for (name, points), figure in zip(sets.items(), figures):
        truth, answers = answers[:len(points)], answers[len(points):]
        row = [name, f"{len(points):,}", f"{np.sum(truth == 0):,}",
               nanoseconds(figure["batch"], figure["points"]),
               nanoseconds(figure["single"], figure["part"]),
               nanoseconds(figure["cgal"], figure["part"])]
        if locate is None:
            row += ["-", f"{figure['differences']} of {figure['part']:,}", "-"]
        else:
            times, inside = locate(points)
            wrong = np.sum((inside != (truth > 0)) & (truth != 0))
            row += [nanoseconds(times, len(points)),
                    f"{figure['differences']} of {figure['part']:,}",
                    f"{wrong:,} of {np.sum(truth != 0):,}"]
        print_row(row)


if __name__ == "__main__":
    main()
