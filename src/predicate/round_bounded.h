// SPDX-License-Identifier: Apache-2.0
//
// Numbers that carry their own error bounds, made of doubles and rounded, if all that they may be
// rounds alike.
#pragma once

#include <cmath>

#include "exact/bounded.h"
#include "predicate/determinants.h"
#include "predicate/types.h"

namespace pierce::predicate {

template <class T>
exact::Bounded<T> bounded_difference(double a, double b);
template <>
inline exact::Bounded<double> bounded_difference<double>(double a, double b) {
  const double difference = a - b;
  return {difference, exact::Loss<double>::kRelative * std::fabs(difference)};
}
// Two doubles hold a difference exactly; where the sum overflows it is NaN, of which nothing is
// true.
template <>
inline exact::Bounded<exact::DoubleDouble> bounded_difference<exact::DoubleDouble>(double a,
                                                                                   double b) {
  return {exact::two_sum(a, -b), 0};
}

template <class T>
Triple<exact::Bounded<T>> bounded_difference(const Vec3<double>& p, const Vec3<double>& q) {
  return {bounded_difference<T>(p.x, q.x), bounded_difference<T>(p.y, q.y),
          bounded_difference<T>(p.z, q.z)};
}

// Whether all of value +- err rounds to one Real; a certain zero is +0, any other zero has an
// unknown sign.
inline bool round_bounded(const exact::Bounded<double>& x, float& result) {
  if (is_zero(x)) {
    result = 0;
    return true;
  }
  const double err = x.err * (1 + 0x1p-50) + 0x1p-52 * std::fabs(x.value);
  const auto low = static_cast<float>(x.value - err);
  const auto high = static_cast<float>(x.value + err);
  result = low;
  return low == high && low != 0;
}
inline bool round_bounded(const exact::Bounded<exact::DoubleDouble>& x, double& result) {
  if (is_zero(x)) {
    result = 0;
    return true;
  }
  const double err = x.err * (1 + 0x1p-50) + 0x1p-52 * std::fabs(x.value.low);
  const double low = x.value.high + (x.value.low - err);
  const double high = x.value.high + (x.value.low + err);
  result = low;
  return low == high && std::fabs(low) > 0x1p-900;
}
/// As a double whose error holds the low part, too: for what cancellation left of a long number.
inline bool round_bounded(const exact::Bounded<exact::DoubleDouble>& x, float& result) {
  return round_bounded(
      exact::Bounded<double>{x.value.high, (x.err + std::fabs(x.value.low)) * (1 + 0x1p-50)},
      result);
}

/// A coordinate that is known, with zero as +0.
template <class Real>
Real plus_zero(double exact) {
  return static_cast<Real>(exact) + Real(0);
}

}  // namespace pierce::predicate
