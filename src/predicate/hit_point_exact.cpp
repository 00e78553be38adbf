// SPDX-License-Identifier: Apache-2.0
//
// X as a fraction, and the segment from X to s against a triangle.
//
// Key: points are (n, w) with w > 0, standing for n / w; X is (o |den| +- T d, |den|). p, q, r are
// the other triangle's corners, N its normal; v(x) = N . (n - p w) says on which side of its plane
// a point lies, times w.
#include "predicate/hit_point_exact.h"

#include "exact/round_ratio.h"
#include "predicate/exact_pair.h"
#include "predicate/passage.h"

namespace pierce::predicate {
namespace {

using exact::BigInt;
using Vector = Triple<BigInt>;

struct Point {
  Vector n;
  BigInt w;
};

Vector operator*(const Vector& p, const BigInt& k) { return {p.x * k, p.y * k, p.z * k}; }
Vector operator+(const Vector& p, const Vector& q) { return {p.x + q.x, p.y + q.y, p.z + q.z}; }

int place_of(const exact::BitSpan& span) { return span.empty() ? 0 : span.low; }

Point exact_point(const HitPoint& hit, const Places& places) {
  const auto parts = exact_parts<BigInt>(hit.ray, hit.triangle, places);
  const auto pair = exact_pair(parts);
  const auto o = scaled_triple<BigInt>(hit.ray.origin, place_of(places.points));
  return {o * pair.value.den + parts.d * pair.value.t, pair.value.den};
}

// A triangle's plane and its edges.
struct Plane {
  Vector corner[3];
  Vector normal;

  Plane(const TriangleD& t, int place)
      : corner{scaled_triple<BigInt>(t.a, place), scaled_triple<BigInt>(t.b, place),
               scaled_triple<BigInt>(t.c, place)},
        normal(cross(corner[1] - corner[0], corner[2] - corner[0])) {}

  [[nodiscard]] bool has_area() const {
    return sign_of(normal.x) != 0 || sign_of(normal.y) != 0 || sign_of(normal.z) != 0;
  }
  [[nodiscard]] BigInt side(const Point& x) const { return dot(normal, x.n - corner[0] * x.w); }
  // Of edge i: positive on the triangle's side, for a point of the plane, or for a direction in it.
  [[nodiscard]] int inside(std::size_t i, const Vector& offset) const {
    return sign_of(dot(normal, cross(corner[(i + 1) % 3] - corner[i], offset)));
  }
  [[nodiscard]] int inside(std::size_t i, const Point& x) const {
    return inside(i, x.n - corner[i] * x.w);
  }
  [[nodiscard]] bool holds(const Point& x) const {
    return inside(0, x) >= 0 && inside(1, x) >= 0 && inside(2, x) >= 0;
  }
};

// x lies in the plane but not in the triangle: does all of the way to s, in the plane too, stay on
// the outer side of one edge?
bool passes_outside(const Plane& plane, const Point& x, const Point& s) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (plane.inside(i, x) < 0 && plane.inside(i, s) < 0) return true;
  }
  return false;
}

// x is a point of the triangle: do all the directions, which lie in its plane, lead out of it over
// one and the same edge?
bool lead_outside(const Plane& plane, const Point& x, std::initializer_list<const Vector*> ways) {
  for (std::size_t i = 0; i < 3; ++i) {
    bool all = plane.inside(i, x) == 0;
    for (const Vector* way : ways) all = all && plane.inside(i, *way) < 0;
    if (all) return true;
  }
  return false;
}

// From s to the points next to x along the way: as these approach x, the path crosses the plane
// ever nearer to x, in the direction that is between both and in the plane.
bool open_from_triangle(const Plane& plane, const Point& x, const Point& s, const Vector& towards) {
  const Vector to_s = s.n * x.w - x.n * s.w;
  const BigInt way = dot(plane.normal, towards);
  const BigInt rise = dot(plane.normal, to_s);
  if (sign_of(way) == 0 && sign_of(rise) == 0) return lead_outside(plane, x, {&to_s, &towards});
  if (sign_of(way) == sign_of(rise)) return true;
  const Vector between = towards * abs(rise) + to_s * abs(way);
  return lead_outside(plane, x, {&between});
}

bool open_past(const Plane& plane, const Point& x, const Point& s, const Vector& towards) {
  const BigInt x_value = plane.side(x);
  const BigInt s_value = plane.side(s);
  const int x_side = sign_of(x_value);
  const int s_side = sign_of(s_value);
  if (x_side == 0) {
    if (plane.holds(x)) return open_from_triangle(plane, x, s, towards);
    return s_side != 0 || passes_outside(plane, x, s);
  }
  if (s_side == x_side) return true;
  if (s_side == 0) return !plane.holds(s);
  // Where the segment meets the plane: weights |v(s)| / w_s of X and |v(x)| / w_x of s.
  const BigInt x_weight = abs(s_value);
  const BigInt s_weight = abs(x_value);
  return !plane.holds({x.n * x_weight + s.n * s_weight, x.w * x_weight + s.w * s_weight});
}

}  // namespace

Vec3<double> rounded_exactly(const HitPoint& hit) {
  Places places(hit.ray);
  places.include(hit.triangle);
  const Point x = exact_point(hit, places);
  const auto round = [&](const BigInt& n) {
    return exact::round_ratio<double>(n, x.w, place_of(places.points));
  };
  return {round(x.n.x), round(x.n.y), round(x.n.z)};
}

int side_exactly(const Vec3<double>& s, const TriangleD& t) {
  Places places(RayD{s, {1, 0, 0}});
  places.include(t);
  const int place = place_of(places.points);
  return sign_of(Plane(t, place).side({scaled_triple<BigInt>(s, place), 1}));
}

int direction_exactly(const TriangleD& t, const Vec3<double>& direction) {
  Places places(RayD{t.a, direction});
  places.include(t);
  const Plane plane(t, place_of(places.points));
  return sign_of(dot(plane.normal, scaled_triple<BigInt>(direction, place_of(places.direction))));
}

int way_exactly(const HitPoint& hit, const TriangleD& other) {
  Places places(hit.ray);
  places.include(hit.triangle);
  places.include(other);
  const Plane plane(other, place_of(places.points));
  const int side = sign_of(plane.side(exact_point(hit, places)));
  if (side != 0) return side;
  return sign_of(dot(plane.normal, scaled_triple<BigInt>(hit.towards, place_of(places.direction))));
}

bool open_exactly(const HitPoint& hit, const Vec3<double>& s, const TriangleD& other) {
  Places places(hit.ray);
  places.include(hit.triangle);
  places.include(other);
  places.include(TriangleD{s, s, s});
  const Plane plane(other, place_of(places.points));
  if (!plane.has_area()) return !decide_on_triangle(s, other);
  return open_past(plane, exact_point(hit, places),
                   {scaled_triple<BigInt>(s, place_of(places.points)), 1},
                   scaled_triple<BigInt>(hit.towards, place_of(places.direction)));
}

}  // namespace pierce::predicate
