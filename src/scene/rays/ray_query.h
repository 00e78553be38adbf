// SPDX-License-Identifier: Apache-2.0
//
// One ray on its way through a scene, as long as what it was given lives.
#pragma once

#include <optional>
#include <type_traits>

#include "kernels/kernel.h"
#include "scene/rays/ladder_resolver.h"
#include "scene/rays/ray_transform.h"
#include "scene/rays/two_level_query.h"

namespace pierce::scene {

template <class Real>
class RayQuery {
 public:
  /// `counts`: what the ladder adds to, if anybody wants to know.
  RayQuery(const kernels::Kernel& kernel, const Geometries<Real>& geometries, const Ray<Real>& ray,
           Range range, const Sight& sight, predicate::LadderCounts* counts = nullptr,
           StopPoll stop = {})
      : kernel_(kernel),
        geometries_(geometries),
        ray_(ray),
        range_(range),
        sight_(sight),
        counts_(counts),
        stop_(stop),
        transformed_(transform(kernel, geometries, ray, range, filter_ray_)),
        resolver_(*this) {
    sight.tell(filter_ray_);
  }
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  /// Its line misses the scene's box.
  [[nodiscard]] bool misses() const { return transformed_.misses; }
  [[nodiscard]] const space::FilterRay& filter_ray() const { return filter_ray_; }
  [[nodiscard]] kernels::Resolver& resolver() { return resolver_; }

  /// Two levels, if there are, are traversed instead of the tree.
  kernels::Candidate closest(const bvh::Tree& tree, const TwoLevel<Real>* two_level,
                             kernels::KernelCounts* counts) {
    if (two_level != nullptr) [[unlikely]]
      return in_two_levels(*two_level, counts, [this](const TwoLevelRay<Real>& ray) {
        return ray.closest([this]() -> RayLadder<Real>& { return resolver_.ladder(0); });
      });
    return kernel_.closest(tree, filter_ray_, sight_.skip, resolver_, counts);
  }
  bool any(const bvh::Tree& tree, const TwoLevel<Real>* two_level, kernels::KernelCounts* counts) {
    if (two_level != nullptr) [[unlikely]]
      return in_two_levels(*two_level, counts, [this](const TwoLevelRay<Real>& ray) {
        return ray.any([this]() -> RayLadder<Real>& { return resolver_.ladder(0); });
      });
    return kernel_.any(tree, filter_ray_, sight_.skip, resolver_, counts);
  }

  /// The numbers and names of the winner.
  void finish(const kernels::Candidate& winner, Hit<Real>& hit) {
    RayLadder<Real>* const asked = resolver_.remembered(0);
    if (asked != nullptr) {
      hit = asked->rounded(winner, kernel_);
    } else if (!round_certain(winner, hit)) {
      hit = ladder(0).rounded(winner, kernel_);
    }
    const TriangleRef ref = geometries_.ref(winner.primitive);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
  }

  /// For the resolver.
  [[nodiscard]] const Geometries<Real>& geometries() const { return geometries_; }
  [[nodiscard]] std::uint32_t mask(std::uint32_t) const { return sight_.mask; }
  [[nodiscard]] const Vec3<Real>& direction(std::uint32_t) const { return ray_.direction; }
  RayLadder<Real> ladder(std::uint32_t) {
    return {geometries_, predicate::to_double(ray_, range_), sight_,
            counts_ != nullptr ? *counts_ : uncounted_.emplace(), stop_};
  }

 private:
  template <class Ask>
  auto in_two_levels(const TwoLevel<Real>& two_level, kernels::KernelCounts* counts,
                     const Ask& ask) {
    const space::TransformedRay transformed =
        geometries_.space().transform(predicate::to_double(ray_, range_));
    return ask(TwoLevelRay<Real>{kernel_, two_level, filter_ray_, transformed, sight_.skip,
                                 sight_.unlimited(), counts});
  }

  // A winner that the kernel was certain of. False if its numbers are not certain.
  bool round_certain(const kernels::Candidate& winner, Hit<Real>& hit) const {
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact && transformed_.in_lanes) {
        return kernel_.round_copy(filter_ray_, winner, hit);
      }
    }
    return kernel_.of<Real>().round_one(predicate::to_double(ray_, range_),
                                        geometries_.triangle(winner), hit);
  }

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  const Ray<Real>& ray_;
  Range range_;
  const Sight& sight_;
  predicate::LadderCounts* counts_;
  StopPoll stop_;
  space::FilterRay filter_ray_;
  Transformed transformed_;
  LadderResolver<Real, RayQuery, 1> resolver_;
  std::optional<predicate::LadderCounts> uncounted_;  // counters that are discarded
};

}  // namespace pierce::scene
