# SPDX-License-Identifier: Apache-2.0
"""The command `pierce`: hands over to the C++ tool that lies in this package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from . import _core


def tool_path() -> Path:
    """Where the tool lies, if it does."""
    name = "pierce.exe" if os.name == "nt" else "pierce"
    return Path(_core.__file__).resolve().parent / "bin" / name


def main() -> None:
    tool = tool_path()
    if not tool.exists():
        sys.exit(f"pierce: {tool} is missing: this package was built without the command")
    if os.name == "nt":
        sys.exit(subprocess.run([str(tool), *sys.argv[1:]], check=False).returncode)
    os.execv(tool, ["pierce", *sys.argv[1:]])


if __name__ == "__main__":
    main()
