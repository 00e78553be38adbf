// SPDX-License-Identifier: Apache-2.0
//
// The referee of an all-hits query: takes every candidate through the ladder and keeps the hits.
#pragma once

#include <algorithm>
#include <vector>

#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "scene/geometries.h"

namespace pierce::scene {

template <class Real>
class HitCollector final : public kernels::Referee {
 public:
  HitCollector(const Geometries<Real>& geometries, predicate::LadderCounts& counts)
      : geometries_(geometries), counts_(counts) {}

  /// Starts on another ray; forgets the hits of the last one.
  void start(const predicate::RayD& ray) {
    ray_ = ray;
    found_.clear();
  }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    Found found;
    found.primitive = candidate.primitive;
    if (!predicate::decide_hit(ray_, geometries_.triangle(candidate), found.hit, counts_)) {
      return false;
    }
    found_.push_back(found);
    tau = {-bvh::kTauLimit, bvh::kTauLimit};
    return true;
  }

  bool is_before(const kernels::Candidate&, const kernels::Candidate&) override {
    return false;  // an all-hits walk never asks
  }

  /// Appends the hits of this ray to `out`, in order, each triangle once.
  void append_ordered(std::vector<Hit<Real>>& out) {
    // By number first, so that a triangle found in two leaves goes once; a stable order by t then
    // leaves equal t in the order of the numbers.
    const auto by_number = [](const Found& a, const Found& b) { return a.primitive < b.primitive; };
    const auto same = [](const Found& a, const Found& b) { return a.primitive == b.primitive; };
    const auto by_t = [this](const Found& a, const Found& b) {
      return predicate::decide_order(ray_, a.hit, b.hit, counts_) < 0;
    };
    std::sort(found_.begin(), found_.end(), by_number);
    found_.erase(std::unique(found_.begin(), found_.end(), same), found_.end());
    std::stable_sort(found_.begin(), found_.end(), by_t);
    for (const Found& found : found_) {
      Hit<Real> hit =
          predicate::round_hit<Real>(ray_, found.hit.triangle, found.hit.zeros, counts_);
      const TriangleRef ref = geometries_.ref(found.primitive);
      hit.geometry = ref.geometry;
      hit.triangle = ref.triangle;
      out.push_back(hit);
    }
  }

 private:
  struct Found {
    predicate::DecidedHit hit;
    std::uint32_t primitive;
  };

  const Geometries<Real>& geometries_;
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  std::vector<Found> found_;
};

}  // namespace pierce::scene
