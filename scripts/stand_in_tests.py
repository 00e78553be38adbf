#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the tests of trimesh, Open3D, pyvista and embreex with pierce's stand-ins in place.

trimesh's are in its source distribution on PyPI, which is fetched for the installed version; what
they import and their models are not, and scripts/stand_ins/generic.py stands for these. pyvista's
examples, with the output that they promise, are in the docstrings of the installed package.
Open3D's, embreex's and pyvista's tests are only in their repositories: they are fetched from
GitHub, or taken from FOLDER if they are there already; of pyvista's files the tests of rays, of
points inside and of distances, as the rest needs pyvista's own fixtures. All run twice, with the
original and with the stand-in; a test that passes with the first and not with the second is an
error, unless exact arithmetic refutes what it asserts, or it demands the words of an error. Two
minutes.

usage: stand_in_tests.py [FOLDER]         by the Python of an environment made so:
  python3 -m venv build/peers && build/peers/bin/pip install . pytest open3d trimesh embreex \\
    pyvista rtree scipy networkx shapely manifold3d mapbox_earcut
"""

import argparse
import ast
import doctest
import importlib.metadata
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import urllib.error
import urllib.request
from fractions import Fraction

HERE = pathlib.Path(__file__).resolve().parent
TRIMESH = ("test_ray", "test_ray_upstream", "test_proximity", "test_thickness", "test_sample",
           "test_voxel")
GITHUB = "https://raw.githubusercontent.com/"
REPOSITORY_TESTS = {
    "test_raycasting_scene.py": "isl-org/Open3D/00572f0aeb36281179d962b2b4822dd1bc1e6974/"
                                "python/test/t/geometry/test_raycasting_scene.py",
    "open3d_test.py": "isl-org/Open3D/00572f0aeb36281179d962b2b4822dd1bc1e6974/"
                      "python/test/open3d_test.py",
    "test_intersection.py": "trimesh/embreex/11f2102b6688a9ba9c97dff4531f285be98bac32/"
                            "tests/test_intersection.py",
}
# pyvista's files, and how the names of the tests begin that are ours to pass.
PYVISTA_TESTS = {
    "pyvista_test_polydata.py": ("pyvista/pyvista/9771defb33b643edadce5d0f255f1b50cc63be1a/"
                                 "tests/core/test_polydata.py",
                                 ("test_ray_trace", "test_multi_ray_trace")),
    "pyvista_test_dataset_filters.py": ("pyvista/pyvista/097c9a29867ce17ec79ecae789705e93e416110b/"
                                        "tests/core/test_dataset_filters.py",
                                        ("test_select_interior_points", "test_implicit_distance")),
}
# What these take from the rest of pyvista's tests.
PYVISTA_FIXTURES = """
from unittest.mock import patch
import numpy as np
import pytest
import pyvista as pv
from pyvista import examples
from pyvista.core.errors import NotAllTrianglesError

sphere = pytest.fixture(lambda: pv.Sphere(), name="sphere")
plane = pytest.fixture(lambda: pv.Plane(direction=(0, 0, -1)), name="plane")
uniform = pytest.fixture(lambda: examples.load_uniform(), name="uniform")
hexbeam = pytest.fixture(lambda: examples.load_hexbeam(), name="hexbeam")

"""
# Examples of pyvista whose meshes need no download.
PYVISTA = ("ray_trace", "multi_ray_trace", "select_interior_points", "compute_implicit_distance")

CONFTEST = """
import os
if os.environ.get("STAND_IN") == "1":
    import pierce.embreex, pierce.open3d, pierce.pyvista, pierce.trimesh
    pierce.embreex.install()
    for module in (pierce.trimesh, pierce.open3d, pierce.pyvista):
        try:
            module.install()
        except ImportError:
            pass
"""


def nearer_face():
    """The point of that test is nearer to face 0, but it demands the point of face 1."""
    x, z = Fraction(-0.25 - 1e-9), Fraction(-0.25)
    to_face_0 = z * z  # straight up to (x, 0, 0), which is in the triangle
    to_face_1 = x * x  # across to (0, 0, z)
    assert -1 <= x <= 0
    return to_face_0 < to_face_1


def other_words():
    """That test wants an error of the surface, and finds it, but demands pyvista's sentence."""
    import pierce.pyvista
    import pyvista

    surface = pyvista.Sphere(end_theta=270)
    try:
        pierce.pyvista.select_interior_points(surface, surface)
    except RuntimeError as error:
        return "Surface is not closed" in str(error)
    return False


REFUTED = {"test_proximity.py::NearestTest::test_returns_correct_point_in_ambiguous_cases":
           nearer_face}
OTHER_WORDS = {"test_dataset_filters.py::test_select_interior_points": other_words}


def fetch_trimesh(folder):
    version = importlib.metadata.version("trimesh")
    archive = folder / f"trimesh-{version}.tar.gz"
    if not archive.exists():
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps",
                        "--disable-pip-version-check", "--no-binary", ":all:", "--dest", folder,
                        f"trimesh=={version}"], check=True)
    tests = folder / "trimesh"
    tests.mkdir(exist_ok=True)
    with tarfile.open(archive) as tar:
        for name in TRIMESH:
            source = tar.extractfile(f"trimesh-{version}/tests/{name}.py")
            (tests / f"{name}.py").write_bytes(source.read())
    shutil.copy(HERE / "stand_ins" / "generic.py", tests)
    return tests


