#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Google's Highway 1.3, for builds that Debian's 1.0.3 does not serve: NumPy's source package on
# PyPI holds it. Fetches that package once, by its checksum, and prints the folder of Highway in it.
#
#   scripts/highway_of_numpy.sh      prints build/highway/numpy-VERSION/numpy/_core/src/highway
set -euo pipefail
cd "$(dirname "$0")/.."
version=2.4.6
sum=f3a3570c4a2a16746ac2c31a7c7c7b0c186b95ce902e33db6f28094ed7387dda
to=$PWD/build/highway
highway=numpy-$version/numpy/_core/src/highway

if [ ! -f "$to/$highway/hwy/highway.h" ]; then
  . scripts/packages.sh
  ensure_packages "${packages_python[@]}" >&2
  mkdir -p "$to/backend"
  # pip asks a source package's build system for its name before it gives the file away, and
  # NumPy's takes minutes to say it. This one answers at once, from the file PKG-INFO.
  cat >"$to/backend/mesonpy.py" <<'EOF'
import pathlib


def prepare_metadata_for_build_wheel(folder, config_settings=None):
    info = pathlib.Path("PKG-INFO").read_text(encoding="utf-8")
    version = next(line.split()[1] for line in info.splitlines() if line.startswith("Version:"))
    made = pathlib.Path(folder, f"numpy-{version}.dist-info")
    made.mkdir()
    (made / "METADATA").write_text(info, encoding="utf-8")
    return made.name
EOF
  [ -d "$to/venv" ] || /usr/bin/python3 -m venv "$to/venv"
  echo "numpy==$version --hash=sha256:$sum" >"$to/wanted.txt"
  PYTHONPATH=$to/backend "$to/venv/bin/pip" download --quiet --disable-pip-version-check --no-deps \
    --no-binary :all: --no-build-isolation --require-hashes --requirement "$to/wanted.txt" \
    --dest "$to" >&2
  tar -xzf "$to/numpy-$version.tar.gz" -C "$to" "$highway"
fi
echo "$to/$highway"
