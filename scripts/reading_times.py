#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How long meshes of a million triangles take to read: pierce, trimesh, meshio and Open3D, in
seconds of processor time, the best of three. Makes the files, and prints the table of
docs/real_files.md.

  python3 -m venv env && env/bin/pip install . trimesh==5.2.0 meshio open3d==0.20.0 networkx lxml
  env/bin/python scripts/reading_times.py FOLDER
"""

import importlib
import pathlib
import subprocess
import sys
import time

import numpy as np

FILES = {
    "STL, binary": "binary.stl", "STL, text": "text.stl", "PLY, binary": "binary.ply",
    "PLY, text": "text.ply", "OBJ, positions": "plain.obj",
    "OBJ, with normals and texture": "full.obj", "OFF": "m.off", "glTF, binary": "m.glb",
    "glTF, data within": "m.gltf", "3MF": "m.3mf"}


def read_with(reader, path):
    """A function that reads the file; what it gives has vertices and triangles."""
    if reader == "pierce":
        core = importlib.import_module("pierce._core")  # what Scene(path) calls before it builds
        return lambda: core.read_mesh(path.encode())
    module = importlib.import_module(reader)
    if reader == "trimesh":
        return lambda: module.load(path, process=False, force="mesh")
    if reader == "meshio":
        return lambda: module.read(path)
    def open3d():
        mesh = module.io.read_triangle_mesh(path)
        if not mesh.has_triangles():
            raise ValueError("not read")
    return open3d


def measure(reader, path):
    """In this process; prints the seconds."""
    read, best = read_with(reader, path), float("inf")
    for _ in range(3):
        start = time.process_time()
        read()
        best = min(best, time.process_time() - start)
    print(f"seconds {best:.2f}")


def make(folder):
    """A bumpy torus of 1,036,800 triangles."""
    trimesh, open3d = importlib.import_module("trimesh"), importlib.import_module("open3d")
    n = 720
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    a, b = 2 * np.pi * i / n, 2 * np.pi * j / n
    r = 1 + 0.3 * np.cos(b) + 0.02 * np.sin(17 * a) * np.cos(9 * b)
    points = np.stack([r * np.cos(a), r * np.sin(a), 0.3 * np.sin(b)], -1)
    points = points.reshape(-1, 3).astype(np.float32)
    corner = lambda x, y: ((x % n) * n + y % n).ravel()
    here, there = corner(i, j), corner(i + 1, j + 1)
    triangles = np.concatenate([np.stack([here, corner(i + 1, j), there], -1),
                                np.stack([here, there, corner(i, j + 1)], -1)])
    mesh = trimesh.Trimesh(points, triangles, process=False)
    for name, wishes in {"binary.stl": {}, "text.stl": {"file_type": "stl_ascii"},
                         "binary.ply": {}, "text.ply": {"encoding": "ascii"}, "m.off": {},
                         "m.glb": {}, "m.3mf": {}, "plain.obj": {"include_normals": False}}.items():
        mesh.export(folder / name, **wishes)
    with (folder / "full.obj").open("w") as out:
        np.savetxt(out, points, "v %.6f %.6f %.6f")
        np.savetxt(out, np.stack([i.ravel(), j.ravel()], -1) / n, "vt %.6f %.6f")
        np.savetxt(out, mesh.vertex_normals, "vn %.4f %.4f %.4f")
        np.savetxt(out, np.repeat(triangles + 1, 3, axis=1), "f" + " %d/%d/%d" * 3)
    open3d.io.write_triangle_mesh(str(folder / "m.gltf"), open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(points.astype(float)),
        open3d.utility.Vector3iVector(triangles.astype(np.int32))))


def main():
    if len(sys.argv) == 4 and sys.argv[1] == "--one":
        measure(sys.argv[2], sys.argv[3])
        return
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "m.gltf").exists():
        make(folder)
    readers = ["pierce", "trimesh", "meshio", "open3d"]
    print("| | MB | " + " | ".join(readers) + " |")
    print("| --- " * (2 + len(readers)) + "|")
    for title, name in FILES.items():
        path = folder / name
        cells = []
        for reader in readers:
            done = subprocess.run([sys.executable, __file__, "--one", reader, str(path)],
                                  capture_output=True, text=True, check=False)
            told = [line for line in done.stdout.splitlines() if line.startswith("seconds ")]
            cells.append(told[0].split()[1] if told else "")
        print(f"| {title} | {path.stat().st_size / 1e6:.0f} | " + " | ".join(cells) + " |",
              flush=True)


if __name__ == "__main__":
    main()
