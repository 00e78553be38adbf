// SPDX-License-Identifier: Apache-2.0
//
// What the listeners of the queries about all hits share: they take every candidate through the
// ladder, and note what they find.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/kernel.h"
#include "predicate/ladder_counts.h"
#include "predicate/types.h"
#include "scene/geometries.h"
#include "scene/rays/sight.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// `Found` is a note about one triangle, its number in `primitive`.
template <class Real, class Found>
class LadderSink : public kernels::CandidateSink {
 public:
  LadderSink(const Geometries<Real>& geometries, StopPoll stop, predicate::LadderCounts& counts)
      : geometries_(geometries), stop_(std::move(stop)), counts_(counts) {}

  /// Starts on another ray; forgets what was found on the last one.
  void start(const predicate::RayD& ray, const Sight& sight) {
    ray_ = ray;
    sight_ = sight;
    found_.clear();
  }

  std::uint32_t still_axes() override { return predicate::still_axes(ray_.direction); }
  kernels::TRange t_range() override { return {ray_.t_min, ray_.t_max, ray_.open_start}; }
  bool is_whole(const kernels::FilterRay& of) override {
    return geometries_.is_whole(ray_.origin, ray_.direction, of);
  }

 protected:
  /// Whether the ray sees the candidate's geometry. To be asked of each: it polls stop, too.
  [[nodiscard]] bool sees(const kernels::Candidate& candidate) {
    stop_.sometimes();
    return sight_.sees(geometries_, candidate.primitive);
  }

  /// What was found, each triangle once, in the order of their numbers: a triangle that lies in two
  /// leaves is found twice.
  std::vector<Found>& found_once() {
    const auto same = [](const Found& a, const Found& b) { return a.primitive == b.primitive; };
    std::sort(found_.begin(), found_.end(), [this](const Found& a, const Found& b) {
      stop_.sometimes();
      return a.primitive < b.primitive;
    });
    found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
    return found_;
  }

  const Geometries<Real>& geometries_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  Sight sight_;
  std::vector<Found> found_;
};

}  // namespace pierce::scene
