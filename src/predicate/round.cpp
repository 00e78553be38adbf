// SPDX-License-Identifier: Apache-2.0
#include "predicate/round.h"

#include <cmath>
#include <optional>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/axis_signs.h"
#include "predicate/bounds.h"
#include "predicate/corner.h"
#include "predicate/fine.h"
#include "predicate/round_between.h"
#include "predicate/settle.h"

namespace pierce::predicate {
namespace {

using exact::DoubleDouble;

// The ends of value +- error, rounded to float; whether all of the interval rounds alike (but not
// to zero, whose sign has to be +).
bool round_interval(double value, double error, float& low, float& high) {
  low = static_cast<float>(value - error);
  high = static_cast<float>(value + error);
  return low == high && low != 0;
}

// The same for double. The error is at least 2^-401 (of operands in the window of the double rung),
// so an interval that rounds to one value lies beyond 2^-349: no underflow, and not zero.
bool round_interval(const DoubleDouble& value, double error, double& low, double& high) {
  low = value.high + (value.low - error);
  high = value.high + (value.low + error);
  return low == high;
}

// A quotient's denominator in double, beyond kQuotientClear times its error: its inverse, a bound
// on 1 / (den - err), and err.
struct Denominator {
  double inverse, magnitude, err;
};

// numerator / den with the bounds of both; `zero` says that it is exactly zero.
bool round_quotient(double numerator, double numerator_err, const Denominator& den, bool zero,
                    float& low, float& high) {
  const double q = numerator * den.inverse;
  const double error = (numerator_err + std::fabs(q) * den.err) * den.magnitude +
                       bounds::kQuotientFactor * std::fabs(q);
  const bool sure = round_interval(q, error, low, high);
  if (!zero) return sure;
  low = 0;
  return true;
}

bool round_quotient(const DoubleDouble& numerator, double numerator_err, const DoubleDouble& den,
                    double den_err, bool zero, double& low, double& high) {
  low = 0;
  if (zero) return true;
  const DoubleDouble q = numerator / den;
  const double magnitude = std::fabs(q.high);
  const double error = (numerator_err + magnitude * den_err) / (std::fabs(den.high) - 2 * den_err);
  const double all =
      error + bounds::kFineQuotientFactor * magnitude + bounds::kFineEnds * std::fabs(q.low);
  return round_interval(q, all, low, high);
}

std::uint8_t numbers(bool t, bool u, bool v, bool w) {
  return static_cast<std::uint8_t>((t ? kNumberT : 0) | (u ? kNumberU : 0) | (v ? kNumberV : 0) |
                                   (w ? kNumberW : 0));
}

std::uint8_t others(std::uint8_t some) { return static_cast<std::uint8_t>(kAllNumbers & ~some); }

// As round_certified; `low` and `high` are what the ends of each number's interval round to.
// Nothing if there are none.
std::optional<std::uint8_t> round_ends(const RayD&, const TriangleD&, const Filtered& f,
                                       std::uint8_t zeros, Hit<float>& low, Hit<float>& high) {
  const double inverse = 1 / f.value.den;
  const Denominator den{inverse, std::fabs(inverse) * bounds::kQuotientRoom, f.den_err};
  if (!f.usable || std::fabs(f.value.den) <= bounds::kQuotientClear * f.den_err) return {};
  low.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  const bool t = round_quotient(f.value.t, f.t_err, den, false, low.t, high.t);
  const bool u = round_quotient(f.value.u, f.uv_err, den, (zeros & kZeroU) != 0, low.u, high.u);
  const bool v = round_quotient(f.value.v, f.uv_err, den, (zeros & kZeroV) != 0, low.v, high.v);
  const bool w = round_quotient(f.value.w, f.w_err, den, (zeros & kZeroW) != 0, low.w, high.w);
  return numbers(t, u, v, w);
}

std::optional<std::uint8_t> round_ends(const RayD& ray, const TriangleD& triangle,
                                       const Filtered& f, std::uint8_t zeros, Hit<double>& low,
                                       Hit<double>& high) {
  if (!f.usable || std::fabs(f.value.den) <= 2 * f.den_err) return {};
  low.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  const auto value = fine_determinants(ray, triangle);
  const double den_err = f.den_err * bounds::kFiner;
  const double uv_err = f.uv_err * bounds::kFiner;
  const auto round = [&](const DoubleDouble& numerator, double err, unsigned zero, double& to,
                         double& other) {
    return round_quotient(numerator, err, value.den, den_err, (zeros & zero) != 0, to, other);
  };
  const bool t = round(value.t, f.t_err * bounds::kFiner, 0, low.t, high.t);
  const bool u = round(value.u, uv_err, kZeroU, low.u, high.u);
  const bool v = round(value.v, uv_err, kZeroV, low.v, high.v);
  const bool w = round(value.w, f.w_err * bounds::kFiner, kZeroW, low.w, high.w);
  return numbers(t, u, v, w);
}

}  // namespace

std::uint8_t round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                             std::uint8_t zeros, Hit<float>& result) {
  Hit<float> high;
  return round_ends(ray, triangle, filtered, zeros, result, high).value_or(0);
}
std::uint8_t round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                             std::uint8_t zeros, Hit<double>& result) {
  Hit<double> high;
  return round_ends(ray, triangle, filtered, zeros, result, high).value_or(0);
}

