# SPDX-License-Identifier: Apache-2.0
"""The console script `pierce`. Beside the package and not in it, because to import anything of the
package is to import NumPy, which takes longer than most of what is asked of the command."""

from importlib.util import find_spec, module_from_spec, spec_from_file_location
from os.path import dirname, join


def main() -> None:
    """Runs pierce/__main__.py, which imports nothing of the package."""
    package = find_spec("pierce")
    assert package is not None and package.origin is not None
    path = join(dirname(package.origin), "__main__.py")
    spec = spec_from_file_location("_pierce_main", path)
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    module.main()
