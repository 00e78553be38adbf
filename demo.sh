#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing (Debian 12), builds the command `pierce` and does the main job on the
# Stanford bunny: a picture, a file of rays and the exact answer for each of them, in out/.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/packages.sh

ensure_packages "${packages_tool[@]}" "${packages_meshes[@]}"

# A tree that test.sh has built keeps its tests; otherwise build only what is needed here.
options=()
if [ ! -f build/release/CMakeCache.txt ]; then
  options=(-DPIERCE_BUILD_TESTS=OFF -DPIERCE_BUILD_BENCH=OFF)
fi
configure_and_build pierce_tool "${options[@]}"

pierce=build/release/tool/pierce
bunny=/usr/share/glmark2/models/bunny.obj
mkdir -p out
"$pierce" rays "$bunny" --size 1024x1024 --out out/rays.npy
"$pierce" render "$bunny" --size 1024x1024 --out out/bunny.png
echo "pierce cast bunny.obj --rays out/rays.npy --out out/hits.npy"
"$pierce" cast "$bunny" --rays out/rays.npy --out out/hits.npy
echo "the picture: out/bunny.png"
cat <<EOF
the same from Python, after pip install . in a virtual environment:
  import numpy, pierce
  hits = pierce.Scene("$bunny").closest_hit(numpy.load("out/rays.npy"))
EOF
