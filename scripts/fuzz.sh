#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds the fuzz targets of tests/fuzz/ with clang and runs them one after the other, each for as
# many seconds as it says here. What was found interesting stays in build/fuzz/corpus/TARGET, so
# that the next run goes on there.
#
#   scripts/fuzz.sh                            all targets, an hour and ten minutes once they are built
#   scripts/fuzz.sh read_mesh=1200 job=60      these, for so many seconds
#
# FUZZ_FILES=FOLDER: small files of any kind in it (up to 100 kB) are seeds for read_mesh, too.
# A crash, a report of a sanitizer, an input that takes more than 5 s or more than 2 GiB ends a
# target; the input lies in build/fuzz/found/, and build/fuzz/tests/fuzz/fuzz_TARGET FILE shows it
# again. Exit status 1 if there was one.
set -euo pipefail
cd "$(dirname "$0")/.."

# TARGET=SECONDS; seeds are in tests/fuzz/seeds/TARGET, words in tests/fuzz/TARGET.dict, if any.
plan=(read_mesh=1200 csv=300 npy=600 one_triangle=300 scene_file=900 job=900)
[ $# -gt 0 ] && plan=("$@")
for item in "${plan[@]}"; do
  [[ $item =~ ^[a-z_]+=[0-9]+$ && -f tests/fuzz/${item%%=*}_fuzz.cpp ]] ||
    { echo "fuzz: '$item' is not TARGET=SECONDS with a TARGET of tests/fuzz/" >&2; exit 2; }
done

build=build/fuzz
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
cmake -S . -B $build -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER=clang++ \
  -DPIERCE_BUILD_FUZZ=ON -DPIERCE_BUILD_TESTS=ON -DPIERCE_BUILD_BENCH=OFF "${launcher[@]}" >/dev/null
targets=("${plan[@]/#/fuzz_}")
targets=("${targets[@]%%=*}")
cmake --build $build --target "${targets[@]}"

# Real files become inputs of fuzz_read_mesh, whose first byte picks a name (kNames there).
add_real_files() {
  local extensions=(ply stl obj off gltf glb 3mf) i file
  for i in "${!extensions[@]}"; do
    find "$FUZZ_FILES" -iname "*.${extensions[i]}" -type f -size -100k -print0 |
      while IFS= read -r -d '' file; do
        { printf "\\x$(printf %02x $((i + 1)))"; cat "$file"; } \
          >"$1/$(sha1sum <"$file" | cut -c1-16).${extensions[i]}"
      done
  done
}

# Chunks of a job are written to the disk itself: in memory that costs nothing.
[ -d /dev/shm ] && export TMPDIR=/dev/shm
mkdir -p $build/found $build/logs
failed=0
for item in "${plan[@]}"; do
  name=${item%%=*} seconds=${item##*=}
  corpus=$build/corpus/$name
  mkdir -p "$corpus"
  arguments=(-max_total_time="$seconds" -timeout=5 -rss_limit_mb=2048 -print_final_stats=1
    -artifact_prefix="$build/found/$name-")
  [ -f "tests/fuzz/$name.dict" ] && arguments+=(-dict="tests/fuzz/$name.dict")
  folders=("$corpus")
  [ -d "tests/fuzz/seeds/$name" ] && folders+=("tests/fuzz/seeds/$name")
  if [ "$name" = read_mesh ] && [ -n "${FUZZ_FILES:-}" ]; then
    mkdir -p $build/real_files
    add_real_files $build/real_files
    folders+=($build/real_files)
    arguments+=(-max_len=100000)
  fi
  if $build/tests/fuzz/fuzz_"$name" "${arguments[@]}" "${folders[@]}" 2>$build/logs/"$name".txt; then
    echo "$name: clean: $(grep -o '^Done.*' $build/logs/"$name".txt)"
  else
    failed=1
    echo "$name: FOUND $(grep -o "$build/found/.*" $build/logs/"$name".txt | tail -1)"
    grep -m 3 -E 'ERROR|SUMMARY|runtime error|ALARM' $build/logs/"$name".txt || true
  fi
done
exit $failed
