// SPDX-License-Identifier: Apache-2.0
//
// Compiles the wide traversal to the nearest triangle for the instruction sets of wide.cpp.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/points/nearest_wide.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target:
#include "kernels/points/nearest-inl.h"

#if HWY_ONCE

#include <string_view>

namespace pierce::kernels {

NearestTraversal nearest_traversal(const Kernel& kernel) {
  [[maybe_unused]] const std::string_view name = kernel.name;
#if HWY_TARGETS & HWY_AVX3
  if (name == "avx512") return N_AVX3::nearest;
#endif
#if HWY_TARGETS & HWY_AVX2
  if (name == "avx2") return N_AVX2::nearest;
#endif
#if HWY_TARGETS & HWY_SSE4
  if (name == "sse4") return N_SSE4::nearest;
#endif
#if HWY_TARGETS & HWY_NEON
  if (name == "neon") return N_NEON::nearest;
#endif
#if HWY_TARGETS & HWY_WASM
  if (name == "wasm") return N_WASM::nearest;
#endif
  return nearest_plain;
}

}  // namespace pierce::kernels

#endif  // HWY_ONCE
