// SPDX-License-Identifier: Apache-2.0
#include "predicate/round.h"

#include <algorithm>
#include <cmath>

#include "exact/double_double.h"
#include "predicate/settle.h"

namespace pierce::predicate {
namespace {

using exact::DoubleDouble;

constexpr double kUlp = 0x1p-53;

// The double-double determinants are within this times the product of the operands' maxima: at most
// 8 operations of 8 * 2^-106 each on 6 products are 384 * 2^-106; the rest is for second-order
// terms.
constexpr double kDoubleDoubleFactor = 512 * 0x1p-106;

// Below this, double-double quotients may lose bits to underflow.
constexpr double kSmallestQuotient = 0x1p-900;

// value +- error, rounded to float if all of the interval rounds alike.
bool round_interval(double value, double error, float& result) {
  const auto low = static_cast<float>(value - error);
  const auto high = static_cast<float>(value + error);
  result = low;
  return low == high && low != 0;
}

bool round_interval(const DoubleDouble& value, double error, double& result) {
  const double low = value.high + (value.low - error);
  const double high = value.high + (value.low + error);
  result = low;
  return low == high && std::fabs(low) > kSmallestQuotient;
}

// numerator / den with the bounds of both; `zero` says that it is exactly zero.
bool round_quotient(double numerator, double numerator_err, double den, double den_err, bool zero,
                    float& result) {
  result = 0;
  if (zero) return true;
  const double q = numerator / den;
  const double error = (numerator_err + std::fabs(q) * den_err) / (std::fabs(den) - den_err);
  return round_interval(q, error * (1 + 16 * kUlp) + 4 * kUlp * std::fabs(q), result);
}

bool round_quotient(const DoubleDouble& numerator, double numerator_err, const DoubleDouble& den,
                    double den_err, bool zero, double& result) {
  result = 0;
  if (zero) return true;
  const DoubleDouble q = numerator / den;
  const double magnitude = std::fabs(q.high);
  const double error = (numerator_err + magnitude * den_err) / (std::fabs(den.high) - 2 * den_err);
  // The quotient itself: 32 * 2^-106 of it; low -+ error is rounded once more: kUlp of both.
  const double all =
      error * (1 + 64 * kUlp) + 64 * kUlp * kUlp * magnitude + 2 * kUlp * std::fabs(q.low);
  return round_interval(q, all, result);
}

// One text for both kinds of numbers.
template <class Number, class Real>
bool round_all(const Determinants<Number, Number>& value, double den_err, double uv_err,
               double w_err, double t_err, std::uint8_t zeros, Hit<Real>& result) {
  return round_quotient(value.t, t_err, value.den, den_err, false, result.t) &&
         round_quotient(value.u, uv_err, value.den, den_err, (zeros & kZeroU) != 0, result.u) &&
         round_quotient(value.v, uv_err, value.den, den_err, (zeros & kZeroV) != 0, result.v) &&
         round_quotient(value.w, w_err, value.den, den_err, (zeros & kZeroW) != 0, result.w);
}

Triple<DoubleDouble> exact_difference(const Vec3<double>& p, const Vec3<double>& q) {
  return {exact::two_sum(p.x, -q.x), exact::two_sum(p.y, -q.y), exact::two_sum(p.z, -q.z)};
}

}  // namespace

bool round_certified(const RayD&, const DecidedHit& hit, Hit<float>& result) {
  const Filtered& f = hit.filtered;
  if (!f.usable || std::fabs(f.value.den) <= 2 * f.den_err) return false;
  result.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  return round_all(f.value, f.den_err, f.uv_err, f.w_err, f.t_err, hit.zeros, result);
}

bool round_certified(const RayD& ray, const DecidedHit& hit, Hit<double>& result) {
  const Filtered& f = hit.filtered;
  if (!f.usable || std::fabs(f.value.den) <= 2 * f.den_err) return false;
  result.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  const auto s = exact_difference(hit.triangle.a, ray.origin);
  const auto e1 = exact_difference(hit.triangle.b, hit.triangle.a);
  const auto e2 = exact_difference(hit.triangle.c, hit.triangle.a);
  const Triple<double> d{ray.direction.x, ray.direction.y, ray.direction.z};
  const auto value = determinants_of(s, e1, e2, d);
  // The bounds of the double rung, with the other factor in place of theirs (43 is the smallest).
  constexpr double kFiner = kDoubleDoubleFactor / (43 * kUlp);
  return round_all(value, f.den_err * kFiner, f.uv_err * kFiner, f.w_err * kFiner, f.t_err * kFiner,
                   hit.zeros, result);
}

}  // namespace pierce::predicate
