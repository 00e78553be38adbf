// SPDX-License-Identifier: Apache-2.0
//
// The referee of a crossings query: takes every candidate through the ladder and counts passages.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/kernel.h"
#include "predicate/passage.h"
#include "scene/geometries.h"
#include "scene/once_each.h"
#include "scene/sight.h"
#include "scene/stop_poll.h"

namespace pierce::scene {

template <class Real>
class PassageCounter final : public kernels::Referee {
 public:
  PassageCounter(const Geometries<Real>& geometries, StopPoll stop, predicate::LadderCounts& counts)
      : geometries_(geometries), stop_(std::move(stop)), counts_(counts) {}

  /// Starts on another ray; forgets the passages of the last one.
  void start(const predicate::RayD& ray, const Sight& sight) {
    ray_ = ray;
    sight_ = sight;
    found_.clear();
  }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval&) override {
    stop_.sometimes();
    if (!sight_.sees(geometries_, candidate.primitive)) return false;
    const auto passage = predicate::decide_passage(ray_, geometries_.triangle(candidate), counts_);
    if (passage != predicate::Passage::None && sight_.sees(passage)) {
      found_.push_back({candidate.primitive, passage});
    }
    return false;
  }

  bool is_before(const kernels::Candidate&, const kernels::Candidate&) override {
    return false;  // an all-hits walk never asks
  }

  /// The passages of this ray, each triangle counted once even if it was found in two leaves.
  void count(Crossings& crossings) {
    once_each(found_);
    crossings.count = static_cast<std::uint32_t>(found_.size());
    crossings.signed_count = 0;
    for (const Found& found : found_) {
      crossings.signed_count += static_cast<std::int32_t>(found.passage);
    }
  }

 private:
  struct Found {
    std::uint32_t primitive;
    predicate::Passage passage;
  };

  const Geometries<Real>& geometries_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  Sight sight_;
  std::vector<Found> found_;
};

}  // namespace pierce::scene
