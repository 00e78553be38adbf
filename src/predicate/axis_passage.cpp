// SPDX-License-Identifier: Apache-2.0
//
// Key: i, j are the axes that follow `axis` in turn; q, r, s are the corners a, b, c as seen from
// the point. The side of an edge (p, q) is p_i q_j - p_j q_i; the three sides add up to N's
// component along the axis, and sum of side * opposite corner's component along it is T.
#include "predicate/axis_passage.h"

#include <algorithm>
#include <cmath>

#include "exact/double_double.h"
#include "predicate/exact_pair.h"
#include "predicate/filtered.h"
#include "predicate/passage.h"
#include "predicate/quotient.h"

namespace pierce::predicate {
namespace {

constexpr int kUnsure = 2;

// A corner, or the point, seen along an axis.
struct Seen {
  double i, j;

  Seen(const Vec3<double>& p, int axis)
      : i(component(p, (axis + 1) % 3)), j(component(p, (axis + 2) % 3)) {}
};

// The side of the edge (p, q), or kUnsure.
int certify_side(const Seen& point, const Seen& p, const Seen& q) {
  const Difference pi(p.i, point.i), pj(p.j, point.j), qi(q.i, point.i), qj(q.j, point.j);
  const double left = pi.value * qj.value;
  const double right = pj.value * qi.value;
  const double side = left - right;
  const double error =
      bounds::kSideFactor * std::max(std::fabs(left), std::fabs(right)) + bounds::kSideFloor;
  if (std::fabs(side) > error) return sign_of_double(side);
  if (!pi.exact || !pj.exact || !qi.exact || !qj.exact) return kUnsure;
  return order_of_products(pi.value, qj.value, pj.value, qi.value).value_or(kUnsure);
}

RayD ray_along(const Vec3<double>& origin, std::uint8_t axis, bool forward) {
  const double step = forward ? 1 : -1;
  return {origin, {axis == 0 ? step : 0, axis == 1 ? step : 0, axis == 2 ? step : 0}};
}

struct Sides {
  int bc, ca, ab;

