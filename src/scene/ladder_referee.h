// SPDX-License-Identifier: Apache-2.0
//
// The referee of one ray: takes the candidates that a kernel could not tell through the ladder, and
// remembers what it decided.
#pragma once

#include <cstdint>

#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "scene/geometries.h"

namespace pierce::scene {

template <class Real>
class LadderReferee final : public kernels::Referee {
 public:
  LadderReferee(const Geometries<Real>& geometries, const predicate::RayD& ray,
                const bvh::PlacedRay& placed, predicate::LadderCounts& counts)
      : geometries_(geometries), ray_(ray), placed_(placed), counts_(counts) {}

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    predicate::DecidedHit hit;
    if (!predicate::decide_hit(ray_, geometries_.triangle(candidate), hit, counts_)) return false;
    tau = tau_interval(hit);
    remembered_ = hit;
    remembered_number_ = candidate.primitive;
    return true;
  }

  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    if (best_number_ != best.primitive) set_best(best.primitive, decided(best));
    const predicate::DecidedHit hit = decided(challenger);
    const auto order = predicate::decide_order(ray_, hit, best_, counts_);
    const bool before = order < 0 || (order == 0 && challenger.primitive < best.primitive);
    if (before) set_best(challenger.primitive, hit);
    return before;
  }

  /// What is known of a triangle that is surely hit.
  predicate::DecidedHit decided(const kernels::Candidate& candidate) {
    if (candidate.primitive == remembered_number_) return remembered_;
    if (candidate.primitive == best_number_) return best_;
    predicate::DecidedHit hit;
    predicate::decide_hit(ray_, geometries_.triangle(candidate), hit, counts_);
    return hit;
  }

 private:
  [[nodiscard]] kernels::TauInterval tau_interval(const predicate::DecidedHit& hit) const {
    // What tau() and the cast to float may lose (2^-50 and 2^-22) is covered by the pad. An exactly
    // placed ray's shift is rounded: its hits' places are not told apart in float.
    if (placed_.exactly) return {-bvh::kTauLimit, bvh::kTauLimit};
    return {static_cast<float>(placed_.tau(hit.t.low) - kernels::kTauPad),
            static_cast<float>(placed_.tau(hit.t.high) + kernels::kTauPad)};
  }

  void set_best(std::uint32_t number, const predicate::DecidedHit& hit) {
    best_ = hit;
    best_number_ = number;
  }

  const Geometries<Real>& geometries_;
  const predicate::RayD& ray_;
  const bvh::PlacedRay& placed_;
  predicate::LadderCounts& counts_;
  predicate::DecidedHit remembered_, best_;
  std::uint32_t remembered_number_ = kNone, best_number_ = kNone;
};

}  // namespace pierce::scene
