#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Speed and wrong answers of nearest points on the Stanford bunny: pierce, CGAL, Open3D.

    ninja -C build/release bench_nearest
    scripts/nearest_figures.py build/release/bench/bench_nearest

Prints a table in Markdown. One thread each, processor time, the same float vertices and points for
all. CGAL is AABB_tree::closest_point_and_primitive over exact predicates and inexact constructions,
Open3D is RaycastingScene.compute_closest_points of Debian's python3-open3d; if that is not there,
it is left out. An answer is wrong if its triangle is not one of the nearest, decided exactly.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

from inside_figures import read_obj, write_ply  # noqa: E402

ROUNDS = 5
POINTS = 100_000


def point_sets(vertices, faces):
    rng = np.random.default_rng(1)
    low, high = vertices.min(0), vertices.max(0)
    middles = vertices[faces].astype(float).mean(1)
    near = middles[rng.integers(len(middles), size=POINTS)]
    far = (low + high) / 2 + rng.normal(size=(POINTS, 3)) * 5 * (high - low).max()
    sets = {"random in the box": rng.uniform(low, high, (POINTS, 3)),
            "near the surface (1/1000 of the size)":
                near + rng.normal(size=near.shape) * (high - low).max() / 1000,
            "vertices": vertices[np.unique(faces)],
            "outside, some 5 sizes away": far}
    return {name: points.astype(np.float32) for name, points in sets.items()}


def open3d_closest(vertices, faces):
    """A function from points to seconds and triangles; None without Open3D."""
    try:
        import open3d
    except (ImportError, OSError):
        return None
    scene = open3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(open3d.core.Tensor(vertices), open3d.core.Tensor(faces))

    def closest(points):
        tensor = open3d.core.Tensor(points)
        start = time.process_time()
        found = scene.compute_closest_points(tensor, nthreads=1)
        return time.process_time() - start, found["primitive_ids"].numpy().astype(np.uint32)

    return closest


def nanoseconds(seconds, points):
    return f"{statistics.median(seconds) / points * 1e9:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("bench_nearest", type=pathlib.Path)
    parser.add_argument("--mesh", type=pathlib.Path,
                        default=pathlib.Path("/usr/share/glmark2/models/bunny.obj"))
    options = parser.parse_args()
    vertices, faces = read_obj(options.mesh)
    closest = open3d_closest(vertices, faces)
    print("| points | number | pierce, ns | CGAL, ns | Open3D, ns | CGAL wrong | Open3D wrong |")
    print("| --- " * 7 + "|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_ply(folder / "mesh.ply", vertices, faces)
        for name, points in point_sets(vertices, faces).items():
            np.save(folder / "points.npy", points)
            command = [options.bench_nearest, folder / "mesh.ply", folder / "points.npy"]
            times = []
            if closest is not None:
                times, triangles = zip(*(closest(points) for _ in range(ROUNDS)))
                triangles[0].tofile(folder / "triangles")
                command.append(folder / "triangles")
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            if run.returncode != 0:
                sys.exit(run.stderr)
            figure = json.loads(run.stdout)
            print(f"| {name} | {len(points):,} | {nanoseconds(figure['pierce'], len(points))} "
                  f"| {nanoseconds(figure['cgal'], figure['part'])} "
                  f"| {nanoseconds(times, len(points)) if times else '-'} "
                  f"| {figure['cgal_wrong']:,} of {figure['part']:,} "
                  f"| {figure['other_wrong']:,} of {len(points):,} |", flush=True)


if __name__ == "__main__":
    main()
