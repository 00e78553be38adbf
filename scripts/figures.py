# SPDX-License-Identifier: Apache-2.0
"""What inside_figures.py and nearest_figures.py share: the mesh, Open3D beside us, and times."""
import argparse
import os
import pathlib
import statistics
import time

os.environ["OMP_NUM_THREADS"] = "1"
import numpy as np  # noqa: E402

ROUNDS = 5


def arguments(page, program):
    """The parsed command line of a script with that docstring: `program` and --mesh."""
    parser = argparse.ArgumentParser(description=page.split("\n", maxsplit=1)[0])
    parser.add_argument(program, type=pathlib.Path)
    parser.add_argument("--mesh", type=pathlib.Path,
                        default=pathlib.Path("/usr/share/glmark2/models/bunny.obj"))
    return parser.parse_args()


def read_obj(path):
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return np.array(vertices, np.float32), np.array(faces, np.uint32)


def write_ply(path, vertices, faces):
    header = ("ply\nformat binary_little_endian 1.0\n"
              f"element vertex {len(vertices)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(faces)}\n"
              "property list uchar uint vertex_indices\nend_header\n")
    table = np.zeros(len(faces), [("n", "u1"), ("i", "<u4", 3)])
    table["n"] = 3
    table["i"] = faces
    path.write_bytes(header.encode() + vertices.tobytes() + table.tobytes())


def open3d_asker(vertices, faces, ask):
    """From points to seconds of processor time, a list, and what ask(scene, points) says of them.

    None without Open3D.
    """
    try:
        import open3d
    except (ImportError, OSError):
        return None
    scene = open3d.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(open3d.core.Tensor(vertices), open3d.core.Tensor(faces))

    def asker(points):
        tensor = open3d.core.Tensor(points)
        times = []
        for _ in range(ROUNDS):
            start = time.process_time()
            answers = ask(scene, tensor)
            times.append(time.process_time() - start)
        return times, answers

    return asker


def nanoseconds(seconds, points):
    """A table's cell: the median of the seconds that so many points took."""
    return f"{statistics.median(seconds) / points * 1e9:.0f}"


def print_row(cells):
    print("| " + " | ".join(cells) + " |", flush=True)
