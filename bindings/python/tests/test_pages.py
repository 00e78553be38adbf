# SPDX-License-Identifier: Apache-2.0
"""What docs/python.md and the README show in Python runs and prints what they say."""

import contextlib
import importlib.util
import io
import json
import re
import textwrap
from pathlib import Path

import pytest
from example_modules import example_modules

ROOT = Path(__file__).resolve().parents[3]
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```\s*$", re.M | re.S)

pytestmark = pytest.mark.skipif(not (ROOT / "docs").is_dir(),
                                reason="the package without its repository")


def blocks(name):
    return [(match[1], match[2]) for match in FENCE.finditer((ROOT / name).read_text())]


def squeezed(text):
    return re.sub(r"\s+", " ", text)


def runs(language):
    """Whether a block is a program, and what it needs, as in "python trimesh", is installed."""
    words = language.split()
    return words[:1] == ["python"] and words[1:] != ["gallery"] and all(
        importlib.util.find_spec(word) for word in words[1:])


@pytest.mark.parametrize("page", ["docs/python.md", "docs/coming_from.md", "docs/start.md",
                                  "docs/guide.md", "README.md"])
def test_programs_of_a_page(page):
    names = {"__name__": "page"}
    found = blocks(page)
    count = 0
    for (language, code), (next_language, expected) in zip(found, [*found[1:], ("", "")]):
        if not runs(language):
            continue
        count += 1
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, page, "exec"), names)
        if next_language == "text":
            assert squeezed(printed.getvalue()) == squeezed(expected), code
    assert count >= {"docs/python.md": 8, "docs/coming_from.md": 2}.get(page, 1)


def test_the_gallery_shows_lines_of_its_programs():
    page = (ROOT / "docs/python.md").read_text()
    shown = re.findall(r"examples/python/(\w+)\.py\)[^\n]*\n\n```python gallery\n(.*?)^```", page,
                       re.M | re.S)
    assert len(shown) == 10
    for name, code in shown:
        program = textwrap.dedent((ROOT / f"examples/python/{name}.py").read_text())
        lines = [line.strip() for line in program.splitlines()]
        for line in code.splitlines():
            assert line.strip() in lines, (name, line)


def test_pictures_are_small():
    pictures = list((ROOT / "docs/images/python").glob("*.png"))
    assert len(pictures) == 10
    assert all(path.stat().st_size <= 60 * 1024 for path in pictures)


NOTEBOOK = ROOT / "examples/python/pierce.ipynb"


def test_the_notebook_runs():
    notebook = json.loads(NOTEBOOK.read_text())
    assert notebook["nbformat"] == 4
    names = {"__name__": "notebook"}
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert len(cells) >= 6
    with example_modules():
        for cell in cells:
            assert cell["outputs"] == [] and cell["execution_count"] is None
            exec(compile("".join(cell["source"]), "pierce.ipynb", "exec"), names)


def test_the_notebook_runs_in_a_kernel():
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={
        "metadata": {"path": str(NOTEBOOK.parent)}}).execute()
    shown = [output for cell in notebook.cells if cell.cell_type == "code"
             for output in cell.outputs if "data" in output]
    assert any("image/png" in output.data for output in shown)
    assert any("text/html" in output.data for output in shown)
