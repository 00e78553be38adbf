// SPDX-License-Identifier: Apache-2.0
//
// Stands in for src/scene/ladder_referee.h in pierce_float_only: what the cull cannot tell is
// decided by plain float arithmetic and its signs, as a ray caster does that has no other rung. So
// both walk the same nodes (taking all such triangles as hit would end rays early), and what
// differs is the cost of deciding.
#pragma once

#include <cstdint>

#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "predicate/determinants.h"
#include "scene/geometries.h"
#include "scene/road.h"
#include "scene/sight.h"

namespace pierce::scene {

template <class Real>
class LadderReferee final : public kernels::Referee {
 public:
  LadderReferee(const Geometries<Real>& geometries, Road<Real>& road, const Sight&,
                predicate::LadderCounts&)
      : geometries_(geometries), road_(road) {}

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    const kernels::FilterRay& ray = road_.filter_ray();
    const auto f = determinants(candidate);
    const float sign = f.den < 0 ? -1.0F : 1.0F;
    if (f.den == 0 || sign * f.u < 0 || sign * f.v < 0 || sign * f.w < 0) return false;
    const float place = f.t / f.den;
    tau = {place, place};
    // The ends without their pads.
    return place >= 0.5F * (ray.tau_min + ray.tau_first) &&
           place <= 0.5F * (ray.tau_max + ray.tau_last);
  }
  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    const auto ours = determinants(challenger), theirs = determinants(best);
    const float order = ours.t / ours.den - theirs.t / theirs.den;
    return order < 0 || (order == 0 && challenger.primitive < best.primitive);
  }

  Hit<Real> rounded(const kernels::Candidate& candidate, const kernels::Kernel& kernel) {
    Hit<Real> hit;
    (void)kernel.round_one(road_.ray(), geometries_.triangle(candidate), hit);
    return hit;
  }

 private:
  [[nodiscard]] predicate::Determinants<float, float> determinants(
      const kernels::Candidate& candidate) const {
    using predicate::Triple;
    const auto point = [](const float* p, std::uint32_t stride) {
      return Triple<float>{p[0], p[stride], p[2 * stride]};
    };
    const auto corner = [&](std::uint32_t row) {
      return point(candidate.copy + row * candidate.stride, candidate.stride);
    };
    const kernels::FilterRay& ray = road_.filter_ray();
    const Triple<float> a = corner(0);
    return predicate::determinants_of(a - point(ray.origin, 1), corner(3) - a, corner(6) - a,
                                      point(ray.direction, 1));
  }

  const Geometries<Real>& geometries_;
  Road<Real>& road_;
};

}  // namespace pierce::scene
