// SPDX-License-Identifier: Apache-2.0
#include "predicate/axis_signs.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/settle.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

using Axis = double Vec3<double>::*;
constexpr Axis kAxes[] = {&Vec3<double>::x, &Vec3<double>::y, &Vec3<double>::z};

// How far apart two coordinates are; nothing if that is no double.
std::optional<double> distance(double from, double to) {
  const exact::DoubleDouble difference = exact::two_sum(to, -from);
  if (difference.low != 0) return {};
  return difference.high;
}

// The axis across which the triangle stands and along which the ray moves, if there is one.
std::optional<Axis> axis_across(const RayD& ray, const TriangleD& t) {
  for (const Axis axis : kAxes) {
    if (t.b.*axis == t.a.*axis && t.c.*axis == t.a.*axis && ray.direction.*axis != 0) return axis;
  }
  return {};
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
  const unsigned still = still_axes(ray.direction);
  const int axis = still == 6 ? 0 : still == 5 ? 1 : still == 3 ? 2 : -1;
  if (axis < 0) return {};
  const Axis p = kAxes[(axis + 1) % 3], q = kAxes[(axis + 2) % 3];
  const auto see = [&](const Vec3<double>& corner, Axis k) {
    return distance(ray.origin.*k, corner.*k);
  };
  const auto a_p = see(t.a, p), a_q = see(t.a, q), b_p = see(t.b, p), b_q = see(t.b, q),
             c_p = see(t.c, p), c_q = see(t.c, q);
  if (!a_p || !a_q || !b_p || !b_q || !c_p || !c_q) return {};
  return Across{axis, *a_p, *a_q, *b_p, *b_q, *c_p, *c_q};
}

}  // namespace

std::optional<Quotient> place_across_axis(const RayD& ray, const TriangleD& triangle) {
  const auto axis = axis_across(ray, triangle);
  if (!axis) return {};
  const auto way = distance(ray.origin.*(*axis), triangle.a.*(*axis));
  if (!way) return {};
  return Quotient{*way, ray.direction.*(*axis)};
}

template <class Real>
std::optional<Real> round_across_axis(const RayD& ray, const TriangleD& triangle) {
  if (const auto place = place_across_axis(ray, triangle)) return place->rounded<Real>();
  const auto axis = axis_across(ray, triangle);
  if (!std::is_same_v<Real, double> || !axis) return {};
  // A distance that is no double is rounded by the difference, and a power of two does not round.
  const double speed = ray.direction.*(*axis);
  if (!is_power_of_two(speed)) return {};
  const double t = (triangle.a.*(*axis) - ray.origin.*(*axis)) / speed;
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
  const double speed = ray.direction.*kAxes[axis], start = ray.origin.*kAxes[axis];
  const int forward = speed < 0 ? -1 : 1;
  // The hit is between the first corner and the last.
  const double a = (t.a.*kAxes[axis] - start) / speed, b = (t.b.*kAxes[axis] - start) / speed,
               c = (t.c.*kAxes[axis] - start) / speed;
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
