// SPDX-License-Identifier: Apache-2.0
#include "predicate/corner.h"

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/fine.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

// Products of two such numbers are exact as double-doubles (two_product): nothing overflows, and
// the low part is a multiple of 2^-904.
bool is_moderate(double x) { return std::fabs(x) >= 0x1p-400 && std::fabs(x) <= 0x1p400; }

// Whether a b is surely c d.
bool same_product(double a, double b, double c, double d) {
  const double product = a * b;
  if (product != c * d) return false;  // equal numbers are rounded alike
  if (a == 0 || b == 0) return c == 0 || d == 0;
  return is_moderate(a) && is_moderate(b) && is_moderate(c) && is_moderate(d) &&
         exact::two_product(a, b).low == exact::two_product(c, d).low;
}

double by_axis(const Vec3<double>& p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

int largest_axis(const Vec3<double>& p) {
  const double x = std::fabs(p.x), y = std::fabs(p.y), z = std::fabs(p.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

int sign_of_number(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

// A quotient rounded to Real; nothing if double arithmetic may have rounded it the wrong way.
std::optional<double> rounded_to(double, const Quotient& x) {
  const double quotient = x.numerator / x.denominator;
  if (!is_finite_number(quotient)) return {};
  return quotient;
}
std::optional<float> rounded_to(float, const Quotient& x) {
  const Interval ends = x.interval();
  const auto low = static_cast<float>(ends.low), high = static_cast<float>(ends.high);
  if (low != high || !is_finite_number(low)) return {};
  return low;
}

bool is_crossed(const Filtered& f) { return f.normal_usable && std::fabs(f.value.den) > f.den_err; }

}  // namespace

std::optional<int> Quotient::compare(double bound) const {
  const int side = denominator < 0 ? -1 : 1;
  if (is_infinite(bound)) return bound < 0 ? 1 : -1;
  if (bound == 0 || numerator == 0) {
    return numerator == 0 ? -sign_of_number(bound) : side * sign_of_number(numerator);
  }
  if (!is_moderate(bound) || !is_moderate(denominator)) return {};
  // What a product's high part lacks is less than what lies between it and any other double.
  const exact::DoubleDouble product = exact::two_product(bound, denominator);
  if (numerator != product.high) return numerator > product.high ? side : -side;
  return -side * sign_of_number(product.low);
}

Interval Quotient::interval() const {
  if (numerator == 0) return {0, 0};
  const double quotient = numerator / denominator;
  if (!is_finite_number(quotient)) return {};
  const double error =
      bounds::kIntervalFactor * std::fabs(quotient) + 0x1p-1074;  // if it underflows
  return {quotient - error, quotient + error};
}

std::optional<Quotient> place_on_line(const RayD& ray, const Vec3<double>& p) {
  const Vec3<double>& d = ray.direction;
  const int axis = largest_axis(d), next = (axis + 1) % 3, last = (axis + 2) % 3;
  const auto distance = exact_difference(p, ray.origin);
  const Vec3<double> away{distance.x.high, distance.y.high, distance.z.high};
  const double along = by_axis(away, axis), speed = by_axis(d, axis);
  const auto goes_with = [&](int other) {
    return same_product(by_axis(away, other), speed, along, by_axis(d, other));
  };
  if (!goes_with(next) || !goes_with(last)) return {};
  if (distance.x.low != 0 || distance.y.low != 0 || distance.z.low != 0) return {};
  return Quotient{along, speed};
}

std::optional<CornerHit> meet_corner(const RayD& ray, const TriangleD& triangle,
                                     const Filtered& f) {
  if (!is_crossed(f)) return {};
  const bool u = std::fabs(f.value.u) <= f.uv_err, v = std::fabs(f.value.v) <= f.uv_err,
             w = std::fabs(f.value.w) <= f.w_err;
  for (const unsigned zeros : {kZeroU | kZeroV, kZeroV | kZeroW, kZeroU | kZeroW}) {
    const bool possible = (u || (zeros & kZeroU) == 0) && (v || (zeros & kZeroV) == 0) &&
                          (w || (zeros & kZeroW) == 0);
    if (!possible) continue;
    const auto t = place_on_line(ray, triangle.corner(kSupports[zeros].first));
    if (!t) continue;
    const auto start = t->compare(ray.t_min), end = t->compare(ray.t_max);
    const Interval interval = t->interval();
    if (!start || !end || is_infinite(interval.low)) return {};
    return CornerHit{(*start > 0 || (*start == 0 && !ray.open_start)) && *end <= 0,
                     static_cast<std::uint8_t>(zeros), interval,
                     f.value.den < 0 ? Facing::Front : Facing::Back};
  }
  return {};
}

template <class Real>
std::optional<Hit<Real>> round_at_corner(const RayD& ray, const TriangleD& triangle,
                                         std::uint8_t zeros, const Filtered& f) {
  const auto [corners, first, last] = kSupports[zeros];
  if (corners != 1 || !is_crossed(f)) return {};
  const auto place = place_on_line(ray, triangle.corner(first));
  if (!place) return {};
  const auto t = rounded_to(Real{}, *place);
  if (!t) return {};
  Hit<Real> hit;
  hit.t = *t == 0 ? Real{0} : *t;  // not -0
  hit.w = first == 0 ? Real{1} : Real{0};
  hit.u = first == 1 ? Real{1} : Real{0};
  hit.v = first == 2 ? Real{1} : Real{0};
  hit.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  return hit;
}

template std::optional<Hit<float>> round_at_corner<float>(const RayD&, const TriangleD&,
                                                          std::uint8_t, const Filtered&);
template std::optional<Hit<double>> round_at_corner<double>(const RayD&, const TriangleD&,
                                                            std::uint8_t, const Filtered&);

}  // namespace pierce::predicate
