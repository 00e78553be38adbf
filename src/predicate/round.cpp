// SPDX-License-Identifier: Apache-2.0
#include "predicate/round.h"

#include <cmath>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/settle.h"

namespace pierce::predicate {
namespace {

using exact::DoubleDouble;

// value +- error, rounded to float if all of the interval rounds alike (but not to zero, whose sign
// has to be +).
bool round_interval(double value, double error, float& result) {
  const auto low = static_cast<float>(value - error);
  const auto high = static_cast<float>(value + error);
  result = low;
  return low == high && low != 0;
}

// The same for double. The error is at least 2^-401 (of operands in the window of the double rung),
// so an interval that rounds to one value lies beyond 2^-349: no underflow, and not zero.
bool round_interval(const DoubleDouble& value, double error, double& result) {
  const double low = value.high + (value.low - error);
  const double high = value.high + (value.low + error);
  result = low;
  return low == high;
}

// A quotient's denominator in double, beyond kQuotientClear times its error: its inverse, a bound
// on 1 / (den - err), and err.
struct Denominator {
  double inverse, magnitude, err;
};

// numerator / den with the bounds of both; `zero` says that it is exactly zero.
bool round_quotient(double numerator, double numerator_err, const Denominator& den, bool zero,
                    float& result) {
  const double q = numerator * den.inverse;
  const double error = (numerator_err + std::fabs(q) * den.err) * den.magnitude +
                       bounds::kQuotientFactor * std::fabs(q);
  const bool sure = round_interval(q, error, result);
  if (!zero) return sure;
  result = 0;
  return true;
}

bool round_quotient(const DoubleDouble& numerator, double numerator_err, const DoubleDouble& den,
                    double den_err, bool zero, double& result) {
  result = 0;
  if (zero) return true;
  const DoubleDouble q = numerator / den;
  const double magnitude = std::fabs(q.high);
  const double error = (numerator_err + magnitude * den_err) / (std::fabs(den.high) - 2 * den_err);
  const double all =
      error + bounds::kFineQuotientFactor * magnitude + bounds::kFineEnds * std::fabs(q.low);
  return round_interval(q, all, result);
}

std::uint8_t numbers(bool t, bool u, bool v, bool w) {
  return static_cast<std::uint8_t>((t ? kNumberT : 0) | (u ? kNumberU : 0) | (v ? kNumberV : 0) |
                                   (w ? kNumberW : 0));
}

Triple<DoubleDouble> exact_difference(const Vec3<double>& p, const Vec3<double>& q) {
  return {exact::two_sum(p.x, -q.x), exact::two_sum(p.y, -q.y), exact::two_sum(p.z, -q.z)};
}

}  // namespace

std::uint8_t round_certified(const RayD&, const TriangleD&, const Filtered& f, std::uint8_t zeros,
                             Hit<float>& result) {
  const double inverse = 1 / f.value.den;
  const Denominator den{inverse, std::fabs(inverse) * bounds::kQuotientRoom, f.den_err};
  if (!f.usable || std::fabs(f.value.den) <= bounds::kQuotientClear * f.den_err) return 0;
  result.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  const bool t = round_quotient(f.value.t, f.t_err, den, false, result.t);
  const bool u = round_quotient(f.value.u, f.uv_err, den, (zeros & kZeroU) != 0, result.u);
  const bool v = round_quotient(f.value.v, f.uv_err, den, (zeros & kZeroV) != 0, result.v);
  const bool w = round_quotient(f.value.w, f.w_err, den, (zeros & kZeroW) != 0, result.w);
  return numbers(t, u, v, w);
}

std::uint8_t round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& f,
                             std::uint8_t zeros, Hit<double>& result) {
  if (!f.usable || std::fabs(f.value.den) <= 2 * f.den_err) return 0;
  result.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  const auto s = exact_difference(triangle.a, ray.origin);
  const auto e1 = exact_difference(triangle.b, triangle.a);
  const auto e2 = exact_difference(triangle.c, triangle.a);
  const Triple<double> d{ray.direction.x, ray.direction.y, ray.direction.z};
  const auto value = determinants_of(s, e1, e2, d);
  const double den_err = f.den_err * bounds::kFiner;
  const double uv_err = f.uv_err * bounds::kFiner;
  const auto round = [&](const DoubleDouble& numerator, double err, unsigned zero, double& out) {
    return round_quotient(numerator, err, value.den, den_err, (zeros & zero) != 0, out);
  };
  const bool t = round(value.t, f.t_err * bounds::kFiner, 0, result.t);
  const bool u = round(value.u, uv_err, kZeroU, result.u);
  const bool v = round(value.v, uv_err, kZeroV, result.v);
  const bool w = round(value.w, f.w_err * bounds::kFiner, kZeroW, result.w);
  return numbers(t, u, v, w);
}

bool round_again(const Hit<double>& finer, Hit<float>& result) {
  // Within half a unit of a double's last place, of which this is at least one.
  const auto round = [](double x, float& to) {
    to = 0;
    return x == 0 || round_interval(x, 0x1p-52 * std::fabs(x), to);
  };
  result.facing = finer.facing;
  const bool t = round(finer.t, result.t), u = round(finer.u, result.u);
  const bool v = round(finer.v, result.v), w = round(finer.w, result.w);
  return t && u && v && w;
}

template <class Real>
Hit<Real> round_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                    LadderCounts& counts) {
  Hit<Real> result;
  const Filtered filtered = filter_determinants(ray, triangle);
  const std::uint8_t sure = round_certified(ray, triangle, filtered, zeros, result);
  if (sure == kAllNumbers) [[likely]]
    return result;
  if constexpr (std::is_same_v<Real, float>) {
    Hit<double> finer;
    Hit<float> again;
    if (round_certified(ray, triangle, filtered, zeros, finer) == kAllNumbers &&
        round_again(finer, again))
      return again;
  }
  ++counts.rounded_exactly;
  settle_numbers(ray, triangle, static_cast<std::uint8_t>(kAllNumbers & ~sure), result);
  return result;
}

template Hit<float> round_hit<float>(const RayD&, const TriangleD&, std::uint8_t, LadderCounts&);
template Hit<double> round_hit<double>(const RayD&, const TriangleD&, std::uint8_t, LadderCounts&);

}  // namespace pierce::predicate
