// SPDX-License-Identifier: Apache-2.0
//
// The referee of a crossings query: takes every candidate through the ladder and counts passages.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/kernel.h"
#include "predicate/passage.h"
#include "scene/geometries.h"

namespace pierce::scene {

template <class Real>
class PassageCounter final : public kernels::Referee {
 public:
  PassageCounter(const Geometries<Real>& geometries, predicate::LadderCounts& counts)
      : geometries_(geometries), counts_(counts) {}

  /// Starts on another ray; forgets the passages of the last one.
  void start(const predicate::RayD& ray) {
    ray_ = ray;
    found_.clear();
  }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval&) override {
    const auto passage = predicate::decide_passage(ray_, geometries_.triangle(candidate), counts_);
    if (passage != predicate::Passage::None) found_.push_back({candidate.primitive, passage});
    return false;
  }

  bool is_before(const kernels::Candidate&, const kernels::Candidate&) override {
    return false;  // an all-hits walk never asks
  }

  /// The passages of this ray, each triangle counted once even if it was found in two leaves.
  void count(Crossings& crossings) {
    const auto by_number = [](const Found& a, const Found& b) { return a.primitive < b.primitive; };
    const auto same = [](const Found& a, const Found& b) { return a.primitive == b.primitive; };
    std::sort(found_.begin(), found_.end(), by_number);
    found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
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
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  std::vector<Found> found_;
};

}  // namespace pierce::scene
