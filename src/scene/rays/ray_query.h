// SPDX-License-Identifier: Apache-2.0
//
// One ray on its way through a scene, as long as what it was given lives. The road that it took and
// its resolver are made only when there is something to ask: most rays get through in float.
#pragma once

#include <optional>
#include <type_traits>

#include "kernels/kernel.h"
#include "scene/rays/ladder_resolver.h"
#include "scene/rays/ray_transform.h"

namespace pierce::scene {

template <class Real>
class RayQuery final : public kernels::Resolver {
 public:
  RayQuery(const kernels::Kernel& kernel, const Geometries<Real>& geometries, const Ray<Real>& ray,
           Range range, const Sight& sight)
      : kernel_(kernel), geometries_(geometries), ray_(ray), range_(range), sight_(sight) {
    if (!transform_ray(kernel, geometries, ray, filter_ray_)) {
      road_.emplace(kernel, geometries, ray, range);
      if (road_->misses()) return;
      filter_ray_ = road_->filter_ray();
    }
    if (!sight.unlimited()) kernels::doubt_all_hits(filter_ray_);
  }

  /// The line passes the scene's box by.
  [[nodiscard]] bool misses() const { return road_.has_value() && road_->misses(); }
  [[nodiscard]] const kernels::FilterRay& filter_ray() const { return filter_ray_; }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    return resolver().is_hit(candidate, tau);
  }
  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    return resolver().is_before(challenger, best);
  }

  /// The numbers and names of the winner.
  void finish(const kernels::Candidate& winner, Hit<Real>& hit) {
    if (!round_quickly(winner, hit)) hit = resolver().rounded(winner, kernel_);
    const TriangleRef ref = geometries_.ref(winner.primitive);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
  }

 private:
  // False if it is not certain. Where there is no resolver, the kernel was certain of the winner.
  bool round_quickly(const kernels::Candidate& winner, Hit<Real>& hit) const {
    if (asked_) return false;
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact && !road_) {
        return kernel_.round_copy(filter_ray_, winner, hit);
      }
    }
    return kernel_.round_one(predicate::to_double(ray_, range_), geometries_.triangle(winner), hit);
  }

  LadderResolver<Real>& resolver() {
    if (!asked_) {
      if (!road_) road_.emplace(kernel_, geometries_, ray_, range_);
      asked_.emplace(geometries_, *road_, sight_);
    }
    return asked_->resolver;
  }

  // A resolver, and what it counts, which nobody wants to know.
  struct Asked {
    Asked(const Geometries<Real>& geometries, Road<Real>& road, const Sight& sight)
        : resolver(geometries, road, sight, counts) {}
    predicate::LadderCounts counts;
    LadderResolver<Real> resolver;
  };

  const kernels::Kernel& kernel_;
  const Geometries<Real>& geometries_;
  const Ray<Real>& ray_;
  Range range_;
  const Sight& sight_;
  kernels::FilterRay filter_ray_;
  std::optional<Road<Real>> road_;
  std::optional<Asked> asked_;
};

}  // namespace pierce::scene
