// SPDX-License-Identifier: Apache-2.0
//
// The exact resolver: takes candidates that a kernel could not decide through the ladder, and
// remembers what it decided of each ray.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "predicate/decide.h"
#include "scene/geometries.h"
#include "scene/rays/hit_rounding.h"
#include "scene/rays/sight.h"
#include "support/finite.h"
#include "support/stop_poll.h"

namespace pierce::scene {

/// The ladder for one ray.
template <class Real>
class RayLadder {
 public:
  RayLadder(const Geometries<Real>& geometries, const predicate::RayD& ray, const Sight& sight,
            predicate::LadderCounts& counts, StopPoll stop = {})
      : geometries_(geometries),
        ray_(ray),
        near_(ray),
        sight_(sight),
        counts_(counts),
        stop_(stop) {}

  bool is_hit(const kernels::Candidate& candidate, kernels::TauInterval& tau) {
    if (!is_hit(candidate)) return false;
    tau = tau_interval(remembered_);
    return true;
  }
  /// Fills an interval that holds its t.
  bool is_hit(const kernels::Candidate& candidate, predicate::Interval& t) {
    if (!is_hit(candidate)) return false;
    t = remembered_.t;
    return true;
  }

  bool is_before(const kernels::Candidate& challenger, const kernels::Candidate& best) {
    stop_.sometimes();
    if (best_number_ != best.primitive) set_best(best.primitive, decided(best));
    const predicate::DecidedHit hit = decided(challenger);
    const auto order = predicate::decide_order(ray_, hit, best_, counts_);
    const bool before = order < 0 || (order == 0 && challenger.primitive < best.primitive);
    if (before) set_best(challenger.primitive, hit);
    return before;
  }

  /// Which weights of the triangle, which is surely hit, are known to be zero.
  [[nodiscard]] std::uint8_t zeros(std::uint32_t primitive) const {
    if (primitive == remembered_number_) return remembered_.zeros;
    return primitive == best_number_ ? best_.zeros : std::uint8_t{0};
  }
  /// The numbers of a triangle that is surely hit.
  Hit<Real> rounded(const kernels::Candidate& candidate, const kernels::Kernel& kernel) {
    if (candidate.primitive == remembered_number_) return rounded(remembered_, kernel);
    if (candidate.primitive == best_number_) return rounded(best_, kernel);
    return rounded(geometries_.triangle(candidate), candidate.zeros, kernel);
  }
  /// The same without a kernel, which was not certain of them.
  Hit<Real> rounded_alone(const kernels::Candidate& candidate) {
    return predicate::round_hit<Real>(ray_, geometries_.triangle(candidate), candidate.zeros,
                                      counts_);
  }

 private:
  // Remembers it if so.
  bool is_hit(const kernels::Candidate& candidate) {
    stop_.sometimes();
    if (!sight_.sees(geometries_, candidate.primitive)) return false;
    predicate::DecidedHit hit;
    if (!decide(candidate, hit) || !sight_.sees(ray_, hit, candidate.primitive, counts_))
      return false;
    remembered_ = hit;
    remembered_number_ = candidate.primitive;
    near_.t_max = std::min(near_.t_max, surely_beyond(hit.t));
    return true;
  }

  // A triangle that is hit where the one that is remembered is, in a corner or on an edge of both,
  // comes before it or after it by its number.
  bool decide(const kernels::Candidate& candidate, predicate::DecidedHit& hit) {
    const predicate::TriangleD triangle = geometries_.triangle(candidate);
    std::uint8_t zeros = 0;
    if (remembered_number_ != kNone &&
        predicate::meets_same_feature(remembered_, triangle, zeros)) {
      if (candidate.primitive >= remembered_number_) return false;
      if (predicate::certify_same_point(ray_, triangle, zeros, remembered_.t, hit)) {
        ++counts_.certified;
        return true;
      }
    }
    return predicate::decide_hit(near_, triangle, hit, counts_);
  }

  // So far beyond a hit that double tells it from all that has the hit's own t.
  static double surely_beyond(const predicate::Interval& t) {
    const double beyond = t.high + 8 * (t.high - t.low) + 0x1p-40 * std::fabs(t.high);
    return is_nan(beyond) ? std::numeric_limits<double>::infinity() : beyond;
  }

