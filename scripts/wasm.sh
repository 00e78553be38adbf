#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
#
# Builds pierce.wasm with Debian's emscripten (build/wasm/pierce.wasm), the npm package around it
# (build/wasm/package), and holds its answers against the native library's, byte for byte, in node.
# Some ten minutes from nothing on two cores. Needs node and npm; with a
# network for npm and for Highway once.
#
#   scripts/wasm.sh            build all and test
#   scripts/wasm.sh build      only build
set -euo pipefail
cd "$(dirname "$0")/.."
. scripts/packages.sh
ensure_packages "${packages_wasm[@]}"

mkdir -p build
highway=$(scripts/highway_of_numpy.sh)
# Debian's emscripten calls clang 14, which does not come to an end with code that uses SIMD; it
# looks for its tools in one folder, and there clang 16 goes by that name.
export EM_LLVM_ROOT=$PWD/build/wasm-llvm
mkdir -p "$EM_LLVM_ROOT"
for tool in /usr/bin/llvm-*-14; do ln -sf "$tool" "$EM_LLVM_ROOT/"; done
for tool in clang clang++ wasm-ld; do
  ln -sf "/usr/lib/llvm-16/bin/$tool" "$EM_LLVM_ROOT/$tool-14"
done
launcher=()
command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
emcmake cmake -S bindings/wasm -B build/wasm -G Ninja -DCMAKE_BUILD_TYPE=None \
  -DPIERCE_HIGHWAY="$highway" "${launcher[@]}" \
  >build/wasm-configure.log 2>&1 || { cat build/wasm-configure.log >&2; exit 1; }
ninja -C build/wasm --quiet

rm -rf build/wasm/package
cp -r bindings/wasm/package build/wasm/package
(cd build/wasm/package && npm install --silent --no-fund --no-audit && npx tsc)
cp build/wasm/pierce.wasm build/wasm/package/dist/
[ "${1:-}" = build ] && exit 0

/usr/bin/python3 bindings/wasm/tests/same_bytes.py build/release/tool/pierce build/wasm/package/dist
node bindings/wasm/tests/package_test.mjs build/wasm/package/dist
# In a browser, too, where there is one, and npm has brought what drives it (cd web && npm ci).
if [ -x /usr/bin/chromium ] && [ -d web/node_modules/playwright-core ]; then
  /usr/bin/python3 bindings/wasm/tests/same_bytes.py build/release/tool/pierce \
    build/wasm/package/dist --chromium web
fi
