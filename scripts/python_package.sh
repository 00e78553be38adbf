#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds the Python package as `pip install .` does, in a virtual environment of its own, and runs
# its tests there. Needs PyPI: without it, or without Debian's python3-dev and python3-venv, says so
# and ends with 77, which ctest counts as skipped.
#
#   scripts/python_package.sh FOLDER [ARGUMENTS OF PYTEST]
#
# FOLDER keeps the environment and what was compiled: the second time is quick.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift

skip() {
  echo "python_package: skipped: $1"
  exit 77
}
. "$root/scripts/packages.sh"
python3 -c 'import ensurepip, sysconfig, pathlib, sys
sys.exit(not (pathlib.Path(sysconfig.get_path("include")) / "Python.h").exists())' 2>/dev/null ||
  (ensure_packages "${packages_python[@]}") || skip "install ${packages_python[*]}"
[ -x "$folder/venv/bin/python" ] || python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" download --quiet --disable-pip-version-check --no-deps --retries 1 \
  --dest "$folder" nanobind >/dev/null 2>&1 || skip "PyPI cannot be reached"
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
  --config-settings=build-dir="$folder/build" "$root[test]"

# From a folder where the package's sources are not, so that the installed one is tested.
cd "$folder"
exec venv/bin/python -m pytest --quiet -c "$root/pyproject.toml" --rootdir "$root" \
  -p no:cacheprovider "$root/bindings/python/tests" "$@"
