#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds pierce.wasm against the native command on the hard meshes of scripts/same_bytes.py.

usage: same_bytes.py TOOL PACKAGE_DIST [--rays N] [--chromium WEB]

Exit status 1 if a byte differs.

In node; with --chromium in Debian's Chromium, WEB being the folder web/ after npm ci.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent.parent.parent / "scripts"))
import same_bytes  # noqa: E402

# What the package calls the columns of the command's tables.
COLUMNS = {"signed_count": "signedCount", "origin_on_surface": "originOnSurface"}


def asked(closed):
    return [(words, data) for words, data in same_bytes.asked(closed) if words[0] != "voxelise"]


def columns(words, answer, rays):
    """The native answer as the package gives it: name -> array."""
    if answer.dtype.names is None:
        return {"": answer}
    table = {COLUMNS.get(name, name): answer[name] for name in answer.dtype.names}
    if "x" in table:
        point = np.stack([table.pop(axis) for axis in "xyz"], 1).ravel()
        return {"": table["distance"]} if "--signed" in words else {"point": point} | table
    if "ray" in table:
        counts = np.bincount(table.pop("ray").astype(int), minlength=rays)
        table["offsets"] = np.concatenate([[0], np.cumsum(counts)]).astype("<u4")
    return table


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("tool", type=pathlib.Path)
    parser.add_argument("package", type=pathlib.Path)
    parser.add_argument("--rays", type=int, default=2000)
    parser.add_argument("--chromium", type=pathlib.Path, metavar="WEB")
    options = parser.parse_args()
    tool, random = options.tool.resolve(), np.random.default_rng(1)
    cases, native = [], []
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for name, vertices, faces, closed in same_bytes.meshes(random):
            rays = same_bytes.hard_rays(random, vertices, faces, options.rays)
            points = same_bytes.hard_points(random, vertices, faces, options.rays)
            for kind in ("f4", "f8"):
                stem = f"{name}_{kind}"
                same_bytes.write_ply(folder / "mesh.ply", vertices, faces, kind)
                ends = np.tile([0, np.inf], (len(rays), 1))
                for part, numbers in (("vertices", vertices), ("points", points),
                                      ("rays", np.hstack([rays, ends]))):
                    (folder / f"{stem}.{part}").write_bytes(numbers.astype("<" + kind).tobytes())
                (folder / f"{stem}.triangles").write_bytes(faces.astype("<u4").tobytes())
                np.save(folder / "rays.npy", rays.astype("<" + kind))
                np.save(folder / "points.npy", points.astype("<" + kind))
                for words, data in asked(closed):
                    subprocess.run([tool, words[0], "mesh.ply", *words[1:], f"--{data}",
                                    f"{data}.npy", "--out", "answer.npy", "--quiet"],
                                   cwd=folder, check=True)
                    native.append(columns(words, np.load(folder / "answer.npy"), len(rays)))
                    cases.append({"stem": stem, "words": words, "out": f"answer{len(cases)}"})
        (folder / "cases.json").write_text(json.dumps(cases))
        web = [] if options.chromium is None else [options.chromium.resolve()]
        script = HERE / ("answer_chromium.mjs" if web else "answer.mjs")
        subprocess.run(["node", script, options.package.resolve(), folder, *web], check=True)
        different = numbers = 0
        for case, expected in zip(cases, native):
            for column, values in expected.items():
                got = (folder / f"{case['out']}.{column}").read_bytes()
                numbers += len(values)
                if got != np.ascontiguousarray(values).tobytes():
                    different += 1
                    print(f"different: {case['stem']} {' '.join(case['words'])} {column}")
    print(f"{len(cases)} answers, {numbers} numbers compared with the native ones, "
          f"{different} columns differ")
    return 1 if different or not numbers else 0


if __name__ == "__main__":
    sys.exit(main())
