#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# pierce as part of a user's project: optimised if that project has no build type, built as the
# user says if it has one. Configures only, and looks at the commands.
#
# usage: run.sh SOURCE BUILD WORK
set -euo pipefail
source=$1 build=$2 work=$3
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
parallel=$(sed -n 's/^PIERCE_PARALLEL:[A-Z]*=//p' "$build/CMakeCache.txt")

# commands TYPE: how each source of the library is compiled, one a line; those of the user's below.
commands() {
  rm -rf "$work"
  cmake -S "$source/tests/install/subproject" -B "$work" -G Ninja -DPIERCE_SOURCE="$source" \
    -DCMAKE_CXX_COMPILER="$compiler" -DPIERCE_PARALLEL="$parallel" -DCMAKE_BUILD_TYPE="$1" \
    >/dev/null
  sed -n 's/^ *"command": //p' "$work/compile_commands.json" >"$work/all"
  grep "$source/src/" "$work/all" >"$work/library"
  grep -v "$source/src/" "$work/all" >"$work/user"
}

# expect WHAT LIST PATTERN COUNT: so many lines of the list have the pattern.
expect() {
  local found
  found=$(grep -c -E -e "$3" "$work/$2" || true)
  [ "$found" = "$4" ] && return
  echo "$1: $found commands with $3, not $4" >&2
  exit 1
}

commands ""
sources=$(find "$source/src" -name '*.cpp' -not -path '*/src/io/*' | wc -l)
expect "no build type" library ' -O3 -DNDEBUG .* -c ' "$sources"
expect "no build type, the user's own file" user ' -O|NDEBUG' 0
commands Debug
expect "Debug" library ' -O|NDEBUG' 0
commands RelWithDebInfo
expect "RelWithDebInfo" library ' -O2 ' "$sources"
expect "RelWithDebInfo" library ' -O3 ' 0
