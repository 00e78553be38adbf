// SPDX-License-Identifier: Apache-2.0
//
// The same sets as kernels/wide.cpp, and the same text.
#include "bounds/targets.h"

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bounds/targets.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target.
#if HWY_TARGET != HWY_SCALAR
#include "kernels/rays/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::siege::HWY_NAMESPACE {
namespace wide = kernels::HWY_NAMESPACE;

inline std::uint32_t entered(const bvh::Node& node, const kernels::FilterRay& ray, float* entry) {
  alignas(32) float where[bvh::kWidth];
  const std::uint32_t bits =
      wide::entered_children(node, wide::box_ray(ray), ray.tau_min, ray.tau_max, where);
  std::copy(where, where + bvh::kWidth, entry);
  return bits;
}

inline LeafSays cull(const bvh::Tree& tree, std::uint32_t ref, const kernels::FilterRay& ray) {
  bvh::LeafScratch scratch;
  const wide::Leaf leaf(tree, ref, scratch);
  const wide::LeafAnswer answer = wide::cull_leaf<false>(leaf, ray, ray.tau_max, kNone);
  LeafSays says{answer.open, answer.certain, {}, {}};
  std::copy(answer.tau_low, answer.tau_low + bvh::kWidth, says.tau_low);
  std::copy(answer.tau_high, answer.tau_high + bvh::kWidth, says.tau_high);
  return says;
}

}  // namespace pierce::siege::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // HWY_TARGET

#if HWY_ONCE

#include <hwy/targets.h>

#include <vector>

namespace pierce::siege {

std::span<const Target> targets() {
  static const std::vector<Target> kTargets = [] {
    const std::int64_t supported = hwy::SupportedTargets();
    std::vector<Target> list;
    [[maybe_unused]] const auto add = [&](std::int64_t set, const Target& target) {
      if ((supported & set) != 0) list.push_back(target);
    };
#if HWY_TARGETS & HWY_AVX3
    add(HWY_AVX3, {"avx512", N_AVX3::entered, N_AVX3::cull});
#endif
#if HWY_TARGETS & HWY_AVX2
    add(HWY_AVX2, {"avx2", N_AVX2::entered, N_AVX2::cull});
#endif
#if HWY_TARGETS & HWY_SSE4
    add(HWY_SSE4, {"sse4", N_SSE4::entered, N_SSE4::cull});
#endif
#if HWY_TARGETS & HWY_NEON
    add(HWY_NEON, {"neon", N_NEON::entered, N_NEON::cull});
#endif
#if HWY_TARGETS & HWY_WASM
    add(HWY_WASM, {"wasm", N_WASM::entered, N_WASM::cull});
#endif
    return list;
  }();
  return kTargets;
}

}  // namespace pierce::siege

#endif  // HWY_ONCE