  [[nodiscard]] bool apart() const {  // surely on different sides of two edges
    return (bc == 1 || ca == 1 || ab == 1) && (bc == -1 || ca == -1 || ab == -1);
  }
  [[nodiscard]] bool unsure() const { return bc == kUnsure || ca == kUnsure || ab == kUnsure; }
};

Sides settle_sides(const Vec3<double>& point, std::uint8_t axis, const TriangleD& triangle,
                   LadderCounts& counts) {
  Sides sides{};
  const auto settle = [&]<class Integer>(const Places& places) {
    const int place = places.points.empty() ? 0 : places.points.low;
    const auto origin = scaled_triple<Integer>(point, place);
    const auto a = scaled_triple<Integer>(triangle.a, place) - origin;
    const auto b = scaled_triple<Integer>(triangle.b, place) - origin;
    const auto c = scaled_triple<Integer>(triangle.c, place) - origin;
    const auto side = [axis](const Triple<Integer>& p, const Triple<Integer>& q) {
      const auto all = cross(p, q);
      return sign_of(axis == 0 ? all.x : axis == 1 ? all.y : all.z);
    };
    sides = {side(b, c), side(c, a), side(a, b)};
  };
  const Width width = with_places(RayD{point, {1, 0, 0}}, settle, triangle);
  ++(width == Width::Any ? counts.settled_big : counts.settled);
  return sides;
}

// What the symbolic shift makes of a side that is zero: the sign of s . (axis x (q - p)), that is
// of -(q_j - p_j) on axis i and (q_i - p_i) on axis j, the smaller axis first.
int sign_of_shifted_side(const Seen& p, const Seen& q, std::uint8_t axis) {
  const int on_i = sign_of_double(p.j - q.j);
  const int on_j = sign_of_double(q.i - p.i);
  const bool i_first = axis != 1;  // of z (i) and x (j), x comes first
  const int first = i_first ? on_i : on_j;
  return first != 0 ? first : (i_first ? on_j : on_i);
}

}  // namespace

Shadow decide_shadow(const Vec3<double>& point, std::uint8_t axis, const TriangleD& triangle,
                     LadderCounts& counts) {
  const Seen p(point, axis), a(triangle.a, axis), b(triangle.b, axis), c(triangle.c, axis);
  Sides sides{certify_side(p, b, c), certify_side(p, c, a), certify_side(p, a, b)};
  if (!sides.apart() && sides.unsure()) {
    sides = settle_sides(point, axis, triangle, counts);
  } else {
    ++counts.certified;
  }
  if (sides.apart()) return {};
  Shadow shadow;
  shadow.touched = true;
  shadow.facing = sides.bc != 0 ? sides.bc : sides.ca != 0 ? sides.ca : sides.ab;
  if (shadow.facing == 0) return shadow;
  const auto within = [&](int side, const Seen& from, const Seen& to) {
    return (side != 0 ? side : sign_of_shifted_side(from, to, axis)) == shadow.facing;
  };
  shadow.passed = within(sides.bc, b, c) && within(sides.ca, c, a) && within(sides.ab, a, b);
  return shadow;
}

int decide_shifted_side(const Vec3<double>& point, std::uint8_t axis, const Vec3<double>& p,
                        const Vec3<double>& q, LadderCounts& counts) {
  const Seen from(p, axis), to(q, axis);
  int side = certify_side(Seen(point, axis), from, to);
  if (side == kUnsure) side = settle_sides(point, axis, {p, p, q}, counts).bc;
  return side != 0 ? side : sign_of_shifted_side(from, to, axis);
}

int decide_side_of_plane(const Vec3<double>& point, const TriangleD& triangle,
                         LadderCounts& counts) {
  const RayD ray = ray_along(point, 0, true);
  const Filtered filtered = filter_determinants(ray, triangle);
  if (filtered.usable && std::fabs(filtered.value.t) > filtered.t_err) {
    ++counts.certified;
    return sign_of_double(filtered.value.t);
  }
  int sign = 0;
  const Width width = with_places(
      ray,
      [&]<class Integer>(const Places& places) {
        const auto parts = exact_parts<Integer>(ray, triangle, places);
        sign = sign_of(dot(cross(parts.e1, parts.e2), parts.s));
      },
      triangle);
  ++(width == Width::Any ? counts.settled_big : counts.settled);
  return sign;
}

AxisPassage decide_axis_passage(const Vec3<double>& origin, AxisDirection along,
                                const TriangleD& triangle, LadderCounts& counts) {
  const double at = component(origin, along.axis);
  const double a = component(triangle.a, along.axis);
  const double b = component(triangle.b, along.axis);
  const double c = component(triangle.c, along.axis);
  const double lowest = std::min({a, b, c});
  const double highest = std::max({a, b, c});
  if (along.forward ? highest < at : lowest > at) return AxisPassage::None;
  if (origin == triangle.a || origin == triangle.b || origin == triangle.c) {
    return AxisPassage::OnTriangle;
  }

  const Shadow shadow = decide_shadow(origin, along.axis, triangle, counts);
  if (!shadow.touched) return AxisPassage::None;
  if (lowest <= at && at <= highest) {
    if (shadow.facing == 0) {
      return decide_on_triangle(origin, triangle) ? AxisPassage::OnTriangle : AxisPassage::None;
    }
    const bool level = lowest == highest;  // the plane is square to the axis, and the origin in it
    const int side = level ? 0 : decide_side_of_plane(origin, triangle, counts);
    if (side == 0) return AxisPassage::OnTriangle;
    // t = T / (N . d) must be positive.
    if (side != (along.forward ? shadow.facing : -shadow.facing)) return AxisPassage::None;
  }
  if (!shadow.passed) return AxisPassage::None;
  return (shadow.facing > 0) == along.forward ? AxisPassage::Leaving : AxisPassage::Entering;
}

}  // namespace pierce::predicate
