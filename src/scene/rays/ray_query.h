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
        resolver_(*this) {}
  RayQuery(const RayQuery&) = delete;
  RayQuery& operator=(const RayQuery&) = delete;

  /// The first hit; false if there is none, and `hit` then is as it was. Two levels, if there are,
  /// are traversed instead of the tree. Throws Error (InvalidRay) if the ray is not valid.
  [[gnu::always_inline]] bool closest(const bvh::Tree& tree, const TwoLevel<Real>* two_level,
                                      kernels::KernelCounts* counts, Hit<Real>& hit) {
    kernels::Candidate winner;
    kernels::Straight straight = kernels::Straight::NotServed;
    if (may_go_straight(two_level) && counts == nullptr)
      straight = closest_straight(tree, winner, hit);
    if (straight == kernels::Straight::Miss) return false;
    if (straight != kernels::Straight::Rounded &&
        !go_on(straight, tree, two_level, counts, winner, hit))
      return false;
    const TriangleRef ref = geometries_.ref(winner.primitive);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
    return true;
  }

  bool any(const bvh::Tree& tree, const TwoLevel<Real>* two_level) {
    if (may_go_straight(two_level)) {
      const kernels::Straight straight = any_straight(tree);
      if (straight != kernels::Straight::NotServed) [[likely]]
        return straight == kernels::Straight::Hit;
    }
    if (!transform()) return false;
    if (two_level == nullptr)
      return kernel_.any(tree, filter_ray_, sight_.skip, resolver_, nullptr);
    return in_two_levels(*two_level, nullptr, [this](const TwoLevelRay<Real>& ray) {
      return ray.any([this]() -> RayLadder<Real>& { return resolver_.ladder(0); });
    });
  }

  /// For the resolver.
  [[nodiscard]] const Geometries<Real>& geometries() const { return geometries_; }
  [[nodiscard]] std::uint32_t mask(std::uint32_t) const { return sight_.mask; }
  [[nodiscard]] const Ray<Real>& ray(std::uint32_t) const { return ray_; }
  [[nodiscard]] Range range() const { return range_; }
  [[nodiscard]] const kernels::Kernel& kernel() const { return kernel_; }
  [[nodiscard]] bool unlimited(std::uint32_t) const { return sight_.unlimited(); }
  [[nodiscard]] predicate::LadderCounts& counts() {
    if (counts_ != nullptr) return *counts_;
    return uncounted_ ? *uncounted_ : uncounted_.emplace();
  }
  RayLadder<Real> ladder(std::uint32_t) {
    return {geometries_, predicate::to_double(ray_, range_), sight_, counts(), stop_};
  }

 private:
  // From where the straight way ended to the hit's numbers; false if there is no hit.
  [[gnu::noinline]] bool go_on(kernels::Straight straight, const bvh::Tree& tree,
                               const TwoLevel<Real>* two_level, kernels::KernelCounts* counts,
                               kernels::Candidate& winner, Hit<Real>& hit) {
    if (straight == kernels::Straight::NotServed) [[unlikely]] {
      if (!transform()) return false;
      winner = closest(tree, two_level, counts);
      if (winner.primitive == kNone) return false;
    }
    if (straight == kernels::Straight::NotRounded) [[unlikely]] {
      if (!round_finely(winner, hit)) hit = ladder(0).rounded_alone(winner);
    } else {
      round(winner, hit);
    }
    return true;
  }

  // Others have to go step by step.
  [[nodiscard]] bool may_go_straight(const TwoLevel<Real>* two_level) const {
    return two_level == nullptr && sight_.skip == kNone && sight_.unlimited();
  }

  kernels::Straight closest_straight(const bvh::Tree& tree, kernels::Candidate& winner,
                                     Hit<Real>& hit) {
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.only_scaled() && geometries_.copies_usable()) [[likely]]
        return kernel_.closest_scaled(tree, geometries_.space().float_scale(), ray_, resolver_,
                                      winner, hit);
    }
    const space::AffineMap& map = geometries_.affine_map();
    if (!map.usable) return kernels::Straight::NotServed;
    return kernel_.of<Real>().closest_straight(tree, map, ray_, resolver_, winner);
  }

  kernels::Straight any_straight(const bvh::Tree& tree) {
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.only_scaled()) [[likely]]
        return kernel_.any_scaled(tree, geometries_.space().float_scale(), ray_, resolver_);
    }
    const space::AffineMap& map = geometries_.affine_map();
    if (!map.usable) return kernels::Straight::NotServed;
    return kernel_.of<Real>().any_straight(tree, map, ray_, resolver_);
  }

  // False if its line misses the scene's box.
  bool transform() {
    const Transformed done = scene::transform(kernel_, geometries_, ray_, range_, filter_ray_);
    sight_.tell(filter_ray_);
    in_lanes_ = done.in_lanes;
    return !done.misses;
  }

  kernels::Candidate closest(const bvh::Tree& tree, const TwoLevel<Real>* two_level,
                             kernels::KernelCounts* counts) {
    if (two_level == nullptr)
      return kernel_.closest(tree, filter_ray_, sight_.skip, resolver_, counts);
    return in_two_levels(*two_level, counts, [this](const TwoLevelRay<Real>& ray) {
      return ray.closest([this]() -> RayLadder<Real>& { return resolver_.ladder(0); });
    });
  }

  template <class Ask>
  auto in_two_levels(const TwoLevel<Real>& two_level, kernels::KernelCounts* counts,
                     const Ask& ask) {
    const space::TransformedRay transformed =
        geometries_.space().transform(predicate::to_double(ray_, range_));
    return ask(TwoLevelRay<Real>{kernel_, two_level, filter_ray_, transformed, sight_.skip,
                                 sight_.unlimited(), counts});
  }

  // The winner's numbers.
  void round(const kernels::Candidate& winner, Hit<Real>& hit) {
    RayLadder<Real>* const asked = resolver_.remembered(0);
    if (asked != nullptr) {
      hit = asked->rounded(winner, kernel_);
    } else if (winner.zeros != 0) {
      hit = ladder(0).rounded(winner, kernel_);
    } else if (!round_certain(winner, hit)) {
      hit = round_one<Real>(kernel_, predicate::to_double(ray_, range_),
                            geometries_.triangle(winner), 0, counts());
    }
  }

  // A hit of which double is not certain; false if more bits are not enough.
  bool round_finely(const kernels::Candidate& winner, Hit<Real>& hit) {
    if constexpr (std::is_same_v<Real, float>) {
      return kernel_.round_finely(predicate::to_double(ray_, range_), geometries_.triangle(winner),
                                  0, hit);
    }
    return false;
  }

  // Of a winner that the kernel was certain of. False if its numbers are not certain.
  bool round_certain(const kernels::Candidate& winner, Hit<Real>& hit) {
    if constexpr (std::is_same_v<Real, float>) {
      if (!in_lanes_ && geometries_.copies_usable())
        in_lanes_ = transform_in_lanes<Real>(kernel_, geometries_, {&ray_, 1}, &filter_ray_) == 1;
      if (geometries_.copies_usable() && in_lanes_ && filter_ray_.exact)
        return kernel_.round_copy(filter_ray_, winner, hit) || round_finely(winner, hit);
    }
    if constexpr (std::is_same_v<Real, double>) {
      if (geometries_.copies_in_order())
        return kernel_.round_unscaled(ray_, winner, geometries_.space().unscale(), hit);
      if (const auto vertices = geometries_.vertices_in_place(winner.primitive)) {
        const auto& [a, b, c] = *vertices;
        return kernel_.round_in_place(ray_, *a, *b, *c, hit);
      }
    }
    Hit<Real> high;
    return kernel_.of<Real>().round_one(predicate::to_double(ray_, range_),
                                        geometries_.triangle(winner), 0, hit,
                                        high) == kernels::Rounded::All;
  }

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  const Ray<Real>& ray_;
  Range range_;
  const Sight& sight_;
  predicate::LadderCounts* counts_;
  StopPoll stop_;
  space::FilterRay filter_ray_;
  bool in_lanes_ = false;  // transformed so
  LadderResolver<Real, RayQuery, 1> resolver_;
  std::optional<predicate::LadderCounts> uncounted_;  // counters that are discarded
};

}  // namespace pierce::scene
