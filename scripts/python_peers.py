#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the tables of docs/python.md: pierce beside other Python packages, same mesh, same rays.

Answers are compared first, all that differ are judged by exact arithmetic (scripts/peers_truth.py),
and wrong ones are counted. Each package runs in a process of its own, held to two cores, then to
one; a task that would take longer than a second is given fewer rays or points. The figure is the
best of up to 15 runs within three seconds, from arrays to arrays. Ten minutes.

usage: python_peers.py [--write] [--quick]     run it by the Python of an environment made so:
  python3 -m venv build/peers && build/peers/bin/pip install . open3d embreex trimesh rtree scipy \\
    point-cloud-utils libigl fcpw warp-lang
What is not installed is left out, and said. --write puts the tables into docs/python.md; --quick
tries the script on a twentieth of the work.
"""

import argparse
import datetime
import importlib.metadata
import json
import os
import pathlib
import platform
import re
import resource
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "python.md"
BEGIN, END = "<!-- peers: begin (scripts/python_peers.py) -->", "<!-- peers: end -->"
SECONDS = 1.0
# What is asked: task, what it is asked of, the engine's method, heading.
TASKS = [
    ("camera", "camera", "closest", "camera rays"),
    ("incoherent", "incoherent", "closest", "incoherent rays"),
    ("any", "incoherent", "any", "any hit"),
    ("all", "incoherent", "all", "all hits"),
    ("inside", "points", "inside", "inside"),
    ("nearest", "points", "nearest", "nearest"),
    ("signed", "points", "signed", "signed distance"),
    ("hard", "hard", "closest", None),
    ("beside", "beside", "inside", None),
]
ALONE = ["pierce", "Open3D", "embreex"]  # asked with one core as well


def make_work(folder, part=1):
    import numpy as np

    sys.path.insert(0, str(ROOT / "examples" / "python"))
    import meshes
    import pierce

    vertices, triangles = meshes.knot(along=1500 // part, around=128)
    vertices = vertices.astype(np.float32)
    random = np.random.default_rng(1)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    camera = pierce.rays.pinhole(1024 // part, 768, fov=50, center=(0, 0, 0), eye=(3, -6.5, 4),
                                 up=(0, 0, -1), dtype=np.float32).reshape(-1, 6)
    count = 500_000 // part
    origins = random.uniform(low - 0.5, high + 0.5, (count, 3)).astype(np.float32)
    directions = random.standard_normal((count, 3)).astype(np.float32)
    points = random.uniform(low - 0.2, high + 0.2, (count, 3)).astype(np.float32)
    # Hard: from inside, at vertices and the middles of edges; and points beside those.
    inside = points[pierce.Scene(vertices, triangles).locate(points) > 0]
    marks = np.concatenate([vertices, vertices[triangles[:, :2]].mean(axis=1)])
    aims = marks[random.integers(0, len(marks), 100_000 // part)]
    starts = inside[random.integers(0, len(inside), len(aims))]
    moves = 10.0 ** random.uniform(-8, -4, (len(aims), 1)) * random.standard_normal((len(aims), 3))
    work = {"vertices": vertices, "triangles": triangles, "camera": camera,
            "incoherent": np.concatenate([origins, directions], axis=1), "points": points,
            "hard": np.concatenate([starts, aims - starts], axis=1).astype(np.float32),
            "beside": (aims + moves).astype(np.float32)}
    for name, array in work.items():
        np.save(folder / f"{name}.npy", np.ascontiguousarray(array))


def arguments(engine, array):
    """The array as the engine's method takes it."""
    given = (array[:, :3].copy(), array[:, 3:].copy()) if array.shape[1] == 6 else (array,)
    return engine.prepare(*given) if hasattr(engine, "prepare") else given


def ask(engine, call, rows, allowed):
    """Asks as many rows as the time allows, but for what every call costs; the best of some."""
    def timed(size):
        nonlocal worked
        given = arguments(engine, rows[:size])
        start, work = time.perf_counter(), time.process_time()
        answer = call(*given)
        worked = min(worked, (time.process_time() - work) / size)
        return time.perf_counter() - start, answer

    worked = 1e9
    size, (before, _) = 60, timed(20)
    seconds, answer = timed(size)
    last = 20
    while size < len(rows):
        each = max((seconds - before) / (size - last), 1e-9)
        every_call = max(seconds - each * size, 0)
        wanted = min(int(max(allowed, every_call) / each), 20 * size, len(rows))
        if wanted < min(1.5 * size, len(rows)):
            break
        last, before, size, worked = size, seconds, wanted, 1e9
        seconds, answer = timed(size)
    spent = seconds
    while spent < 3 * SECONDS:
        again, _ = timed(size)
        seconds, spent = min(seconds, again), spent + max(again, 0.2 * SECONDS)
    return seconds, worked * size, size, answer


