// SPDX-License-Identifier: Apache-2.0
//
// A chain of error-free sums: four or seven numbers become high + low and a remainder whose size is
// known. Where that leaves a doubt about the last place, integers settle it.
#include "exact/affine.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "exact/double_double.h"
#include "exact/round_ratio.h"
#include "exact/scaled_integers.h"

namespace pierce::exact {
namespace {

/// high + low + something of a magnitude of at most `rest`; high is high + low rounded. Where rest
/// is NaN nothing is known.
struct Sum {
  double high, low, rest;
};

/// The sum of four numbers and of `lows` that are small beside them. Sums of doubles are exact with
/// their errors (also where they are subnormal) unless they overflow, and then the errors are NaN.
template <std::size_t N>
Sum sum_of(const std::array<double, 4>& highs, const std::array<double, N>& lows) {
  std::array<double, N + 3> errors;
  double sum = highs[0];
  for (std::size_t i = 1; i < 4; ++i) {
    const DoubleDouble next = two_sum(sum, highs[i]);
    sum = next.high;
    errors[i - 1] = next.low;
  }
  std::copy(lows.begin(), lows.end(), errors.begin() + 3);
  double correction = errors[0];
  double rest = 0;
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const DoubleDouble next = two_sum(correction, errors[i]);
    correction = next.high;
    rest += std::fabs(next.low);
  }
  const DoubleDouble both = two_sum(sum, correction);
  // At most eight magnitudes were added up, each sum off by 2^-53 of itself.
  return {both.high, both.low, rest * (1 + 0x1p-49)};
}

/// Products of floats are doubles: at most 48 bits, and between 2^-298 and 2^256.
Sum sum_of(const std::array<float, 4>& m, float x, float y, float z) {
  const auto wide = [](float a) { return static_cast<double>(a); };
  return sum_of<0>({wide(m[0]) * wide(x), wide(m[1]) * wide(y), wide(m[2]) * wide(z), wide(m[3])},
                   {});
}

/// Whether two_product is exact: nothing overflows, and the product's last bit, 2^-106 of it, is
/// not below the least subnormal.
bool is_product_exact(double a, double b) {
  constexpr double kMost = 0x1p990, kLeast = 0x1p-960;
  const bool is_fit = std::fabs(a) <= kMost && std::fabs(b) <= kMost;
  return is_fit && (a == 0 || b == 0 || std::fabs(a * b) >= kLeast);
}

Sum sum_of(const std::array<double, 4>& m, double x, double y, double z) {
  if (!is_product_exact(m[0], x) || !is_product_exact(m[1], y) || !is_product_exact(m[2], z)) {
    return {0, 0, std::numeric_limits<double>::quiet_NaN()};
  }
  const DoubleDouble mx = two_product(m[0], x), my = two_product(m[1], y),
                     mz = two_product(m[2], z);
  return sum_of<3>({mx.high, my.high, mz.high, m[3]}, {mx.low, my.low, mz.low});
}

/// Whether all numbers that the sum may be are rounded to the same, which is then the result.
bool certify_rounding(const Sum& sum, double& result) {
  result = sum.high;
  if (sum.rest == 0) return std::isfinite(sum.high);
  // Rounding is monotone; the first term makes up for the sum and difference being rounded.
  const double off = sum.rest + 0x1p-52 * std::fabs(sum.low);
  return sum.high + (sum.low - off) == sum.high && sum.high + (sum.low + off) == sum.high;
}

bool certify_rounding(const Sum& sum, float& result) {
  if (sum.rest == 0 && sum.low == 0) {
    result = static_cast<float>(sum.high);
    return std::isfinite(sum.high);
  }
  // |low| is at most 2^-53 of high; the rest of this makes up for rounding.
  const double off = 0x1p-51 * std::fabs(sum.high) + 2 * sum.rest;
  result = static_cast<float>(sum.high - off);
  return result == static_cast<float>(sum.high + off);
}

}  // namespace

template <class Real>
Real round_affine_exactly(const std::array<Real, 4>& m, Real x, Real y, Real z) {
  const std::array<Real, 4> p = {x, y, z, 1};
  BitSpan rows, points;
  for (std::size_t i = 0; i < 4; ++i) {
    rows.include(static_cast<double>(m[i]));
    points.include(static_cast<double>(p[i]));
  }
  if (rows.empty()) return 0;
  BigInt sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += scaled_integer<BigInt>(static_cast<double>(m[i]), rows.low) *
           scaled_integer<BigInt>(static_cast<double>(p[i]), points.low);
  }
  return round_ratio<Real>(sum, 1, rows.low + points.low);
}

template <class Real>
std::optional<Real> certify_affine(const std::array<Real, 4>& m, Real x, Real y, Real z) {
  Real result = 0;
  if (!certify_rounding(sum_of(m, x, y, z), result)) return std::nullopt;
  return result + Real(0);  // -0 becomes +0
}

template <class Real>
Real round_affine(const std::array<Real, 4>& m, Real x, Real y, Real z) {
  const std::optional<Real> certain = certify_affine(m, x, y, z);
  return certain ? *certain : round_affine_exactly(m, x, y, z);
}

template float round_affine(const std::array<float, 4>&, float, float, float);
template double round_affine(const std::array<double, 4>&, double, double, double);
template std::optional<float> certify_affine(const std::array<float, 4>&, float, float, float);
template std::optional<double> certify_affine(const std::array<double, 4>&, double, double, double);
template float round_affine_exactly(const std::array<float, 4>&, float, float, float);
template double round_affine_exactly(const std::array<double, 4>&, double, double, double);

}  // namespace pierce::exact
