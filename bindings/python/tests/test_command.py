# SPDX-License-Identifier: Apache-2.0
"""The console script `pierce` behaves as the C++ tool by itself: how it speaks, how it ends.

With the environment variable PIERCE_NATIVE_TOOL the answers are held against that program's.
"""

import os
import signal
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

import pierce.job

SCRIPT = Path(sysconfig.get_path("scripts")) / "pierce"
TOOL_TESTS = Path(__file__).parents[3] / "tests" / "tool"
NATIVE = os.environ.get("PIERCE_NATIVE_TOOL")

pytestmark = pytest.mark.skipif(not pierce.job.tool_path().exists(),
                                reason="built without the command")


@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize("name", ["ending", "streams", "usage"])
def test_passes_the_tests_of_the_tool(name):
    """Among them: Ctrl-C, once and twice, a reader that has gone, full disks, exit statuses."""
    done = subprocess.run([sys.executable, "-B", TOOL_TESTS / f"{name}_test.py"],
                          env={**os.environ, "PIERCE_TOOL": str(SCRIPT)}, capture_output=True,
                          text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "OK" in done.stderr


@pytest.fixture
def square(tmp_path):
    """A folder with a mesh, 100,000 rays, as many points."""
    (tmp_path / "square.off").write_text(
        "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n")
    rays = np.random.default_rng(3).uniform(-1, 1, (100000, 6)).astype(np.float32)
    np.save(tmp_path / "rays.npy", rays)
    np.save(tmp_path / "points.npy", rays[:, :3])
    return tmp_path


@pytest.mark.skipif(os.name == "nt", reason="pipes of bash")
def test_a_reader_that_takes_one_line(square):
    line = '"$0" cast square.off --rays rays.npy --out - --format csv --quiet | head -1'
    done = subprocess.run(["bash", "-c", line + '; exit "${PIPESTATUS[0]}"', str(SCRIPT)],
                          cwd=square, capture_output=True, text=True, check=False)
    assert done.stdout == "t,u,v,w,geometry,triangle,facing\n"
    assert (done.returncode, done.stderr) == (128 + signal.SIGPIPE, "")


def test_does_not_import_numpy():
    done = subprocess.run([sys.executable, "-X", "importtime", str(SCRIPT), "--version"],
                          capture_output=True, text=True, check=True)
    assert "_pierce_command" in done.stderr
    assert "numpy" not in done.stderr and "pierce._core" not in done.stderr


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="names and sizes of Linux")
def test_the_library_is_in_the_package_once():
    package = Path(pierce._core.__file__).parent
    assert (package / "lib" / "libpierce_package.so").stat().st_size > 1000000
    assert (package / "bin" / "pierce").stat().st_size < 100000
    assert Path(pierce._core.__file__).stat().st_size < 1000000


CALLS = ["--version", "--help", "", "cats", "cast", "cast --help", "cast square.off --ray 0,0,x",
         "info none.off", "cast square.off --ray 0.5,0.5,1,0,0,-1", "locate square.off",
         "nearest square.off --points points.npy --out - --quiet",
         "locate square.off --points points.npy --out - --quiet --rule winding",
         *(f"cast square.off --rays rays.npy --out - --quiet --format {form} --query {query}"
           for form in ("npy", "csv") for query in ("closest", "all", "any", "count", "crossings"))]


@pytest.mark.skipif(NATIVE is None, reason="PIERCE_NATIVE_TOOL is not set")
@pytest.mark.parametrize("call", CALLS)
def test_same_bytes_and_status_as_the_native_tool(square, call):
    asked = [subprocess.run([program, *call.split()], cwd=square, capture_output=True, check=False)
             for program in (NATIVE, SCRIPT)]
    native, packaged = [(done.returncode, done.stdout, done.stderr) for done in asked]
    # Only a native build may have the benchmark.
    assert packaged == native or "--help" in call or not call
    assert packaged[0] == native[0]
