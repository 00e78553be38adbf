// SPDX-License-Identifier: Apache-2.0
//
// The resolver of one ray: takes the candidates that a kernel could not tell through the ladder,
// and remembers what it decided.
#pragma once

#include <cstdint>

#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "scene/geometries.h"
#include "scene/rays/ray_transform.h"
#include "scene/rays/sight.h"
#include "support/stop_poll.h"

namespace pierce::scene {

template <class Real>
class LadderResolver final : public kernels::Resolver {
 public:
  LadderResolver(const Geometries<Real>& geometries, Road<Real>& road, const Sight& sight,
                 predicate::LadderCounts& counts, StopPoll stop = {})
      : geometries_(geometries),
        road_(road),
        ray_(road.ray()),
        sight_(sight),
        counts_(counts),
        stop_(stop) {}

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) override {
    stop_.sometimes();
    if (!sight_.sees(geometries_, candidate.primitive)) return false;
    predicate::DecidedHit hit;
    if (!predicate::decide_hit(ray_, geometries_.triangle(candidate), hit, counts_)) return false;
    if (!sight_.sees(ray_, hit, candidate.primitive, counts_)) return false;
    tau = tau_interval(hit);
    remembered_ = hit;
    remembered_number_ = candidate.primitive;
    return true;
  }

  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) override {
    stop_.sometimes();
    if (best_number_ != best.primitive) set_best(best.primitive, decided(best));
    const predicate::DecidedHit hit = decided(challenger);
    const auto order = predicate::decide_order(ray_, hit, best_, counts_);
    const bool before = order < 0 || (order == 0 && challenger.primitive < best.primitive);
    if (before) set_best(challenger.primitive, hit);
    return before;
  }

  /// The numbers of a triangle that is surely hit.
  Hit<Real> rounded(const kernels::Candidate& candidate, const kernels::Kernel& kernel) {
    if (candidate.primitive == remembered_number_) return rounded(remembered_, kernel);
    if (candidate.primitive == best_number_) return rounded(best_, kernel);
    return rounded(geometries_.triangle(candidate), 0, kernel);
  }

 private:
  Hit<Real> rounded(const predicate::DecidedHit& hit, const kernels::Kernel& kernel) {
    return rounded(hit.triangle, hit.zeros, kernel);
  }
  Hit<Real> rounded(const predicate::TriangleD& triangle, std::uint8_t zeros,
                    const kernels::Kernel& kernel) {
    Hit<Real> hit;
    if (zeros == 0 && kernel.round_one(ray_, triangle, hit)) [[likely]]
      return hit;
    return predicate::round_hit<Real>(ray_, triangle, zeros, counts_);
  }

  // What is known of a triangle that is surely hit.
  predicate::DecidedHit decided(const kernels::Candidate& candidate) {
    if (candidate.primitive == remembered_number_) return remembered_;
    if (candidate.primitive == best_number_) return best_;
    predicate::DecidedHit hit;
    predicate::decide_hit(ray_, geometries_.triangle(candidate), hit, counts_);
    return hit;
  }

  [[nodiscard]] kernels::TauInterval tau_interval(const predicate::DecidedHit& hit) {
    const bvh::TransformedRay& transformed = road_.transformed();
    // What tau() and the cast to float may lose (2^-50 and 2^-22) is covered by the pad. An exactly
    // placed ray's shift is rounded: its hits' places are not told apart in float.
    if (transformed.exactly) return {-bvh::kTauLimit, bvh::kTauLimit};
    return {static_cast<float>(transformed.tau(hit.t.low) - kernels::kTauPad),
            static_cast<float>(transformed.tau(hit.t.high) + kernels::kTauPad)};
  }

  void set_best(std::uint32_t number, const predicate::DecidedHit& hit) {
    best_ = hit;
    best_number_ = number;
  }

  const Geometries<Real>& geometries_;
  Road<Real>& road_;
  const predicate::RayD& ray_;
  const Sight sight_;
  predicate::LadderCounts& counts_;
  StopPoll stop_;
  predicate::DecidedHit remembered_, best_;
  std::uint32_t remembered_number_ = kNone, best_number_ = kNone;
};

}  // namespace pierce::scene
