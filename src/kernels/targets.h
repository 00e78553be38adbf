// SPDX-License-Identifier: Apache-2.0
//
// The instruction sets that kernels are compiled for, in one list. Include this first of all, then
// foreach_target.h of Highway, which compiles the including file once for each of them.
#pragma once

#include <cstddef>

#include "kernels/points/axis.h"
#include "kernels/points/nearest.h"
#include "kernels/points/winding.h"

// Of the sets that Highway knows on x86, those that differ for us are SSE4, AVX2 and AVX-512. On
// Arm it is NEON: vectors of SVE have no size that the compiler knows, and no struct can hold them.
#define HWY_DISABLED_TARGETS \
  (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE_256 | HWY_SVE2 | HWY_SVE2_128)

// `X(name, set)` for each, the best first. A new one is one more line.
#define PIERCE_TARGETS(X) \
  X("avx512", AVX3)       \
  X("avx2", AVX2)         \
  X("sse4", SSE4)         \
  X("neon", NEON)         \
  X("wasm", WASM)

namespace pierce::kernels {

/// The traversals for target number i of the list; null if this build has it not.
AxisTraversal axis_traversal(std::size_t target);
NearestTraversal nearest_traversal(std::size_t target);
WindingTraversal winding_traversal(std::size_t target);

}  // namespace pierce::kernels
