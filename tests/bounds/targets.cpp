// SPDX-License-Identifier: Apache-2.0
//
// The same sets as kernels/wide.cpp, and the same text.
#include "bounds/targets.h"

#include "kernels/targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bounds/targets.cpp"
#include <hwy/foreach_target.h>
// After foreach_target, which includes this file once per target.
#if HWY_TARGET != HWY_SCALAR
#include "kernels/rays/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::siege::HWY_NAMESPACE {
namespace wide = kernels::HWY_NAMESPACE;

inline std::uint32_t entered(const bvh::Node& node, const space::FilterRay& ray, float* entry) {
  alignas(32) float where[bvh::kWidth];
  const std::uint32_t bits =
      wide::entered_children(node, wide::box_ray(ray), ray.tau_min, ray.tau_max, where);
  std::copy(where, where + bvh::kWidth, entry);
  if (!wide::is_ahead(ray)) return bits;
  // The same in integers.
  const auto ahead = wide::box_ray<wide::AheadRay>(ray, wide::inverse_slope_of(ray));
  const std::uint32_t ahead_bits =
      wide::entered_children(node, ahead, ray.tau_min, ray.tau_max, where);
  for (int i = 0; i < bvh::kWidth; ++i) entry[i] = std::max(entry[i], where[i]);
  return bits & ahead_bits;
}

inline LeafSays cull(const bvh::Tree& tree, std::uint32_t ref, const space::FilterRay& ray) {
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
    std::vector<Target> list;
    const auto add = [&](std::int64_t set, const Target& target) {
      if (target.entered != nullptr && (hwy::SupportedTargets() & set) != 0) list.push_back(target);
    };
#define PIERCE_TARGET(name, set) \
  add(HWY_##set, {name, HWY_CHOOSE_##set(entered), HWY_CHOOSE_##set(cull)});
    PIERCE_TARGETS(PIERCE_TARGET)
#undef PIERCE_TARGET
    return list;
  }();
  return kTargets;
}

}  // namespace pierce::siege

#endif  // HWY_ONCE
