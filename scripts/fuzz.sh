#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds the fuzz targets of tests/fuzz/ with clang and runs them one after the other, each for as
# many seconds as it says here. What was found interesting stays in build/fuzz/corpus/TARGET, so
# that the next run goes on there.
#
#   scripts/fuzz.sh                         all targets: an hour and ten minutes once they are built
#   scripts/fuzz.sh read_mesh=1200 job=60   these, for so many seconds
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
  -DPIERCE_BUILD_FUZZ=ON -DPIERCE_BUILD_TESTS=ON -DPIERCE_BUILD_BENCH=OFF "${launcher[@]}" \
  >/dev/null
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

# only_waited PROGRAM INPUT: whether the input was too slow by the clock of a busy machine only.
# Then it is removed.
only_waited() {
  [[ $2 == *-timeout-* ]] || return 1
  local TIMEFORMAT=%U taken=0
  taken=$({ time "$1" "$2" >/dev/null 2>&1; } 2>&1) || return 1
  [ "${taken%.*}" -lt 5 ] && rm "$2"
}

# Chunks of a job are written to the disk itself: in memory that costs nothing.
[ -d /dev/shm ] && export TMPDIR=/dev/shm
mkdir -p $build/found $build/logs
failed=0
for item in "${plan[@]}"; do
  name=${item%%=*} seconds=${item##*=}
  corpus=$build/corpus/$name
  mkdir -p "$corpus"
  arguments=(-timeout=5 -rss_limit_mb=2048 -print_final_stats=1
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
  # Changes of a file that the target makes itself: long from the start, for each takes a while.
  case $name in
    scene_file) arguments+=(-max_len=511 -len_control=0) ;;
    job) arguments+=(-max_len=2000 -len_control=0) ;;
  esac
  program=$build/tests/fuzz/fuzz_$name log=$build/logs/$name.txt end=$((SECONDS + seconds))
  runs=0 verdict=clean
  while [ $SECONDS -lt $end ]; do
    status=0
    "$program" "${arguments[@]}" -max_total_time=$((end - SECONDS)) "${folders[@]}" 2>"$log" ||
      status=$?
    done=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log" | tail -1)
    runs=$((runs + ${done:-0}))
    [ $status -eq 0 ] && break
    input=$(sed -n 's/.*Test unit written to //p' "$log" | tail -1)
    only_waited "$program" "$input" && continue
    verdict="FOUND $input" failed=1
    break
  done
  echo "$name: $verdict ($runs inputs)"
  [ "$verdict" = clean ] || grep -m 3 -E 'ERROR|SUMMARY|runtime error' "$log" || true
done
exit $failed
