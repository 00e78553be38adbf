// SPDX-License-Identifier: Apache-2.0
//
// In double-double, each number with its bound (in double first where many triangles are asked
// about); where that is unsure, in integers of any size (see hit_point_exact.cpp).
#include "predicate/hit_point.h"

#include <cmath>

#include "exact/round_ratio.h"
#include "predicate/exact_pair.h"
#include "predicate/hit_point_exact.h"

namespace pierce::predicate {
namespace {

using exact::Bounded;
using exact::DoubleDouble;
using Number = HitPoint::Number;

Number number(double x) { return {{x, 0}, 0}; }
Triple<Number> numbers(const Vec3<double>& p) { return {number(p.x), number(p.y), number(p.z)}; }
Number difference(double a, double b) { return {exact::two_sum(a, -b), 0}; }
Triple<Number> difference(const Vec3<double>& p, const Vec3<double>& q) {
  return {difference(p.x, q.x), difference(p.y, q.y), difference(p.z, q.z)};
}

// The sign if it is sure, else 0.
int sure_sign(const Number& x) {
  const double value = x.value.high + x.value.low;
  if (value - x.err > 0) return 1;
  return value + x.err < 0 ? -1 : 0;
}

Triple<Number> normal_of(const TriangleD& t) {
  return cross(difference(t.b, t.a), difference(t.c, t.a));
}

// The same in double.
using Rough = Bounded<double>;
Rough rough(double x) { return {x, 0}; }
Rough rough(const Number& x) {
  return {x.value.high, (x.err + std::fabs(x.value.low)) * exact::kErrorRoom};
}
Triple<Rough> rough(const Vec3<double>& p) { return {rough(p.x), rough(p.y), rough(p.z)}; }

int sure_sign(const Rough& x) {
  if (x.value > x.err) return 1;
  return x.value < -x.err ? -1 : 0;
}

// Whether X and s are for sure on one side of the triangle's plane.
bool surely_on_one_side(const HitPoint& hit, const Vec3<double>& s, const TriangleD& t) {
  const Triple<Rough> a = rough(t.a);
  const Triple<Rough> n = cross(rough(t.b) - a, rough(t.c) - a);
  const int side = sure_sign(dot(n, rough(s) - a));
  const Triple<Rough> x{rough(hit.near.x), rough(hit.near.y), rough(hit.near.z)};
  return side != 0 && side == sure_sign(dot(n, x - a));
}

// X as seen from a corner.
Triple<Number> seen_from(const Vec3<double>& corner, const HitPoint& hit) {
  return {hit.near.x - number(corner.x), hit.near.y - number(corner.y),
          hit.near.z - number(corner.z)};
}

bool lies_in_plane_of(const Triple<Number>& normal, const Vec3<double>& corner,
                      const TriangleD& other) {
  return is_zero(dot(normal, difference(other.a, corner))) &&
         is_zero(dot(normal, difference(other.b, corner))) &&
         is_zero(dot(normal, difference(other.c, corner)));
}

}  // namespace

HitPoint::HitPoint(const RayD& r, const TriangleD& t, Side side)
    : ray{r.origin, r.direction}, triangle(t), towards(r.direction) {
  if (side == Side::Before) towards = {-towards.x, -towards.y, -towards.z};
  const Triple<Number> n = normal_of(t);
  const Triple<Number> d = numbers(r.direction);
  const Number place = dot(n, difference(t.a, r.origin)) / dot(n, d);
  near = {number(r.origin.x) + place * d.x, number(r.origin.y) + place * d.y,
          number(r.origin.z) + place * d.z};
  const int sure = sure_sign(dot(n, numbers(towards)));
  way_side = sure != 0 ? sure : direction_exactly(triangle, towards);
}

Vec3<double> HitPoint::rounded() const {
  const auto sure = [](const Number& x, const Number& y, const Number& z) {
    const double size = std::fmax(std::fmax(std::fabs(x.value.high), std::fabs(y.value.high)),
                                  std::fabs(z.value.high));
    return x.err <= 0x1p-90 * size && y.err <= 0x1p-90 * size && z.err <= 0x1p-90 * size;
  };
  if (sure(near.x, near.y, near.z))
    return {near.x.value.high, near.y.value.high, near.z.value.high};
  return rounded_exactly(*this);
}

int decide_side(const Vec3<double>& s, const TriangleD& t) {
  const int sure = sure_sign(dot(normal_of(t), difference(s, t.a)));
  return sure != 0 ? sure : side_exactly(s, t);
}

bool decide_open(const HitPoint& hit, const Vec3<double>& s, const TriangleD& other) {
  if (surely_on_one_side(hit, s, other)) return true;
  const Triple<Number> n = normal_of(other);
  const int s_side = sure_sign(dot(n, difference(s, other.a)));
  if (s_side != 0) {
    if (sure_sign(dot(n, seen_from(other.a, hit))) == s_side) return true;
    // In one plane: X is neither before nor behind it.
    if (sure_sign(dot(n, numbers(hit.towards))) == s_side &&
        lies_in_plane_of(normal_of(hit.triangle), hit.triangle.a, other)) {
      return true;
    }
  }
  return open_exactly(hit, s, other);
}

int decide_way(const HitPoint& hit, const TriangleD& other) {
  const int sure = sure_sign(dot(normal_of(other), seen_from(other.a, hit)));
  return sure != 0 ? sure : way_exactly(hit, other);
}

}  // namespace pierce::predicate
