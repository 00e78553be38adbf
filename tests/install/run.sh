#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Installs pierce into a fresh prefix, moves that prefix, and builds and runs a user's program
# against it: once through find_package, once through pkg-config. The answers must be the exact
# ones in consumer/expected.txt. Looks at the library's symbols (symbols.py).
#
# usage: run.sh static|shared SOURCE BUILD WORK
set -euo pipefail
type=$1 source=$2 build=$3 work=$4
consumer=$source/tests/install/consumer

rm -rf "$work/stage" "$work/prefix" "$work/cmake" "$work/pkgconfig"
mkdir -p "$work/pkgconfig"

compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
launcher=$(sed -n 's/^CMAKE_CXX_COMPILER_LAUNCHER:[A-Z]*=//p' "$build/CMakeCache.txt")
if [ "$type" = static ]; then
  cmake --install "$build" --prefix "$work/stage" >/dev/null
else
  # The library alone, without optimisation: quick to build, and the answers must be the same.
  cmake -S "$source" -B "$work/build" -G Ninja -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_COMPILER_LAUNCHER="$launcher" \
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DPIERCE_BUILD_TOOL=OFF -DPIERCE_BUILD_TESTS=OFF \
    -DPIERCE_BUILD_BENCH=OFF -DPIERCE_BUILD_C=OFF -DPIERCE_COMPILE_TOGETHER=ON >/dev/null
  ninja -C "$work/build" --quiet
  cmake --install "$work/build" --prefix "$work/stage" >/dev/null
fi
mv "$work/stage" "$work/prefix"
libdir=$(dirname "$(find "$work/prefix" -name 'libpierce.*' | head -n 1)")

version=$(cat "$source/VERSION")
echo "-- $type: find_package(pierce $version)"
cmake -S "$consumer" -B "$work/cmake" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" \
  -DCMAKE_PREFIX_PATH="$work/prefix" -DWANTED_VERSION="$version" >/dev/null
grep -q "pierce_DIR:PATH=$work/prefix" "$work/cmake/CMakeCache.txt"
ninja -C "$work/cmake" --quiet
"$work/cmake/consumer" | diff "$consumer/expected.txt" -

echo "-- $type: pkg-config pierce"
export PKG_CONFIG_PATH=$libdir/pkgconfig
[ "$(pkg-config --modversion pierce)" = "$version" ]
# shellcheck disable=SC2046  # one word a flag is what is wanted
"$compiler" -fvisibility=hidden $(pkg-config --cflags pierce) "$consumer/main.cpp" \
  $(pkg-config --libs pierce) -o "$work/pkgconfig/consumer"
LD_LIBRARY_PATH=$libdir "$work/pkgconfig/consumer" | diff "$consumer/expected.txt" -

echo "-- $type: a program built with -ffast-math"
# shellcheck disable=SC2046
"$compiler" -O2 -ffast-math $(pkg-config --cflags pierce) "$consumer/fast_math.cpp" \
  $(pkg-config --libs pierce) -o "$work/pkgconfig/fast_math"
LD_LIBRARY_PATH=$libdir "$work/pkgconfig/fast_math"

if [ "$type" = shared ]; then
  echo "-- shared: the symbols that leave it"
  python3 "$source/tests/install/symbols.py" shared "$libdir/libpierce.so" "$source/include"
  echo "-- shared: its objects without optimisation in a program with -ffast-math"
  # shellcheck disable=SC2046
  "$compiler" -O0 -ffast-math $(pkg-config --cflags pierce) "$consumer/fast_math.cpp" \
    "$work/build/src/libpierce_internal.a" $(pkg-config --static --libs pierce) \
    -o "$work/pkgconfig/fast_math_O0"
  LD_LIBRARY_PATH=$libdir "$work/pkgconfig/fast_math_O0"
  readelf -d "$work/pkgconfig/consumer" | grep -q 'NEEDED.*libpierce.so'
elif grep -q '^CMAKE_BUILD_TYPE:[A-Z]*=Release' "$build/CMakeCache.txt"; then
  echo "-- static: the symbols that a caller might have, too"
  python3 "$source/tests/install/symbols.py" static "$libdir/libpierce.a" "$source/include"
fi
if [ "$type" = static ]; then
  echo "-- static: the C library, from C"
  # shellcheck disable=SC2046
  gcc -std=c11 -Wall -Wextra -Werror $(pkg-config --cflags pierce_c) "$source/examples/ask.c" \
    $(pkg-config --libs pierce_c) -o "$work/pkgconfig/ask"
  LD_LIBRARY_PATH=$libdir "$work/pkgconfig/ask" | grep -q '^triangle 0 at t = 0.333333343'
  nm -D --defined-only "$libdir/libpierce_c.so" | awk '{ print $3 }' | while read -r name; do
    grep -q "\b$name(" "$source/include/pierce/pierce_c.h" ||
      { echo "$name: leaves the C library, and its header does not declare it"; exit 1; }
  done
fi
if [ "$type" = static ] && [ -x "$work/prefix/bin/pierce" ]; then
  "$work/prefix/bin/pierce" --help >/dev/null
fi
