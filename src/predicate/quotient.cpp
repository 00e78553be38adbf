// SPDX-License-Identifier: Apache-2.0
#include "predicate/quotient.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

// Products of two such numbers are exact as double-doubles (two_product): nothing overflows, and
// the low part is a multiple of 2^-904.
bool is_moderate(double x) { return std::fabs(x) >= 0x1p-400 && std::fabs(x) <= 0x1p400; }

}  // namespace

std::optional<int> order_of_products(double a, double b, double c, double d) {
  // Rounding keeps the order, and equal numbers are rounded alike.
  const double ab = a * b, cd = c * d;
  if (ab > cd) return 1;
  if (ab < cd) return -1;
  if ((a == 0 || b == 0) && (c == 0 || d == 0)) return 0;
  if (!is_moderate(a) || !is_moderate(b) || !is_moderate(c) || !is_moderate(d)) return {};
  return sign_of_double(exact::two_product(a, b).low - exact::two_product(c, d).low);
}

std::optional<exact::DoubleDouble> difference_of_products(double a, double b, double c, double d) {
  const auto splits = [](double x) { return x == 0 || is_moderate(x); };
  if (!splits(a) || !splits(b) || !splits(c) || !splits(d)) return {};
  const exact::DoubleDouble ab = exact::two_product(a, b), cd = exact::two_product(c, d);
  // Four numbers are added up. If much of the high parts cancels, their difference is exact, and
  // so is what is left; if not, all else is small beside it.
  const exact::DoubleDouble high = exact::two_sum(ab.high, -cd.high);
  const exact::DoubleDouble low = exact::two_sum(ab.low, -cd.low);
  const exact::DoubleDouble both = exact::two_sum(high.high, low.high);
  return exact::two_sum(both.high, both.low + (high.low + low.low));
}

std::optional<int> Quotient::compare(double bound) const {
  const int side = denominator < 0 ? -1 : 1;
  if (is_infinite(bound)) return bound < 0 ? 1 : -1;
  const auto order = order_of_products(numerator, 1, bound, denominator);
  if (!order) return {};
  return side * *order;
}

std::optional<bool> Quotient::in_range(const RayD& ray) const {
  const auto start = compare(ray.t_min), end = compare(ray.t_max);
  if (!start || !end) return {};
  return (*start > 0 || (*start == 0 && !ray.open_start)) && *end <= 0;
}

Interval Quotient::interval() const {
  if (numerator == 0) return {0, 0};
  const double quotient = numerator / denominator;
  if (!is_finite_number(quotient)) return {};
  const double error =
      bounds::kIntervalFactor * std::fabs(quotient) + 0x1p-1074;  // if it underflows
  return {quotient - error, quotient + error};
}

template <class Real>
std::optional<Real> Quotient::rounded() const {
  if (numerator == 0) return Real{0};  // not -0
  double quotient = numerator / denominator;
  if constexpr (std::is_same_v<Real, float>) {
    // Where float has its 24 bits. A border between two floats is a double: if the quotient lies on
    // one side of it, so does it rounded to double, or this is the border.
    const double size = std::fabs(quotient);
    if (!(size >= 0x1p-126 && size < 0x1p127)) return {};
    const auto bits = std::bit_cast<std::uint64_t>(quotient);
    if ((bits & 0x1fffffff) == 0x10000000) {
      const auto order = compare(quotient);
      if (!order) return {};
      const bool beyond = *order == (quotient < 0 ? -1 : 1);
      if (*order != 0) quotient = std::bit_cast<double>(beyond ? bits + 1 : bits - 1);
    }
  }
  const auto rounded = static_cast<Real>(quotient);
  if (!is_finite_number(rounded)) return {};
  return rounded == 0 ? Real{0} : rounded;
}

template std::optional<float> Quotient::rounded<float>() const;
template std::optional<double> Quotient::rounded<double>() const;

}  // namespace pierce::predicate
