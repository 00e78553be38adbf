# SPDX-License-Identifier: Apache-2.0
"""Programs in an interpreter of their own."""

import os
import subprocess
import sys
import textwrap


def run_python(code, *arguments):
    """A fresh interpreter; its output, and what it wrote to stderr."""
    folder = os.path.dirname(__file__)
    code = f"import sys; sys.path.insert(0, {folder!r})\n" + textwrap.dedent(code)
    done = subprocess.run([sys.executable, "-c", code, *arguments], capture_output=True, text=True,
                          timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr
