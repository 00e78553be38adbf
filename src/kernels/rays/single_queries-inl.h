// SPDX-License-Identifier: Apache-2.0
//
// The queries about one ray: its first hit, any hit, all hits.
#if defined(PIERCE_KERNELS_SINGLE_QUERIES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_SINGLE_QUERIES_INL_H_
#undef PIERCE_KERNELS_SINGLE_QUERIES_INL_H_
#else
#define PIERCE_KERNELS_SINGLE_QUERIES_INL_H_
#endif

#include "kernels/rays/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// First those of a ray that does not move along some axes. Apart, for there are few.
inline HWY_NOINLINE Candidate closest_still(const bvh::Tree& tree, const FilterRay& ray,
                                            std::uint32_t skip, Resolver& resolver,
                                            KernelCounts* counts, std::uint32_t still) {
  FirstHit first;
  first.tau_max = ray.tau_max;
  KernelCounts unused;
  OrderedStack stack({ray.tau_min, tree.root});
  search<true>(tree, ray, box_ray(ray), stack, skip, {resolver, 0}, first,
               counts != nullptr ? counts : &unused, LeavesOutAcross{still});
  return first.triangle;
}

inline HWY_NOINLINE bool any_still(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                                   Resolver& resolver, KernelCounts* counts, std::uint32_t still) {
  if (tree.root == bvh::kNoChild) return false;
  KernelCounts unused;
  AnyStack stack(tree.root);
  const RayResolver asked{resolver, 0};
  return traverse<true>(
      tree, ray, box_ray(ray), stack, skip, counts != nullptr ? counts : &unused, asked,
      [&](const Candidate& candidate, bool certain) {
        TauInterval tau;
        return asked.takes(ray, candidate, certain, tau);
      },
      LeavesOutAcross{still});
}

inline HWY_NOINLINE void all_still(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                                   CandidateSink& sink, KernelCounts* counts, std::uint32_t still) {
  if (tree.root == bvh::kNoChild) return;
  KernelCounts unused;
  AnyStack stack(tree.root);
  traverse<true>(
      tree, ray, box_ray(ray), stack, skip, counts != nullptr ? counts : &unused, RaySink{sink},
      [&](const Candidate& candidate, bool certain) {
        sink.add(candidate, certain);
        return false;
      },
      LeavesOutAcross{still});
}

inline Candidate closest(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                         Resolver& resolver, KernelCounts* counts) {
  if (tree.root == bvh::kNoChild) return {};
  if (zero_axes(ray) != 0) [[unlikely]] {
    const std::uint32_t still = resolver.still_axes(0);
    if (still != 0) return closest_still(tree, ray, skip, resolver, counts, still);
  }
  FirstHit first;
  first.tau_max = ray.tau_max;
  search(tree, ray, tree.root, skip, {resolver, 0}, first, counts);
  return first.triangle;
}

inline bool any(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, Resolver& resolver,
                KernelCounts* counts) {
  if (zero_axes(ray) != 0) [[unlikely]] {
    const std::uint32_t still = resolver.still_axes(0);
    if (still != 0) return any_still(tree, ray, skip, resolver, counts, still);
  }
  return any_below(tree, ray, tree.root, skip, {resolver, 0}, counts);
}

inline void all(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                CandidateSink& sink, KernelCounts* counts) {
  if (zero_axes(ray) != 0) [[unlikely]] {
    const std::uint32_t still = sink.still_axes();
    if (still != 0) return all_still(tree, ray, skip, sink, counts, still);
  }
  traverse(tree, ray, tree.root, skip, counts, RaySink{sink},
           [&](const Candidate& candidate, bool certain) {
             sink.add(candidate, certain);
             return false;
           });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
