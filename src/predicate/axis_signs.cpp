// SPDX-License-Identifier: Apache-2.0
#include "predicate/axis_signs.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/settle.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

// The axis across which the triangle stands and along which the ray moves, if there is one.
std::optional<int> axis_across(const RayD& ray, const TriangleD& triangle) {
  const unsigned axes = axes_across(triangle) & ~still_axes(ray.direction);
  if (axes == 0) return {};
  return std::countr_zero(axes);
}

bool is_power_of_two(double x) {
  int exponent = 0;
  return std::fabs(std::frexp(x, &exponent)) == 0.5;
}

// The corners as seen from a ray that moves along one axis alone, across that axis.
struct Across {
  int axis;
  double a_p, a_q, b_p, b_q, c_p, c_q;
};
// Nothing if it does not, or these are no doubles.
std::optional<Across> see_across(const RayD& ray, const TriangleD& t) {
  const unsigned moving = 7 & ~still_axes(ray.direction);
  if (std::popcount(moving) != 1) return {};
  const int axis = std::countr_zero(moving), p = (axis + 1) % 3, q = (axis + 2) % 3;
  bool exact = true;
  const auto see = [&](const Vec3<double>& corner, int k) {
    const Difference away(component(corner, k), component(ray.origin, k));
    exact &= away.exact;
    return away.value;
  };
  const Across seen{axis,        see(t.a, p), see(t.a, q), see(t.b, p),
                    see(t.b, q), see(t.c, p), see(t.c, q)};
  if (!exact) return {};
  return seen;
}

}  // namespace

std::optional<Quotient> place_across_axis(const RayD& ray, const TriangleD& triangle) {
  const auto axis = axis_across(ray, triangle);
  if (!axis) return {};
  const Difference way(component(triangle.a, *axis), component(ray.origin, *axis));
  if (!way.exact) return {};
  return Quotient{way.value, component(ray.direction, *axis)};
}

template <class Real>
std::optional<Real> round_across_axis(const RayD& ray, const TriangleD& triangle) {
  const auto axis = axis_across(ray, triangle);
  if (!axis) return {};
  const Difference way(component(triangle.a, *axis), component(ray.origin, *axis));
  const double speed = component(ray.direction, *axis);
  if (way.exact) return Quotient{way.value, speed}.rounded<Real>();
  // A distance that is no double is rounded by the difference, and a power of two does not round.
  if (!std::is_same_v<Real, double> || !is_power_of_two(speed)) return {};
  const double t = way.value / speed;
  if (!(std::fabs(t) >= 0x1p-1000 && std::fabs(t) <= 0x1p1000)) return {};
  return static_cast<Real>(t);
}

template std::optional<float> round_across_axis<float>(const RayD&, const TriangleD&);
template std::optional<double> round_across_axis<double>(const RayD&, const TriangleD&);

std::optional<AlongAxis> look_along_axis(const RayD& ray, const TriangleD& t) {
  const auto seen = see_across(ray, t);
  if (!seen) return {};
  const auto& [axis, a_p, a_q, b_p, b_q, c_p, c_q] = *seen;
  const auto u = order_of_products(c_p, a_q, c_q, a_p);
  const auto v = order_of_products(a_p, b_q, a_q, b_p);
  const auto w = order_of_products(b_p, c_q, b_q, c_p);
  if (!u || !v || !w) return {};
  const double speed = component(ray.direction, axis), start = component(ray.origin, axis);
  const int forward = speed < 0 ? -1 : 1;
  // The hit is between the first corner and the last.
  const auto reach = [&, k = axis](const Vec3<double>& p) {
    return (component(p, k) - start) / speed;
  };
  const double a = reach(t.a), b = reach(t.b), c = reach(t.c);
  const auto room = [](double x) {
    return bounds::kIntervalFactor * std::fabs(x) + 0x1p-1073;  // if it underflows
  };
  const double first = std::min({a, b, c}), last = std::max({a, b, c});
  AlongAxis along{forward * *u, forward * *v, forward * *w, {}};
  const Interval ends{first - room(first), last + room(last)};
  if (is_finite_number(ends.low) && is_finite_number(ends.high)) along.t = ends;
  return along;
}

std::uint8_t round_along_axis(const RayD& ray, const TriangleD& t, std::uint8_t wanted,
                              Hit<double>& hit) {
  const auto seen = see_across(ray, t);
  if (!seen) return 0;
  const auto& [axis, a_p, a_q, b_p, b_q, c_p, c_q] = *seen;
  const auto u = difference_of_products(c_p, a_q, c_q, a_p);
  const auto v = difference_of_products(a_p, b_q, a_q, b_p);
  const auto w = difference_of_products(b_p, c_q, b_q, c_p);
  if (!u || !v || !w) return 0;
  const exact::DoubleDouble den = *u + *v + *w;  // of one sign, all of them
  std::uint8_t set = 0;
  const auto round = [&](std::uint8_t number, const exact::DoubleDouble& weight, double& to) {
    if ((wanted & number) == 0) return;
    const exact::DoubleDouble quotient = weight / den;
    const double error = bounds::kAlongAxisWeights * std::fabs(quotient.high) +
                         bounds::kFineEnds * std::fabs(quotient.low);
    const double low = quotient.high + (quotient.low - error);
    if (low != quotient.high + (quotient.low + error) || !(std::fabs(low) >= 0x1p-900)) return;
    to = low;
    set |= number;
  };
  round(kNumberU, *u, hit.u);
  round(kNumberV, *v, hit.v);
  round(kNumberW, *w, hit.w);
  return set;
}

}  // namespace pierce::predicate
