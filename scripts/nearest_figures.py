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
import json
import pathlib
import subprocess
import sys
import tempfile

from figures import arguments, nanoseconds, open3d_asker, print_row, read_obj, write_ply
import numpy as np

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


def closest_triangles(scene, points):
    found = scene.compute_closest_points(points, nthreads=1)
    return found["primitive_ids"].numpy().astype(np.uint32)


def main():
    options = arguments(__doc__, "bench_nearest")
    vertices, faces = read_obj(options.mesh)
    closest = open3d_asker(vertices, faces, closest_triangles)
    print_row(["points", "number", "pierce, ns", "CGAL, ns", "Open3D, ns", "CGAL wrong",
               "Open3D wrong"])
    print_row(["---"] * 7)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        write_ply(folder / "mesh.ply", vertices, faces)
        for name, points in point_sets(vertices, faces).items():
            np.save(folder / "points.npy", points)
            command = [options.bench_nearest, folder / "mesh.ply", folder / "points.npy"]
            times = []
            if closest is not None:
                times, triangles = closest(points)
                triangles.tofile(folder / "triangles")
                command.append(folder / "triangles")
            run = subprocess.run(command, capture_output=True, text=True, check=False)
            if run.returncode != 0:
                sys.exit(run.stderr)
            figure = json.loads(run.stdout)
            print_row([name, f"{len(points):,}", nanoseconds(figure["pierce"], len(points)),
                       nanoseconds(figure["cgal"], figure["part"]),
                       nanoseconds(times, len(points)) if times else "-",
                       f"{figure['cgal_wrong']:,} of {figure['part']:,}",
                       f"{figure['other_wrong']:,} of {len(points):,}" if times else "-"])


if __name__ == "__main__":
    main()
