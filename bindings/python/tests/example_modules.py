# SPDX-License-Identifier: Apache-2.0
"""The modules of examples/python, for as long as a test runs."""

import contextlib
import sys
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[3] / "examples" / "python"


@contextlib.contextmanager
def example_modules():
    """Imports come from examples/python first, and leave nothing behind."""
    names = [path.stem for path in FOLDER.glob("*.py")]
    others = {name: sys.modules.pop(name) for name in names if name in sys.modules}
    sys.path.insert(0, str(FOLDER))
    try:
        yield
    finally:
        sys.path.remove(str(FOLDER))
        for name in names:
            sys.modules.pop(name, None)
        sys.modules.update(others)
