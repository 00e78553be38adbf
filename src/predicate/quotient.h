// SPDX-License-Identifier: Apache-2.0
//
// Signs and quotients of doubles, exact by a few products: what is left of the determinants where a
// ray passes through a corner, moves along an axis, or meets a plane across one.
#pragma once

#include <optional>

#include "exact/double_double.h"
#include "predicate/certify.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// The sign of a b - c d; nothing if that would take more than double arithmetic.
std::optional<int> order_of_products(double a, double b, double c, double d);

/// a b - c d, within 8 * 2^-106 of itself; nothing likewise.
std::optional<exact::DoubleDouble> difference_of_products(double a, double b, double c, double d);

/// a - b, and whether nothing was rounded.
struct Difference {
  double value;
  bool exact;

  Difference(double a, double b) {
    const exact::DoubleDouble d = exact::two_sum(a, -b);
    value = d.high;
    exact = d.low == 0;
  }
};

/// A number that is exactly this quotient.
struct Quotient {
  double numerator, denominator;  // the latter not 0

  /// The sign of it less a bound; nothing if that would take more than double arithmetic.
  [[nodiscard]] std::optional<int> compare(double bound) const;
  /// Whether it is a t in the ray's range; nothing likewise.
  [[nodiscard]] std::optional<bool> in_range(const RayD& ray) const;
  /// Holds it.
  [[nodiscard]] Interval interval() const;
  /// It, correctly rounded; nothing if double arithmetic cannot say.
  template <class Real>
  [[nodiscard]] std::optional<Real> rounded() const;
};

}  // namespace pierce::predicate
