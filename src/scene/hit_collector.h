// SPDX-License-Identifier: Apache-2.0
//
// The referees of the queries about all hits: they take every candidate through the ladder, and
// keep the hits or count them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "scene/geometries.h"
#include "scene/once_each.h"
#include "scene/sight.h"
#include "scene/stop_poll.h"

namespace pierce::scene {

template <class Real>
class HitCollector final : public kernels::Referee {
 public:
  HitCollector(const Geometries<Real>& geometries, StopPoll stop, predicate::LadderCounts& counts)
      : geometries_(geometries), stop_(std::move(stop)), counts_(counts) {}

  /// Starts on another ray; forgets the hits of the last one.
  void start(const predicate::RayD& ray, const Sight& sight) {
    ray_ = ray;
    sight_ = sight;
    found_.clear();
  }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    stop_.sometimes();
    if (!sight_.sees(geometries_, candidate.primitive)) return false;
    Found found;
    found.primitive = candidate.primitive;
    if (!predicate::decide_hit(ray_, geometries_.triangle(candidate), found.hit, counts_)) {
      return false;
    }
    if (!sight_.sees(found.hit.facing)) return false;
    found_.push_back(found);
    tau = {-bvh::kTauLimit, bvh::kTauLimit};
    return true;
  }

  bool is_before(const kernels::Candidate&, const kernels::Candidate&) override {
    return false;  // an all-hits walk never asks
  }

  /// Appends the hits of this ray to `out`, in order, each triangle once, and `most` at most.
  void append_ordered(std::uint64_t most, std::vector<Hit<Real>>& out) {
    // By number first; a stable order by t then leaves equal t in the order of the numbers.
    once_each(found_);
    const auto by_t = [this](const Found& a, const Found& b) {
      stop_.sometimes();
      return predicate::decide_order(ray_, a.hit, b.hit, counts_);
    };
    if (most < found_.size()) {
      const auto last = found_.begin() + static_cast<std::ptrdiff_t>(most);
      std::partial_sort(found_.begin(), last, found_.end(), [&](const Found& a, const Found& b) {
        const auto order = by_t(a, b);
        return order < 0 || (order == 0 && a.primitive < b.primitive);
      });
      found_.erase(last, found_.end());
    } else if (found_.size() > 1) {  // a sort of one would still ask for memory
      std::ranges::stable_sort(found_,
                               [&](const Found& a, const Found& b) { return by_t(a, b) < 0; });
    }
    for (const Found& found : found_) {
      stop_.sometimes();
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
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  Sight sight_;
  std::vector<Found> found_;
};

template <class Real>
class HitCounter final : public kernels::Referee {
 public:
  HitCounter(const Geometries<Real>& geometries, StopPoll stop, predicate::LadderCounts& counts)
      : geometries_(geometries), stop_(std::move(stop)), counts_(counts) {}

  void start(const predicate::RayD& ray, const Sight& sight) {
    ray_ = ray;
    sight_ = sight;
    found_.clear();
  }

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval&) override {
    stop_.sometimes();
    if (!sight_.sees(geometries_, candidate.primitive)) return false;
    predicate::DecidedHit hit;
    if (predicate::decide_hit(ray_, geometries_.triangle(candidate), hit, counts_) &&
        sight_.sees(hit.facing)) {
      found_.push_back({candidate.primitive});
    }
    return false;
  }

  bool is_before(const kernels::Candidate&, const kernels::Candidate&) override {
    return false;  // an all-hits walk never asks
  }

  /// How many triangles this ray hits.
  [[nodiscard]] std::uint32_t count() {
    once_each(found_);
    return static_cast<std::uint32_t>(found_.size());
  }

 private:
  struct Found {
    std::uint32_t primitive;
  };

  const Geometries<Real>& geometries_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  predicate::RayD ray_;
  Sight sight_;
  std::vector<Found> found_;
};

}  // namespace pierce::scene
