#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the table of docs/coming_from.md: each stand-in beside its original, the same calls.

Both are asked in one process, in turns, and the better of the runs counts: on one core, then on
two. All answers that differ are judged by exact arithmetic that is not pierce's
(scripts/peers_truth.py), also those of hard rays (at vertices and edges) and hard points (beside
them), and the wrong ones of each are counted. A call that would take longer than a second is given
fewer rays or points. Five minutes.

usage: stand_in_speed.py [--write] [--quick]     by the Python of an environment made so:
  python3 -m venv build/peers && build/peers/bin/pip install . open3d trimesh embreex rtree scipy \\
    pyvista
What is not installed is left out. --write puts the table into the page; --quick tries the script on
a twentieth of the work.
"""

import argparse
import datetime
import importlib.metadata
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "coming_from.md"
BEGIN, END = "<!-- speed: begin (scripts/stand_in_speed.py) -->", "<!-- speed: end -->"


class Trimesh:
    """What people have: trimesh with embreex."""

    packages = ("trimesh", "embreex")
    calls = {"intersects_first": "closest", "intersects_any": "any", "intersects_location": "all",
             "contains_points": "inside", "closest_point": "nearest", "signed_distance": None}

    def __init__(self, stand_in, vertices, triangles):
        import pierce.trimesh
        import trimesh

        self.mesh = trimesh.Trimesh(vertices, triangles, process=False)
        module = pierce.trimesh if stand_in else trimesh.ray.ray_pyembree
        self.mesh.ray = self.engine = module.RayMeshIntersector(self.mesh)
        self.near = pierce.trimesh if stand_in else trimesh.proximity

    def intersects_first(self, o, d):
        return self.engine.intersects_first(o, d)

    def intersects_any(self, o, d):
        return self.engine.intersects_any(o, d)

    def intersects_location(self, o, d):
        return self.engine.intersects_location(o, d)[1:]

    def contains_points(self, p):
        return self.engine.contains_points(p)

    def closest_point(self, p):
        return self.near.closest_point(self.mesh, p)[2]

    def signed_distance(self, p):
        return self.near.signed_distance(self.mesh, p)


class Open3D:
    packages = ("open3d",)
    calls = {"cast_rays": "closest", "test_occlusions": "any", "list_intersections": "all",
             "count_intersections": None, "compute_occupancy": "inside",
             "compute_closest_points": "nearest", "compute_signed_distance": None}

    def __init__(self, stand_in, vertices, triangles):
        import open3d
        import pierce.open3d

        module = pierce.open3d if stand_in else open3d.t.geometry
        self.scene = module.RaycastingScene()
        self.scene.add_triangles(vertices, triangles.astype(np.uint32))

    @staticmethod
    def signed(ids):
        return ids.numpy().astype(np.int32).astype(np.int64)

    def cast_rays(self, rays):
        return self.signed(self.scene.cast_rays(rays)["primitive_ids"])

    def test_occlusions(self, rays):
        return self.scene.test_occlusions(rays).numpy()

    def list_intersections(self, rays):
        found = self.scene.list_intersections(rays)
        return found["ray_ids"].numpy(), found["primitive_ids"].numpy()

    def count_intersections(self, rays):
        return self.scene.count_intersections(rays).numpy()

    def compute_occupancy(self, points):
        return self.scene.compute_occupancy(points).numpy() > 0

    def compute_closest_points(self, points):
        return self.signed(self.scene.compute_closest_points(points)["primitive_ids"])

    def compute_signed_distance(self, points):
        return self.scene.compute_signed_distance(points).numpy()


class Pyvista:
    """multi_ray_trace there is trimesh with embreex, built anew in every call."""

    packages = ("pyvista", "trimesh", "embreex")
    calls = {"multi_ray_trace": "all", "select_interior_points": "inside",
             "implicit_distance": None}

    def __init__(self, stand_in, vertices, triangles):
        import pyvista

        self.pyvista = pyvista
        self.mesh = pyvista.PolyData.from_regular_faces(vertices, triangles)
        self.stand_in = stand_in

    def multi_ray_trace(self, o, d):
        asked = self.mesh.pierce if self.stand_in else self.mesh
        return asked.multi_ray_trace(o, d)[1:]

    def select_interior_points(self, p):
        cloud = self.pyvista.PolyData(p)
        asked = cloud.pierce if self.stand_in else cloud
        return np.asarray(asked.select_interior_points(self.mesh)["selected_points"])

    def implicit_distance(self, p):
        cloud = self.pyvista.PolyData(p)
        asked = cloud.pierce if self.stand_in else cloud
        return np.asarray(asked.compute_implicit_distance(self.mesh)["implicit_distance"])


class Embreex:
    packages = ("embreex",)
    calls = {"run": "closest", "run OCCLUDED": "any", "run output=True": "closest"}

    def __init__(self, stand_in, vertices, triangles):
        import embreex.mesh_construction
        import embreex.rtcore_scene
        import pierce.embreex

        module = pierce.embreex if stand_in else embreex
        self.scene = module.rtcore_scene.EmbreeScene()
        self.mesh = module.mesh_construction.TriangleMesh(self.scene, vertices, triangles)

    def run(self, o, d):
        return self.scene.run(o, d)

    def run_OCCLUDED(self, o, d):
        return self.scene.run(o, d, query="OCCLUDED") >= 0

    def run_output(self, o, d):
        return self.scene.run(o, d, output=True)["primID"]


PAIRS = {"trimesh": Trimesh, "Open3D": Open3D, "pyvista": Pyvista, "embreex": Embreex}
# What is asked for each kind of answer: first what is timed, then what is hard.
ASKED = {"closest": ("incoherent", "hard"), "any": ("incoherent",), "all": ("incoherent",),
         "inside": ("points", "beside"), "nearest": ("points",)}


def method_of(pair, call):
    return getattr(pair, call.replace(" ", "_").partition("=")[0])


def data_of(kind, call):
    points = any(word in call for word in ("distance", "points", "occupancy", "closest_point"))
    return ASKED.get(kind, ("points",) if points else ("incoherent",))


def child(name, cores, folder):
    os.sched_setaffinity(0, set(sorted(os.sched_getaffinity(0))[:cores]))
    from python_peers import ask

    work = {path.stem: np.load(path) for path in folder.glob("*.npy")}
    pair = PAIRS[name]
    both = [pair(stand_in, work["vertices"], work["triangles"]) for stand_in in (False, True)]
    if name == "Open3D":  # rays as it has them, in one array
        for one in both:
            one.prepare = lambda *parts: (np.ascontiguousarray(np.concatenate(parts, axis=1)),)
    found, answers = {}, {}
    for call, kind in pair.calls.items():
        for data in data_of(kind, call):
            rates = [0.0, 0.0]
            for _ in range(2):
                for which, one in enumerate(both):
                    seconds, size, answer = ask(one, method_of(one, call), work[data], 1.0)
                    if size / seconds > rates[which]:
                        rates[which] = size / seconds
                        parts = answer if isinstance(answer, tuple) else (answer,)
                        key = f"{call}.{data}.{which}"
                        answers.update({f"{key}.{i}": np.asarray(x) for i, x in enumerate(parts)})
                        answers[f"{key}.size"] = np.array(size)
            found[f"{call}.{data}"] = rates
    np.savez(folder / f"{name}.npz", **answers)
    print(json.dumps(found))


def judge(name, folder, truth, work):
    """Of each call: wrong answers of the original, of the stand-in, and how many were compared."""
    answers = np.load(folder / f"{name}.npz")
    result = {}
    for call, kind in PAIRS[name].calls.items():
        if kind is None:
            continue
        wrong, count = np.zeros(2, int), 0
        for data in data_of(kind, call):
            n = min(int(answers[f"{call}.{data}.{which}.size"]) for which in (0, 1))
            n = min(n, 100_000)
            rows = work[data][:n]
            columns = range(2 if kind == "all" else 1)
            parts = [[answers[f"{call}.{data}.{which}.{i}"] for i in columns] for which in (0, 1)]
            if kind == "all":
                lists = [[x[ray < n] for x in (ray, triangle)] for ray, triangle in parts]
                wrong += truth.judge_all(rows[:, :3], rows[:, 3:], *lists, n)
            else:
                a, b = (part[0][:n] for part in parts)
                wrong += {"closest": lambda: truth.judge_closest(rows[:, :3], rows[:, 3:], a, b),
                          "any": lambda: truth.judge_any(rows[:, :3], rows[:, 3:], a, b,
                                                         np.full(n, -1)),
                          "inside": lambda: truth.judge_inside(rows, a, b),
                          "nearest": lambda: truth.judge_nearest(rows, a, b)}[kind]()
            count += n
        result[call] = (*wrong.tolist(), count)
    return result


def figure(rate):
    rate /= 1e6
    return f"{rate:.2f}" if rate >= 0.1 else f"{rate:.4f}" if rate < 0.01 else f"{rate:.3f}"


def table(name, alone, two, wrong):
    versions = ", ".join(f"{p} {importlib.metadata.version(p)}" for p in PAIRS[name].packages)
    lines = [f"| {versions} | one core | pierce | two cores | pierce | wrong | pierce |",
             "| --- |" + " ---: |" * 6]
    for call, kind in PAIRS[name].calls.items():
        key = f"{call}.{data_of(kind, call)[0]}"
        cells = [figure(rate) for rate in (*alone[key], *two[key])]
        if call in wrong:
            theirs, ours, count = wrong[call]
            cells += [f"{theirs:,} of {count:,}", f"{ours:,}"]
        lines.append(f"| `{call}` | " + " | ".join(cells + [""] * (6 - len(cells))) + " |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    parser.add_argument("--cores", type=int, default=2, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=pathlib.Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        child(options.child, options.cores, options.folder)
        return
    from peers_truth import Truth
    from python_peers import make_work, processor

    from pierce import _core

    tables, busy = [], os.getloadavg()[0]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        make_work(folder, 20 if options.quick else 1)
        work = {path.stem: np.load(path) for path in folder.glob("*.npy")}
        truth = Truth(work["vertices"], work["triangles"],
                      *(work[data] for data in ("incoherent", "hard", "points", "beside")))
        for name, pair in PAIRS.items():
            runs = []
            for cores in (1, 2):
                done = subprocess.run(
                    [sys.executable, __file__, "--child", name, "--cores", str(cores), "--folder",
                     folder], capture_output=True, text=True, check=False)
                if done.returncode:
                    print(f"{name}: left out: {(done.stderr.strip().splitlines() or ['?'])[-1]}")
                    break
                runs.append(json.loads(done.stdout.strip().splitlines()[-1]))
            if len(runs) == 2:
                tables.append(table(name, *runs, judge(name, folder, truth, work)))
                print(tables[-1], flush=True)
    text = "\n\n".join([
        f"{processor()}, kernel {_core.kernel()}, {datetime.date.today()}. Millions of rays, or of "
        "points, a second, from arrays to arrays, on a closed mesh of 384,000 triangles. "
        + ("The machine was busy with other work as well (load "
           f"{busy:.0f}): compare within a row." if busy > 1.5 else ""), *tables])
    if options.write:
        page = PAGE.read_text()
        PAGE.write_text(f"{page.split(BEGIN)[0]}{BEGIN}\n\n{text}\n\n{END}{page.split(END)[1]}")


if __name__ == "__main__":
    main()