def fetch_file(folder, name, path):
    """The text of a file of a repository, or None."""
    if (folder / name).exists():
        return (folder / name).read_text()
    try:
        with urllib.request.urlopen(GITHUB + path, timeout=20) as page:
            return page.read().decode()
    except urllib.error.URLError:
        print(f"{name}: GitHub cannot be reached: left out; put it into {folder}")
        return None


def fetch_others(folder):
    tests = folder / "repositories"
    tests.mkdir(exist_ok=True)
    for name, path in REPOSITORY_TESTS.items():
        text = fetch_file(folder, name, path)
        if text is not None:
            (tests / name).write_text(text)
    return tests


def picked(text, beginnings):
    """The tests of a file whose names begin so, as they stand there, and its fixture `sphere`."""
    lines, parts = text.splitlines(), []
    for node in ast.parse(text).body:
        number = isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        if number or isinstance(node, ast.FunctionDef) and (
                node.name == "sphere" or node.name.startswith(beginnings)):
            first = min([node.lineno, *(x.lineno for x in getattr(node, "decorator_list", ()))])
            parts.append("\n".join(lines[first - 1:node.end_lineno]))
    return "\n\n\n".join(parts) + "\n"


def fetch_pyvista(folder):
    tests = folder / "pyvista"
    tests.mkdir(exist_ok=True)
    for name, (path, beginnings) in PYVISTA_TESTS.items():
        text = fetch_file(folder, name, path)
        if text is not None:
            (tests / name.removeprefix("pyvista_")).write_text(
                PYVISTA_FIXTURES + picked(text, beginnings))
    return tests


def run(tests, stand_in):
    """{test: outcome} of all tests in a folder."""
    (tests / "conftest.py").write_text(CONFTEST)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-rA", "--tb=no", "--no-header", "-p",
         "no:cacheprovider", "--rootdir", tests, tests], capture_output=True, text=True,
        check=False, cwd=tests,
        env={**os.environ, "STAND_IN": "1" if stand_in else "0", "PYTHONPATH": str(tests)})
    found = re.findall(r"^(PASSED|FAILED|ERROR|SKIPPED) (\S+)", done.stdout, re.M)
    if not found:
        sys.exit(f"{tests}: no test ran:\n{done.stdout}{done.stderr}")
    return {name: outcome for outcome, name in found}


def judge(title, before, after):
    """Prints what became of the tests; how many of them the stand-in fails for no good reason."""
    passed = [name for name, outcome in before.items() if outcome == "PASSED"]
    lost = [name for name in passed if after.get(name) != "PASSED"]
    refuted = [name for name in lost for end, refutes in REFUTED.items()
               if name.endswith(end) and refutes()]
    worded = [name for name in lost for end, same in OTHER_WORDS.items()
              if name.endswith(end) and same()]
    print(f"{title}: {len(passed)} tests pass with the original, {len(passed) - len(lost)} of them "
          "with the stand-in")
    for name in lost:
        print(f"  {name}: " + ("refuted by exact arithmetic" if name in refuted else
                               "the same error in other words" if name in worded else "LOST"))
    gained = [name for name in after if after[name] == "PASSED" and before.get(name) == "FAILED"]
    for name in gained:
        print(f"  {name}: passes with the stand-in only")
    return len(lost) - len(refuted) - len(worded)


def pyvista_examples(stand_in):
    """{method: outcome} of the examples in pyvista's docstrings."""
    import pyvista

    pyvista.OFF_SCREEN = True
    pyvista.Plotter.show = lambda *args, **options: None
    texts = {name: getattr(pyvista.PolyData, name).__doc__ for name in PYVISTA}
    if stand_in:
        import pierce.pyvista

        pierce.pyvista.install()
    result = {}
    for name, text in texts.items():
        text = text.replace("# doctest:+SKIP", "")
        example = doctest.DocTestParser().get_doctest(text, {}, name, name, 0)
        runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
        failed = runner.run(example).failed
        result[name] = "FAILED" if failed else "PASSED"
    if stand_in:
        pierce.pyvista.uninstall()
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=pathlib.Path)
    options = parser.parse_args()
    lost = 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.folder or pathlib.Path(temporary)).resolve()
        folder.mkdir(exist_ok=True, parents=True)
        for title, tests in (("trimesh", fetch_trimesh(folder)),
                             ("Open3D and embreex", fetch_others(folder)),
                             ("pyvista", fetch_pyvista(folder))):
            if not list(tests.glob("test_*.py")):
                continue
            lost += judge(title, *(run(tests, stand_in) for stand_in in (False, True)))
    lost += judge("pyvista's examples", *(pyvista_examples(x) for x in (False, True)))
    sys.exit(1 if lost else 0)


if __name__ == "__main__":
    main()
