#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs what is missing (Debian 12), builds everything and runs every test.
#
#   ./test.sh                   all tests
#   ./test.sh -R REGEX ...      some tests: the arguments go to ctest (-R name, -L label, -E, ...)
#
# The last line counts the tests: N passed, N failed. Exit status 0 only if none failed.
set -euo pipefail
cd "$(dirname "$0")"
. scripts/packages.sh

ensure_packages "${packages_tool[@]}" "${packages_meshes[@]}" "${packages_test[@]}"

started=$SECONDS
if ! (configure_and_build all -DPIERCE_BUILD_TOOL=ON -DPIERCE_BUILD_TESTS=ON \
  -DPIERCE_BUILD_BENCH=ON); then
  echo "pierce: the build failed"
  echo "0 passed, 1 failed"
  exit 1
fi
echo "pierce: built in $((SECONDS - started)) s"

log=build/release/test.log
status=0
ctest --test-dir build/release --output-on-failure --no-tests=error -j "$(nproc)" "$@" 2>&1 |
  tee "$log" || status=$?

# ctest closes with "98% tests passed, 1 tests failed out of 57".
counts=$(sed -nE 's/^[0-9]+% tests passed, ([0-9]+) tests failed out of ([0-9]+)$/\1 \2/p' "$log")
read -r failed total <<<"${counts:-1 1}"
echo "$((total - failed)) passed, $failed failed"
exit "$status"