bool round_again(const Hit<double>& finer, Hit<float>& result) {
  // Within half a unit of a double's last place, of which this is at least one.
  const auto round = [](double x, float& to) {
    to = 0;
    float high = 0;
    return x == 0 || round_interval(x, 0x1p-52 * std::fabs(x), to, high);
  };
  result.facing = finer.facing;
  const bool t = round(finer.t, result.t), u = round(finer.u, result.u);
  const bool v = round(finer.v, result.v), w = round(finer.w, result.w);
  return t && u && v && w;
}

namespace {

// Some numbers of a hit.
template <class Real>
void take_numbers(const Hit<Real>& from, std::uint8_t some, Hit<Real>& to) {
  if ((some & kNumberT) != 0) to.t = from.t;
  if ((some & kNumberU) != 0) to.u = from.u;
  if ((some & kNumberV) != 0) to.v = from.v;
  if ((some & kNumberW) != 0) to.w = from.w;
}

// Float's way by double-double: for rays that all but lie in the plane, double has few bits to
// spare.
bool round_finely(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros, std::uint8_t some,
                  Hit<float>& low) {
  const Filtered filtered = filter_determinants(ray, triangle);
  Hit<double> finer;
  Hit<float> again;
  if (round_certified(ray, triangle, filtered, zeros, finer) != kAllNumbers ||
      !round_again(finer, again))
    return false;
  take_numbers(again, some, low);
  low.facing = again.facing;
  return true;
}

// The numbers of a hit that are not sure, of which `low` and `high` are the ends (`bounded`), or of
// which nothing is known.
template <class Real>
void round_rest(const RayD& ray, const TriangleD& triangle, bool bounded, std::uint8_t zeros,
                std::uint8_t unsure, const Hit<Real>& high, Hit<Real>& low, LadderCounts& counts) {
  if (bounded && (unsure & kNumberT) != 0) {
    if (const auto t = round_across_axis<Real>(ray, triangle)) {
      low.t = *t;
      unsure = static_cast<std::uint8_t>(unsure & ~kNumberT);
    }
  }
  if constexpr (std::is_same_v<Real, double>) {
    if (bounded && unsure != 0)
      unsure = static_cast<std::uint8_t>(unsure & ~round_along_axis(ray, triangle, unsure, low));
  }
  if (unsure == 0) return;
  const std::uint8_t between =
      bounded ? round_between(ray, triangle, unsure, high, low) : std::uint8_t{0};
  const std::uint8_t rest = unsure & others(between);
  if constexpr (std::is_same_v<Real, float>) {
    if (rest != 0 && round_finely(ray, triangle, zeros, rest, low)) return;
  }
  ++counts.rounded_exactly;
  if (rest != 0) settle_numbers(ray, triangle, rest, low);
}

}  // namespace

template <class Real>
void round_bounded_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                       const Hit<Real>& high, Hit<Real>& low, LadderCounts& counts) {
  const auto sure = [zeros](unsigned zero, Real p, Real q) {
    return (zeros & zero) != 0 || (p == q && p != 0);  // a zero has to be +0
  };
  const std::uint8_t unsure =
      others(numbers(sure(0, low.t, high.t), sure(kZeroU, low.u, high.u),
                     sure(kZeroV, low.v, high.v), sure(kZeroW, low.w, high.w)));
  if (unsure == 0) return;
  round_rest(ray, triangle, true, zeros, unsure, high, low, counts);
}

template <class Real>
Hit<Real> round_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                    LadderCounts& counts) {
  const Filtered filtered = filter_determinants(ray, triangle);
  if (const auto hit = round_at_corner<Real>(ray, triangle, zeros, filtered)) return *hit;
  Hit<Real> result, high;
  const auto certain = round_ends(ray, triangle, filtered, zeros, result, high);
  const std::uint8_t sure = certain.value_or(0);
  if (sure == kAllNumbers) [[likely]]
    return result;
  round_rest(ray, triangle, certain.has_value(), zeros, others(sure), high, result, counts);
  return result;
}

template void round_bounded_hit<float>(const RayD&, const TriangleD&, std::uint8_t,
                                       const Hit<float>&, Hit<float>&, LadderCounts&);
template void round_bounded_hit<double>(const RayD&, const TriangleD&, std::uint8_t,
                                        const Hit<double>&, Hit<double>&, LadderCounts&);
template Hit<float> round_hit<float>(const RayD&, const TriangleD&, std::uint8_t, LadderCounts&);
template Hit<double> round_hit<double>(const RayD&, const TriangleD&, std::uint8_t, LadderCounts&);

}  // namespace pierce::predicate
