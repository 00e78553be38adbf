# SPDX-License-Identifier: Apache-2.0
"""The command `pierce`: hands over to the C++ tool that lies in this package.

Imports nothing of the package: the console script (_pierce_command) runs this file by itself.
"""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec


def tool() -> str:
    """Where the tool lies, or would lie: an editable installation has several folders."""
    package = find_spec("pierce")
    assert package is not None and package.submodule_search_locations
    name = "pierce.exe" if os.name == "nt" else "pierce"
    paths = [os.path.join(os.path.realpath(folder), "bin", name)
             for folder in package.submodule_search_locations]
    return next(filter(os.path.exists, paths), paths[0])


def main() -> None:
    path = tool()
    if not os.path.exists(path):
        sys.exit(f"pierce: {path} is missing: this package was built without the command")
    if os.name == "nt":
        import subprocess
        sys.exit(subprocess.run([path, *sys.argv[1:]], check=False).returncode)
    os.execv(path, ["pierce", *sys.argv[1:]])


if __name__ == "__main__":
    main()
