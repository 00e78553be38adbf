#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# pierce for 64-bit Arm, on an x86-64 machine with Debian 12: cross-compiles the library, the tool
# and the tests into build/arm, and runs the tests under qemu-user. The libraries come from Debian's
# arm64 packages, unpacked into build/arm/root; the machine's own packages stay as they are.
#
#   scripts/arm.sh                   all of them
#   scripts/arm.sh -R REGEX ...      some tests: the arguments go to ctest
#   scripts/arm.sh --short           builds the library, the tool and five tests, and runs those on
#                                    fewer cases (PIERCE_CASES, 10 unless it is set)
#
# build/arm/pierce is the command under qemu, for scripts/same_bytes.py.
set -euo pipefail
cd "$(dirname "$0")/.."

# One test of each room: bounds of the double rung, one triangle, scenes, nearest points, batches.
short_tests=(unit_certify_bounds_test differential_one_triangle_test differential_scene_test
  differential_nearest_test property_batches_test)
targets=(all)
if [ "${1:-}" = --short ]; then
  shift
  targets=(pierce_tool "${short_tests[@]}")
  regex=$(IFS='|' && echo "^(${short_tests[*]})(@|\$)")
  set -- -R "$regex" "$@"
  export PIERCE_CASES=${PIERCE_CASES:-10}
fi
. scripts/packages.sh
ensure_packages "${packages_arm[@]}"

build=$PWD/build/arm
root=$build/root
mkdir -p "$build"

# fetch_packages NAME...: unpacks Debian's arm64 packages into $root, by an apt of its own that
# knows of no other machine.
fetch_packages() {
  local apt=$build/apt name
  mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$apt/packages"
  : >"$apt/status"
  cat >"$apt/apt.conf" <<END
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Sandbox::User "root";
Dir::State "$apt/state";
Dir::State::status "$apt/status";
Dir::Cache "$apt/cache";
END
  echo "pierce: fetching $* for arm64"
  if ! (cd "$apt/packages" && export APT_CONFIG=$apt/apt.conf && apt-get -qq update &&
    apt-get -qq download "$@") >"$apt/log" 2>&1; then
    echo "pierce: arm64 packages cannot be fetched: $(grep -m 1 -E '^(E|W|Err):?' "$apt/log" ||
      tail -n 1 "$apt/log")" >&2
    exit 1
  fi
  for name in "$apt/packages"/*.deb; do
    dpkg-deb -x "$name" "$root"
  done
  # Found by Debian's own compiler where it lies, but not by the cross compiler.
  ln -sf aarch64-linux-gnu/gmp.h "$root/usr/include/gmp.h"
  touch "$root/complete"
}
[ -e "$root/complete" ] || fetch_packages "${packages_arm_libraries[@]}"

launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
started=$SECONDS
cmake -S . -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/aarch64.cmake \
  -DPIERCE_ARM_ROOT="$root" -DCMAKE_BUILD_TYPE=Release -DPIERCE_PARALLEL=threads \
  -DPIERCE_INSTALLED_LIBRARIES=OFF -DPIERCE_BUILD_BENCH=OFF "${launcher[@]}" \
  >"$build/configure.log" 2>&1 || {
  cat "$build/configure.log" >&2
  exit 1
}
nice ninja -C "$build" -j "$(nproc)" --quiet "${targets[@]}"
echo "pierce: built for arm64 in $((SECONDS - started)) s"

cat >"$build/pierce" <<END
#!/bin/sh
exec qemu-aarch64-static -L /usr/aarch64-linux-gnu "$build/tool/pierce" "\$@"
END
chmod +x "$build/pierce"
ctest --test-dir "$build" --timeout 3600 --output-on-failure --no-tests=error -j "$(nproc)" "$@"
