// SPDX-License-Identifier: Apache-2.0
//
// The resolver of a nearest-point query: takes triangles through the ladder, and remembers the
// best.
#pragma once

#include <cstdint>

#include "kernels/points/nearest.h"
#include "predicate/nearest.h"
#include "scene/geometries.h"
#include "support/stop_poll.h"

namespace pierce::scene {

template <class Real>
class NearestResolver final : public kernels::NearestResolver {
 public:
  NearestResolver(const Geometries<Real>& geometries, const Vec3<double>& point,
                  predicate::LadderCounts& counts, StopPoll stop)
      : geometries_(geometries), point_(point), counts_(counts), stop_(stop) {}

  bool is_nearer(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    stop_.sometimes();
    const predicate::NearTriangle& known = near(best);
    const predicate::TriangleD triangle = geometries_.triangle(challenger);
    if (const auto tied = predicate::near_in_same_corner(point_, known, triangle)) {
      ++counts_.certified;
      ++counts_.orders_certified;
      return challenger.primitive < best.primitive && take(challenger, *tied);
    }
    if (predicate::surely_farther(point_, known, triangle)) {
      ++counts_.certified;
      ++counts_.orders_certified;
      return false;
    }
    const predicate::NearTriangle found = predicate::decide_near(point_, triangle, counts_);
    const auto order = predicate::decide_nearer(point_, found, known, counts_);
    if (order > 0 || (order == 0 && challenger.primitive > best.primitive)) return false;
    return take(challenger, found);
  }

  /// What is decided about a triangle.
  const predicate::NearTriangle& near(const kernels::Candidate& candidate) {
    if (candidate.primitive != best_primitive_) {
      best_ = predicate::decide_near(point_, geometries_.triangle(candidate), counts_);
      best_primitive_ = candidate.primitive;
    }
    return best_;
  }

 private:
  bool take(const kernels::Candidate& candidate, const predicate::NearTriangle& near) {
    best_ = near;
    best_primitive_ = candidate.primitive;
    return true;
  }

  const Geometries<Real>& geometries_;
  const Vec3<double> point_;
  predicate::LadderCounts& counts_;
  StopPoll stop_;
  predicate::NearTriangle best_;
  std::uint32_t best_primitive_ = kNone;
};

}  // namespace pierce::scene
