#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds the Python package as `pip install .` does, in a virtual environment of its own, and runs
# its tests there. Needs PyPI.
#
#   scripts/python_package.sh FOLDER [ARGUMENTS OF PYTEST]
#
# FOLDER keeps the environment and what was compiled: the second time is quick.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift

[ -x "$folder/venv/bin/python" ] || python3 -m venv "$folder/venv"
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
  --config-settings=build-dir="$folder/build" "$root[test]"

# From a folder where the package's sources are not, so that the installed one is tested.
cd "$folder"
exec venv/bin/python -m pytest --quiet -c "$root/pyproject.toml" --rootdir "$root" \
  -p no:cacheprovider "$root/bindings/python/tests" "$@"
