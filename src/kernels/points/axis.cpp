// SPDX-License-Identifier: Apache-2.0
//
// Compiles the traversal along an axis for every instruction set that the kernels have.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)  // as in wide.cpp
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/points/axis.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target:
#include "kernels/points/axis-inl.h"

#if HWY_ONCE

#include <string_view>

#include "kernels/points/axis.h"

namespace pierce::kernels {

AxisTraversal axis_traversal(const Kernel& kernel) {
  [[maybe_unused]] const std::string_view name = kernel.name;
#if HWY_TARGETS & HWY_AVX3
  if (name == "avx512") return N_AVX3::traverse_axis;
#endif
#if HWY_TARGETS & HWY_AVX2
  if (name == "avx2") return N_AVX2::traverse_axis;
#endif
#if HWY_TARGETS & HWY_SSE4
  if (name == "sse4") return N_SSE4::traverse_axis;
#endif
#if HWY_TARGETS & HWY_NEON
  if (name == "neon") return N_NEON::traverse_axis;
#endif
#if HWY_TARGETS & HWY_WASM
  if (name == "wasm") return N_WASM::traverse_axis;
#endif
  return traverse_axis_plain;
}

}  // namespace pierce::kernels

#endif  // HWY_ONCE