def child(name, cores, folder):
    os.sched_setaffinity(0, set(sorted(os.sched_getaffinity(0))[:cores]))
    import numpy as np

    import peers_engines

    work = {path.stem: np.load(path) for path in folder.glob("*.npy")}
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    engine = peers_engines.ENGINES[name](work["vertices"], work["triangles"])
    found = {"build": time.perf_counter() - start, "tasks": {}}
    answers = {}
    for task, data, method, _ in TASKS:
        call = getattr(engine, method, None)
        if call is None:
            continue
        rows = work[data] if task != "all" else work[data][:100_000]
        call(*arguments(engine, rows[:20]))  # what is made at the first call is made
        allowed = 1e9 if name == "pierce" else SECONDS
        seconds, worked, size, answer = ask(engine, call, rows, allowed)
        found["tasks"][task] = {"size": size, "seconds": worked if cores == 1 else seconds}
        parts = answer if isinstance(answer, tuple) else (answer,)
        answers.update({f"{task}.{i}": np.asarray(part) for i, part in enumerate(parts)})
    found["memory"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    np.savez(folder / f"{name}.{cores}.npz", **answers)
    print(json.dumps(found))


def size_of(distribution, seen):
    """Bytes of a distribution and of all that it needs, NumPy excepted."""
    name = re.sub(r"[-_.]+", "-", distribution).lower()
    if name in seen or name == "numpy":
        return 0
    seen.add(name)
    try:
        found = importlib.metadata.distribution(name)
    except importlib.metadata.PackageNotFoundError:
        return 0
    total = sum(path.stat().st_size for file in found.files or []
                if (path := pathlib.Path(file.locate())).is_file())
    for need in found.requires or []:
        if "extra ==" not in need:
            total += size_of(re.match(r"[\w.-]+", need)[0], seen)
    return total


def judge(folder, names):
    """Of each engine: {kind: (wrong, asked)}; pierce's own are those that anybody refuted."""
    import numpy as np

    from peers_truth import Truth

    work = {path.stem: np.load(path) for path in folder.glob("*.npy")}
    truth = Truth(work["vertices"], work["triangles"],
                  *(work[name] for name in ("camera", "incoherent", "points", "hard", "beside")))
    answers = {name: np.load(folder / f"{name}.2.npz") for name in names}
    mine = answers["pierce"]
    result = {name: {"rays": [0, 0], "inside": [0, 0], "nearest": [0, 0]} for name in names}
    refuted = {"rays": 0, "inside": 0, "nearest": 0}

    def add(name, kind, wrong, asked):
        refuted[kind] += wrong[0]
        result[name][kind][0] += wrong[1]
        result[name][kind][1] += asked

    for name in names[1:]:
        theirs = answers[name]
        for task, data, method, _ in TASKS:
            if f"{task}.0" not in theirs or task == "signed":
                continue
            rows, a, b = work[data], mine[f"{task}.0"], theirs[f"{task}.0"]
            if method == "all":
                n = min(100_000, result_size(folder, name, task))
                lists = [[x[f"{task}.{i}"] for i in (0, 1)] for x in (mine, theirs)]
                lists[0] = [x[lists[0][0] < n] for x in lists[0]]
                add(name, "rays", truth.judge_all(rows[:, :3], rows[:, 3:], *lists, n), n)
                continue
            n = min(len(b), 100_000) if method == "nearest" else len(b)
            a, b = a[:n], b[:n]
            if method == "closest":
                add(name, "rays", truth.judge_closest(rows[:, :3], rows[:, 3:], a, b), n)
            elif method == "any":
                add(name, "rays", truth.judge_any(rows[:, :3], rows[:, 3:], a, b,
                                                  mine["incoherent.0"]), n)
            elif method == "inside":
                add(name, "inside", truth.judge_inside(rows, a, b), n)
            else:
                add(name, "nearest", truth.judge_nearest(rows, a, b), n)
    own_check(truth, work, mine, refuted)
    for kind, wrong in refuted.items():
        tasks = [f"{t}.0" for t, _, m, _ in TASKS if {"inside": "inside", "nearest": "nearest"}.get(
            m, "rays") == kind and t not in ("all", "signed")]
        result["pierce"][kind] = [wrong, sum(len(mine[t]) for t in tasks)]
    return result


def result_size(folder, name, task):
    return json.loads((folder / f"{name}.2.json").read_text())["tasks"][task]["size"]


def own_check(truth, work, mine, refuted):
    """Some of pierce's answers, against all triangles."""
    for task, step in (("camera", 7919), ("incoherent", 7919), ("hard", 997)):
        for i in range(0, len(mine[f"{task}.0"]), step):
            who, _ = truth.closest(work[task][i, :3], work[task][i, 3:])
            refuted["rays"] += int(mine[f"{task}.0"][i] != min(who, default=-1))
    for data, task, step in (("points", "inside", 1999), ("beside", "beside", 499)):
        for i in range(0, len(mine[f"{task}.0"]), step):
            refuted["inside"] += int(bool(mine[f"{task}.0"][i]) != truth.inside(work[data][i]))


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()


def rate(found, task):
    done = found["tasks"].get(task)
    if done is None:
        return ""
    speed = done["size"] / done["seconds"] / 1e6
    return f"{speed:.2f}" if speed >= 0.1 else f"{speed:.4f}" if speed < 0.01 else f"{speed:.3f}"


def table(runs, cores):
    heads = [head for *_, head in TASKS if head]
    lines = [f"| {cores} cores | " .replace("1 cores", "one core").replace("2 cores", "two cores")
             + " | ".join(heads) + " |", "| --- |" + " ---: |" * len(heads)]
    for name, found in runs.items():
        rates = [rate(found, task) for task, *_, head in TASKS if head]
        best = [max((float(rate(other, task) or 0) for other in runs.values()))
                for task, *_, head in TASKS if head]
        cells = [f"**{r}**" if r and float(r) == b else r for r, b in zip(rates, best)]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def version_of(engine):
    try:
        return importlib.metadata.version(engine.distribution)
    except importlib.metadata.PackageNotFoundError:
        return None


def text(runs, alone, wrong, sizes, versions):
    from pierce import _core

    words = [f"{processor()}, kernel {_core.kernel()}, {datetime.date.today()}. Millions of rays, "
             "or of points, a second, from arrays of float32 to arrays; the fastest of each column "
             "in bold; empty: no such query for arrays. A closed mesh of 384,000 triangles.",
             table(runs, 2),
             "embreex uses one core whatever it is given; so, on one, a second of processor "
             "time:", table(alone, 1),
             "Wrong answers of these and of 100,000 hard rays and points (from inside at vertices "
             "and edges; beside them), as exact arithmetic judges all that differ; memory is what "
             "the process needs beyond the rays and points; size is what pip installs beside "
             "NumPy."]
    lines = ["| package | rays wrong | inside wrong | nearest wrong | memory, MB | size, MB |",
             "| --- | ---: | ---: | ---: | ---: | ---: |"]
    for name, found in runs.items():
        cells = [f"{w:,} of {n:,}" if n else "" for w, n in wrong[name].values()]
        lines.append(f"| {name} ({versions[name]}) | " + " | ".join(cells)
                     + f" | {found['memory'] / 1024:.0f} | {sizes[name] / 1e6:.1f} |")
    return "\n\n".join([*words, "\n".join(lines)])


def run_child(name, cores, folder):
    start = time.perf_counter()
    command = [sys.executable, str(pathlib.Path(__file__).resolve()), "--child", name,
               "--cores", str(cores), "--folder", str(folder)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        print(f"{name}: left out: {(run.stderr.strip().splitlines() or ['?'])[-1]}")
        return None
    line = run.stdout.strip().splitlines()[-1]
    (folder / f"{name}.{cores}.json").write_text(line)
    print(f"{name}, {cores} cores: {time.perf_counter() - start:.0f} s", flush=True)
    return json.loads(line)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--child", help=argparse.SUPPRESS)
    parser.add_argument("--cores", type=int, default=2, help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=pathlib.Path, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.write and options.quick:
        parser.error("--quick is too little for the page")
    if options.child:
        child(options.child, options.cores, options.folder)
        return
    from peers_engines import ENGINES

    with tempfile.TemporaryDirectory() as name:
        folder = options.folder or pathlib.Path(name)
        make_work(folder, 20 if options.quick else 1)
        versions = {name: version_of(engine) for name, engine in ENGINES.items()}
        runs = {name: found for name in ENGINES if versions[name]
                and (found := run_child(name, 2, folder)) is not None}
        alone = {name: found for name in ALONE if name in runs
                 and (found := run_child(name, 1, folder)) is not None}
        wrong = judge(folder, list(runs))
    sizes = {name: size_of(ENGINES[name].distribution, seen := set())
             + sum(size_of(more, seen) for more in getattr(ENGINES[name], "also", ()))
             for name in runs}
    page = text(runs, alone, wrong, sizes, versions)
    print(page)
    if options.write:
        old = PAGE.read_text()
        before, after = old.split(BEGIN)[0], old.split(END)[1]
        PAGE.write_text(f"{before}{BEGIN}\n\n{page}\n\n{END}{after}")


if __name__ == "__main__":
    main()
