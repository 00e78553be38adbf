# SPDX-License-Identifier: Apache-2.0
"""The package itself: its examples run, its types check, its command is the C++ tool."""

import doctest
import importlib
import inspect
import os
import pkgutil
import re
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

import pierce

PACKAGE = Path(pierce.__file__).parent
MODULES = sorted(m.name for m in pkgutil.iter_modules([str(PACKAGE)])
                 if m.name not in ("__main__", "_core"))


@pytest.mark.parametrize("name", ["pierce", *(f"pierce.{name}" for name in MODULES)])
def test_examples_in_docstrings(name):
    module = importlib.import_module(name)
    result = doctest.testmod(module, extraglobs={"np": np, "pierce": pierce, "Scene": pierce.Scene})
    assert result.failed == 0


def test_everything_public_is_described():
    queries = [name for name in dir(pierce.Scene) if not name.startswith("_")]
    assert {"closest_hit", "any_hit", "all_hits", "count_hits", "crossings", "locate", "nearest",
            "signed_distance", "voxelise", "next_origin", "step", "update"} <= set(queries)
    for name in queries:
        member = getattr(pierce.Scene, name)
        words = inspect.getdoc(member)
        assert words, name
        if inspect.isfunction(member) and name != "info":
            assert ">>>" in words, f"Scene.{name} has no example"
            assert "Raises" in words or "errors" in words or name in ("next_origin", "step"), name
    for name in pierce.__all__:
        assert name == "__version__" or inspect.getdoc(getattr(pierce, name)), name


def test_types(tmp_path):
    pytest.importorskip("mypy")
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-incremental",
                           "--config-file", os.devnull, "-p", "pierce"],
                          capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (PACKAGE / "py.typed").exists()


def test_kernel():
    assert pierce._core.kernel() in ("avx512", "avx2", "sse4", "neon", "plain")


USED = """
import numpy as np
import pierce
scene = pierce.Scene(np.eye(3), [[0, 1, 2]], quality="high", progress=print)
hits = scene.closest_hit(np.ones((4, 6)), filter=lambda ray, hits: hits.t > 1, threads=2)
reveal_type(hits)
reveal_type(scene.all_hits(np.ones((4, 6)), max_hits=3).of(1))
scene.closest_hit(np.ones((4, 6)), side="front")
scene.locate()
hits.nonsense + 1
"""


def test_types_help_the_user(tmp_path):
    pytest.importorskip("mypy")
    (tmp_path / "used.py").write_text(USED)
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-incremental", "used.py"],
                          cwd=tmp_path, capture_output=True, text=True, check=False)
    assert len(re.findall(r'Revealed type is "pierce._hits.Hits"', done.stdout)) == 2, done.stdout
    errors = re.findall(r"used.py:(\d+): error", done.stdout)
    assert errors == ["8", "9", "10"], done.stdout


def test_the_command_is_the_tool(tmp_path):
    script = Path(sysconfig.get_path("scripts")) / "pierce"
    for command in ([sys.executable, "-m", "pierce"], [str(script)]):
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=True)
        assert pierce.__version__ in done.stdout
    mesh = tmp_path / "square.off"
    mesh.write_text("OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
    rays = tmp_path / "rays.npy"
    np.save(rays, np.array([[0.5, 0.25, 2, 0, 0, -1], [5, 5, 5, 0, 0, -1]]))
    answers = tmp_path / "hits.npy"
    subprocess.run([str(script), "cast", str(mesh), "--rays", str(rays), "--out", str(answers)],
                   check=True)
    cast, hits = np.load(answers), pierce.Scene(mesh).closest_hit(np.load(rays))
    for name in ("t", "u", "v", "w", "facing"):
        assert np.array_equal(cast[name], getattr(hits, name))
    assert np.array_equal(cast["triangle"], hits.triangle.astype(np.uint32))
    failed = subprocess.run([sys.executable, "-m", "pierce", "info", "none.ply"],
                            capture_output=True, text=True, check=False)
    assert failed.returncode != 0 and "none.ply" in failed.stderr


def test_version():
    from importlib.metadata import version
    assert pierce.__version__ == version("pierce")
    assert re.fullmatch(r"\d+\.\d+\.\d+", pierce.__version__)
