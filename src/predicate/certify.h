// SPDX-License-Identifier: Apache-2.0
//
// The double rung: the determinants in double, with bounds on their errors. Says yes, no or unsure.
//
// Every bound is a constant times a product of the operands' largest magnitudes; the constants are
// derived in docs/algorithm.md ("The double rung") from the number of roundings on the longest way
// through determinants.h, and are attacked by tests/unit/certify_bounds_test.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "predicate/bounds.h"
#include "predicate/filtered.h"
#include "predicate/types.h"
#include "support/finite.h"

namespace pierce::predicate {

/// The sign of T / den - bound, in the direction that den's sign gives: Yes if surely t > bound (or
/// >= when they are surely equal, which double arithmetic never claims), No if surely t < bound.
inline Certified certify_above(const Filtered& f, double den_magnitude, double t_signed,
                               double bound) {
  if (is_infinite(bound)) return certified(bound < 0);
  const double product = bound * den_magnitude;
  const double difference = t_signed - product;
  const double error = f.t_err + std::fabs(bound) * f.den_err +
                       bounds::kRangeFactor * (std::fabs(product) + std::fabs(difference)) +
                       bounds::kRangeFloor;
  if (difference > error) return Certified::Yes;
  if (difference < -error) return Certified::No;
  return Certified::Unsure;  // also when something overflowed to NaN or inf
}

/// The same of a pair whose den is surely not 0.
inline Certified certify_above(const Filtered& f, double bound) {
  const double den = f.value.den;
  return certify_above(f, std::fabs(den), std::copysign(1.0, den) * f.value.t, bound);
}

/// Whether the ray hits the triangle within its range; `above(bound)` says whether t is above.
template <class Above>
Certified certify_hit(const Filtered& f, const RayD& ray, const Above& above) {
  const double sign = std::copysign(1.0, f.value.den);
  const double den = std::fabs(f.value.den);
  const double uv = std::min(sign * f.value.u, sign * f.value.v);
  const double w = sign * f.value.w;
  if (!f.usable) return Certified::Unsure;
  if (den <= f.den_err) return Certified::Unsure;
  if (uv < -f.uv_err || w < -f.w_err) return Certified::No;
  const Certified after_start = above(ray.t_min);
  if (after_start == Certified::No) return Certified::No;
  const Certified after_end = above(ray.t_max);
  if (after_end == Certified::Yes) return Certified::No;
  const bool inside = uv > f.uv_err && w > f.w_err;
  return inside && after_start == Certified::Yes && after_end == Certified::No ? Certified::Yes
                                                                               : Certified::Unsure;
}
inline Certified certify_hit(const Filtered& f, const RayD& ray) {
  return certify_hit(f, ray, [&f](double bound) { return certify_above(f, bound); });
}

/// An interval that holds a real number for sure; empty of meaning (-inf, inf) when nothing is
/// known.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The t of a pair whose den is surely not zero; (-inf, inf) if that is not sure.
Interval t_interval(const Filtered& filtered);

}  // namespace pierce::predicate