  Hit<Real> rounded(const predicate::DecidedHit& hit, const kernels::Kernel& kernel) {
    return rounded(hit.triangle, hit.zeros, kernel);
  }
  Hit<Real> rounded(const predicate::TriangleD& triangle, std::uint8_t zeros,
                    const kernels::Kernel& kernel) {
    return round_one<Real>(kernel, ray_, triangle, zeros, counts_);
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
    if (!transformed_) transformed_ = geometries_.space().transform(ray_);
    // What tau() and the cast to float may lose (2^-50 and 2^-22) is covered by the pad. An exactly
    // placed ray's shift is rounded: its hits' places are not told apart in float.
    if (transformed_->exactly) return {-space::kTauLimit, space::kTauLimit};
    const double low = transformed_->tau(hit.t.low), high = transformed_->tau(hit.t.high);
    return {static_cast<float>(low - transformed_->tau_pad(low)),
            static_cast<float>(high + transformed_->tau_pad(high))};
  }

  void set_best(std::uint32_t number, const predicate::DecidedHit& hit) {
    best_ = hit;
    best_number_ = number;
  }

  const Geometries<Real>& geometries_;
  predicate::RayD ray_;
  predicate::RayD near_;  // the same, but what is beyond a known hit is none: it is not the first
  Sight sight_;
  predicate::LadderCounts& counts_;
  StopPoll stop_;
  std::optional<space::TransformedRay> transformed_;  // once tau is asked for
  predicate::DecidedHit remembered_, best_;
  std::uint32_t remembered_number_ = kNone, best_number_ = kNone;
};

/// The resolver of up to `kRays` rays. Most get through in float, so a ray's ladder is made when it
/// is first asked about, by `query.ladder(ray)`; and as only some rays are in flight at a time, few
/// ladders serve them in turn. What a ladder remembers may be forgotten at any time.
template <class Real, class Query, std::uint32_t kRays>
class LadderResolver final : public kernels::Resolver {
 public:
  explicit LadderResolver(Query& query) : query_(query) {}

  /// Starts on so many other rays.
  void start(std::uint32_t count) requires(kRays > 1) {
    std::fill_n(place_.data(), count, kNowhere);
    std::fill_n(zeros_.data(), count, Zeros{});
  }

  bool is_hit(std::uint32_t ray, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    if constexpr (std::is_same_v<Real, double>) {
      const predicate::Certified answer = decide_in_lanes(ray, candidate, tau);
      if (answer != predicate::Certified::Unsure) return answer == predicate::Certified::Yes;
    }
    RayLadder<Real>& own = ladder(ray);
    const bool hit = own.is_hit(candidate, tau);
    if (hit) keep_zeros(ray, candidate.primitive, own);
    return hit;
  }
  bool is_before(std::uint32_t ray, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    // Twice the same triangle, as two-sided meshes have them, or two in the same floor: the same t,
    // whatever it is.
    if (query_.geometries().surely_tie(challenger, best))
      return challenger.primitive < best.primitive;
    RayLadder<Real>& own = ladder(ray);
    const bool before = own.is_before(challenger, best);
    keep_zeros(ray, before ? challenger.primitive : best.primitive, own);
    return before;
  }

  /// Which weights of a ray's winner are known to be zero, whether or not its ladder is there.
  [[nodiscard]] std::uint8_t zeros(std::uint32_t ray, const kernels::Candidate& winner) override {
    if (winner.zeros != 0) return winner.zeros;
    if constexpr (kRays > 1) {
      if (zeros_[ray].primitive == winner.primitive) return zeros_[ray].zeros;
    }
    const RayLadder<Real>* const own = remembered(ray);
    return own == nullptr ? std::uint8_t{0} : own->zeros(winner.primitive);
  }

  /// Remembers those that a ray's ladder knows, if it is there, of its winner so far.
  void keep_zeros(std::uint32_t ray, std::uint32_t primitive) {
    if (const RayLadder<Real>* const own = remembered(ray)) keep_zeros(ray, primitive, *own);
  }

  bool shares_feature(const kernels::Candidate& candidate, const kernels::Candidate& hit) override {
    return query_.geometries().has_corners(candidate, hit, predicate::kSupports[hit.zeros]);
  }

  bool sees(std::uint32_t ray, std::uint32_t primitive) override {
    return query_.geometries().is_seen(primitive, query_.mask(ray));
  }
  std::uint32_t mask_of(std::uint32_t primitive) override {
    return query_.geometries().mask_of(primitive);
  }
  std::uint32_t still_axes(std::uint32_t ray) override {
    return predicate::still_axes(query_.ray(ray).direction);
  }
  std::uint32_t still_in_place(std::uint32_t ray, const float* origin) override {
    const Vec3<double> p = predicate::to_double(query_.ray(ray).origin);
    const auto in_place = [&](double in_scene, std::uint32_t axis) {
      return query_.geometries().is_in_place(in_scene, origin[axis]) ? 1U << axis : 0U;
    };
    return still_axes(ray) & (in_place(p.x, 0) | in_place(p.y, 1) | in_place(p.z, 2));
  }

