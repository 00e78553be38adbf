// SPDX-License-Identifier: Apache-2.0
//
// Hits queued to be rounded 32 at a time: in lanes, with a scalar fallback for the few of which
// that is not certain.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/kernel.h"
#include "pierce/types.h"
#include "predicate/certify.h"
#include "predicate/round.h"
#include "predicate/types.h"

namespace pierce::scene {

/// Sets t, u, v, w and facing.
template <class Real>
void set_numbers(const Hit<Real>& from, Hit<Real>& to) {
  to.t = from.t;
  to.u = from.u;
  to.v = from.v;
  to.w = from.w;
  to.facing = from.facing;
}

/// What lanes make of a queued hit.
template <class Real>
class RoundedHit {
 public:
  RoundedHit(const kernels::HitColumns& columns, const kernels::RoundedColumns<Real>& rounded,
             std::size_t i)
      : sure(((rounded.sure >> i) & 1U) != 0),
        bounded(((rounded.bounded >> i) & 1U) != 0),
        columns_(columns),
        rounded_(rounded),
        i_(i) {}

  const bool sure;     ///< of its numbers
  const bool bounded;  ///< if not: they lie between low() and high()

  void set_low(Hit<Real>& hit) const {
    hit.t = rounded_.t[i_];
    hit.u = rounded_.u[i_];
    hit.v = rounded_.v[i_];
    hit.w = rounded_.w[i_];
    hit.facing = ((rounded_.front >> i_) & 1U) != 0 ? Facing::Front : Facing::Back;
  }
  [[nodiscard]] Hit<Real> high() const {
    return {rounded_.t_high[i_], rounded_.u_high[i_], rounded_.v_high[i_], rounded_.w_high[i_]};
  }
  /// If bounded: the ends of an interval that holds t; or, in double, that holds t rounded.
  [[nodiscard]] predicate::Interval t() const {
    if constexpr (std::is_same_v<Real, float>) return {rounded_.t_from[i_], rounded_.t_to[i_]};
    return {static_cast<double>(rounded_.t[i_]), static_cast<double>(rounded_.t_high[i_])};
  }
  /// Whether double has few bits to spare, so that more will do; else it may well be a tie.
  [[nodiscard]] bool is_wide() const {
    if (!bounded) return true;
    const predicate::Interval around = t();
    return around.high - around.low > 0x1p-36 * std::fabs(around.high);
  }
  [[nodiscard]] predicate::RayD ray() const { return {point(9), point(12)}; }
  [[nodiscard]] predicate::TriangleD triangle() const { return {point(0), point(3), point(6)}; }

 private:
  [[nodiscard]] Vec3<double> point(std::size_t row) const {
    return {columns_.number[row][i_], columns_.number[row + 1][i_], columns_.number[row + 2][i_]};
  }

  const kernels::HitColumns& columns_;
  const kernels::RoundedColumns<Real>& rounded_;
  std::size_t i_;
};

/// Each pair has an `Owner`, what its numbers are for.
template <class Real, class Owner = Hit<Real>*>
class HitRounding {
 public:
  /// Of this pair, surely a hit. Not when full.
  template <class AnyRay>
  void add(const AnyRay& ray, const predicate::TriangleD& triangle, Owner owner) {
    put(0, triangle.a);
    put(3, triangle.b);
    put(6, triangle.c);
    put(9, ray.origin);
    put(12, ray.direction);
    owners_[size_++] = owner;
  }

  [[nodiscard]] bool full() const { return size_ == kernels::kRoundBatch; }
  void clear() { size_ = 0; }

  /// Rounds all that are queued; `take(owner, RoundedHit)` for each.
  template <class Take>
  void round(const kernels::Kernel& kernel, const Take& take) {
    if (size_ == 0) return;
    kernel.of<Real>().round(columns_, size_, rounded_);
    for (std::size_t i = 0; i < size_; ++i)
      take(owners_[i], RoundedHit<Real>(columns_, rounded_, i));
    size_ = 0;
  }

 private:
  template <class Number>
  void put(std::size_t row, const Vec3<Number>& p) {
    columns_.number[row][size_] = static_cast<double>(p.x);
    columns_.number[row + 1][size_] = static_cast<double>(p.y);
    columns_.number[row + 2][size_] = static_cast<double>(p.z);
  }

  std::size_t size_ = 0;
  kernels::HitColumns columns_{};  // the columns that are not used are read, too
  kernels::RoundedColumns<Real> rounded_;
  std::array<Owner, kernels::kRoundBatch> owners_;
};

/// A single hit, of which weights may be known to be zero (predicate::kZeroU ...).
template <class Real>
Hit<Real> round_one(const kernels::Kernel& kernel, const predicate::RayD& ray,
                    const predicate::TriangleD& triangle, std::uint8_t zeros,
                    predicate::LadderCounts& counts) {
  const bool at_corner = predicate::kSupports[zeros].count == 1;  // which takes one quotient
  if (at_corner) return predicate::round_hit<Real>(ray, triangle, zeros, counts);
  Hit<Real> hit, high;
  switch (kernel.of<Real>().round_one(ray, triangle, zeros, hit, high)) {
    case kernels::Rounded::All:
      break;
    case kernels::Rounded::Ends:
      predicate::round_bounded_hit(ray, triangle, zeros, high, hit, counts);
      break;
    case kernels::Rounded::None:
      return predicate::round_hit<Real>(ray, triangle, zeros, counts);
  }
  return hit;
}

/// The numbers of a hit of which lanes say so much, in `hit`.
template <class Real>
void set_rounded(const RoundedHit<Real>& rounded, const kernels::Kernel& kernel,
                 predicate::LadderCounts& counts, Hit<Real>& hit) {
  rounded.set_low(hit);
  if (rounded.sure) [[likely]]
    return;
  if constexpr (std::is_same_v<Real, float>) {
    Hit<float> finer = hit;  // names
    if (rounded.is_wide() && kernel.round_finely(rounded.ray(), rounded.triangle(), 0, finer)) {
      hit = finer;
      return;
    }
  }
  if (rounded.bounded) {
    predicate::round_bounded_hit(rounded.ray(), rounded.triangle(), 0, rounded.high(), hit, counts);
  } else {
    set_numbers(predicate::round_hit<Real>(rounded.ray(), rounded.triangle(), 0, counts), hit);
  }
}

}  // namespace pierce::scene
