# SPDX-License-Identifier: Apache-2.0
#
# Debian packages that pierce is built with, and how to get the missing ones. Sourced by demo.sh and
# test.sh; every name here is in Debian 12.

# The tool: compiler, the three libraries of the core, the readers' and the tool's own.
packages_tool=(
  g++ cmake ninja-build pkg-config
  libhwy-dev libtbb-dev libboost-dev
  libcli11-dev libfmt-dev libfast-float-dev libtinyobjloader-dev libassimp-dev libstb-dev
  nlohmann-json3-dev libdraco-dev libmeshoptimizer-dev libzip-dev libexpat1-dev
  zlib1g-dev libzstd-dev)

# Meshes that are shown and tested with.
packages_meshes=(glmark2-data)

# The tests: GoogleTest, the oracles, the proofs, the second compiler, the checks of the house,
# mpirun; and the contenders of the benchmark.
packages_test=(
  libgtest-dev libgmp-dev libcgal-dev gappa clang clang-format
  python3 python3-numpy libembree-dev libbenchmark-dev openmpi-bin)

# scripts/python_package.sh.
packages_python=(python3-dev python3-venv)

# scripts/python_wheel.sh: what Open3D's wheel expects to be there.
packages_peers=(libusb-1.0-0)

# scripts/arm.sh: the cross compiler and the emulator; and what is linked, for arm64.
packages_arm=(
  cmake ninja-build pkg-config g++-aarch64-linux-gnu qemu-user-static googletest)
packages_arm_libraries=(
  libhwy-dev libhwy1 libgmp-dev libgmp10 libgmpxx4ldbl libboost1.74-dev libfmt-dev libfmt9
  libcli11-dev libfast-float-dev libstb-dev nlohmann-json3-dev)

# The preset release-libcxx.
packages_libcxx=(clang libc++-dev libc++abi-dev googletest)

# scripts/wasm.sh (node and npm: Debian's nodejs, npm, or others).
packages_wasm=(
  emscripten clang-16 lld-16 cmake ninja-build libboost-dev libc++-14-dev python3-venv)

# ensure_packages NAME...: installs those that are missing, silently; a machine that has them all
# is not touched and needs no network. Without root, or when apt-get fails, says in one line what
# to install and exits 1.
ensure_packages() {
  local missing=() name
  for name in "$@"; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" != installed ]; then
      missing+=("$name")
    fi
  done
  [ ${#missing[@]} -eq 0 ] && return 0

  local command="apt-get install -y --no-install-recommends ${missing[*]}"
  if ! command -v apt-get >/dev/null || [ "$(id -u)" -ne 0 ]; then
    echo "pierce: packages are missing; install them as root: apt-get update && $command" >&2
    exit 1
  fi
  echo "pierce: installing ${missing[*]}"
  local log
  log=$(mktemp)
  export DEBIAN_FRONTEND=noninteractive
  local options=(-o Acquire::Retries=2 -o Acquire::http::Timeout=30)
  if ! apt-get "${options[@]}" update >"$log" 2>&1 ||
    ! apt-get "${options[@]}" install -y --no-install-recommends "${missing[@]}" \
      >>"$log" 2>&1 </dev/null; then
    echo "pierce: packages cannot be installed ($(grep -m 1 -E '^(E|W|Err):?' "$log" ||
      tail -n 1 "$log")); with a network, run: apt-get update && $command" >&2
    rm -f "$log"
    exit 1
  fi
  rm -f "$log"
}

# configure_and_build TARGET [-D...]: the preset "release" in build/release, with ccache if there;
# from nothing, several sources in one run of the compiler. Quiet in a pipe, one line of progress on
# a terminal.
configure_and_build() {
  local target=$1 directory=build/release quiet=--quiet
  shift
  [ -t 1 ] && quiet=
  # Without these ccache leaves all that has a precompiled header (cmake/pierce_quick_tests.cmake)
  # to the compiler.
  command -v ccache >/dev/null && set -- "$@" \
    "-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache"
  [ -f "$directory/CMakeCache.txt" ] || set -- "$@" -DPIERCE_COMPILE_TOGETHER=ON
  mkdir -p "$directory"
  if ! cmake --preset release "$@" >"$directory/configure.log" 2>&1; then
    cat "$directory/configure.log" >&2
    exit 1
  fi
  ninja -C "$directory" $quiet "$target"
}