  kernels::TRange t_range(std::uint32_t ray) override {
    const Ray<Real>& own = query_.ray(ray);
    return {static_cast<double>(own.t_min), static_cast<double>(own.t_max),
            query_.range() == Range::OpenStart};
  }
  bool is_whole(std::uint32_t ray, const kernels::FilterRay& of) override {
    const Ray<Real>& own = query_.ray(ray);
    return query_.geometries().is_whole(predicate::to_double(own.origin),
                                        predicate::to_double(own.direction), of);
  }

  /// The ladder of a ray if it is there, else null.
  [[nodiscard]] RayLadder<Real>* remembered(std::uint32_t ray) {
    if constexpr (kRays == 1) {
      return ladders_ ? &*ladders_ : nullptr;
    } else {
      const std::uint8_t place = place_[ray];
      return place != kNowhere && owner_[place] == ray ? &*ladders_[place] : nullptr;
    }
  }

  /// The ladder of a ray.
  RayLadder<Real>& ladder(std::uint32_t ray) {
    if (RayLadder<Real>* const there = remembered(ray)) return *there;
    if constexpr (kRays == 1) {
      return ladders_.emplace(InPlace{query_, ray});
    } else {
      const std::uint32_t place = next_++ % kLadders;
      place_[ray] = static_cast<std::uint8_t>(place);
      owner_[place] = static_cast<std::uint16_t>(ray);
      return ladders_[place].emplace(InPlace{query_, ray});
    }
  }

 private:
  // Without a ladder, of one that is not there yet: most rays of a scene of doubles need none.
  predicate::Certified decide_in_lanes(std::uint32_t ray, const kernels::Candidate& candidate,
                                       kernels::TauInterval& tau) {
    if (remembered(ray) != nullptr || !query_.unlimited(ray)) return predicate::Certified::Unsure;
    const Ray<double>& own = query_.ray(ray);
    const double scale = space::kept_tau_scale(query_.geometries().affine_map(), own);
    if (scale == 0) return predicate::Certified::Unsure;
    predicate::Interval t;
    const predicate::Certified answer = query_.kernel().decide_pair(
        predicate::to_double(own, query_.range()), query_.geometries().triangle(candidate), t);
    if (answer != predicate::Certified::Unsure) ++query_.counts().certified;
    if (answer != predicate::Certified::Yes) return answer;
    constexpr auto kLimit = static_cast<double>(space::kTauLimit);
    const double low = std::clamp(t.low * scale, -kLimit, kLimit);
    const double high = std::clamp(t.high * scale, -kLimit, kLimit);
    tau = {static_cast<float>(low - space::tau_pad(low, true)),
           static_cast<float>(high + space::tau_pad(high, true))};
    return answer;
  }

  static constexpr std::uint32_t kLadders = 32;  // 19 KB, which stay in L1
  static constexpr std::uint8_t kNowhere = 0xff;

  // Becomes a ray's ladder where that is to lie: to copy it would cost as much as what it does.
  struct InPlace {
    Query& query;
    std::uint32_t ray;
    operator RayLadder<Real>() const { return query.ladder(ray); }
  };

  // To find them again would take exact arithmetic.
  struct Zeros {
    std::uint32_t primitive = kNone;
    std::uint8_t zeros = 0;
  };
  void keep_zeros(std::uint32_t ray, std::uint32_t primitive, const RayLadder<Real>& own) {
    if constexpr (kRays > 1) zeros_[ray] = {primitive, own.zeros(primitive)};
  }

  Query& query_;
  // One lies in place; for a block there are some.
  std::conditional_t<kRays == 1, std::optional<RayLadder<Real>>,
                     std::array<std::optional<RayLadder<Real>>, kLadders>>
      ladders_;
  std::array<std::uint16_t, kRays == 1 ? 0 : kLadders> owner_;  // whose they are
  std::array<std::uint8_t, kRays == 1 ? 0 : kRays> place_;      // a ray's, if it still is the owner
  std::array<Zeros, kRays == 1 ? 0 : kRays> zeros_;             // of the triangle that came last
  std::uint32_t next_ = 0;
};

}  // namespace pierce::scene
