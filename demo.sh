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
