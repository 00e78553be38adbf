// SPDX-License-Identifier: Apache-2.0
//
// Stands in for src/scene/ladder_referee.h in pierce_float_only: nobody is asked, what float makes
// of a triangle is taken as it is.
#pragma once

#include <cstdint>

#include "kernels/kernel.h"
#include "predicate/decide.h"
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

  /// What the cull could not discard is hit, where it says.
  bool is_hit(const kernels::Candidate&, kernels::TauInterval&) override { return true; }
  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    return challenger.primitive < best.primitive;
  }

  Hit<Real> rounded(const kernels::Candidate& candidate, const kernels::Kernel& kernel) {
    Hit<Real> hit;
    (void)kernel.round_one(road_.ray(), geometries_.triangle(candidate), hit);
    return hit;
  }

 private:
  const Geometries<Real>& geometries_;
  Road<Real>& road_;
};

}  // namespace pierce::scene
