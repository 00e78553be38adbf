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
  [[nodiscard]] BigInt inside(std::size_t i, const Vector& offset) const {
    return dot(normal, cross(corner[(i + 1) % 3] - corner[i], offset));
  }
  [[nodiscard]] BigInt inside(std::size_t i, const Point& x) const {
    return inside(i, x.n - corner[i] * x.w);
  }
  [[nodiscard]] bool holds(const Point& x) const {
    return sign_of(inside(0, x)) >= 0 && sign_of(inside(1, x)) >= 0 && sign_of(inside(2, x)) >= 0;
  }
};

// A number that depends on where the way ends, at x + e towards: c0 + c1 e, for every e that is
// small enough and positive.
struct Nearing {
  BigInt c0, c1;

  [[nodiscard]] int sign() const { return sign_of(c0) != 0 ? sign_of(c0) : sign_of(c1); }
};

// The way from s to its end, at x + e towards.
struct Way {
  Point s, x;
  Vector towards;

  [[nodiscard]] Nearing end_side(const Plane& plane) const {
    return {plane.side(x), dot(plane.normal, towards) * x.w};
  }
  [[nodiscard]] Nearing end_inside(const Plane& plane, std::size_t i) const {
    return {plane.inside(i, x), plane.inside(i, towards) * x.w};
  }
};

// The end lies in the plane: in the triangle?
bool ends_in(const Plane& plane, const Way& way) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (way.end_inside(plane, i).sign() < 0) return false;
  }
  return true;
}

// All of the way lies in the plane. It is apart from the triangle iff the line of an edge, or its
// own, has one strictly on one side, and the other not.
bool is_apart_in_plane(const Plane& plane, const Way& way) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (sign_of(plane.inside(i, way.s)) < 0 && way.end_inside(plane, i).sign() < 0) return true;
  }
  const Vector to_x = way.x.n * way.s.w - way.s.n * way.x.w;
  int sides[3];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector to_corner = plane.corner[i] * way.s.w - way.s.n;
    sides[i] = Nearing{dot(plane.normal, cross(to_corner, to_x)),
                       dot(plane.normal, cross(to_corner, way.towards)) * way.x.w}
                   .sign();
  }
  return sides[0] != 0 && sides[0] == sides[1] && sides[0] == sides[2];
}

// The way crosses the plane, for s and its end lie on different sides: at the mean of both with the
// weights |v(end)| of s and |v(s)| of the end.
bool crosses_outside(const Plane& plane, const Way& way, const BigInt& s_side,
                     const Nearing& end_side) {
  const BigInt end_weight = abs(s_side);
  const bool negative = end_side.sign() < 0;
  const Nearing s_weight{negative ? BigInt(-end_side.c0) : end_side.c0,
                         negative ? BigInt(-end_side.c1) : end_side.c1};
  for (std::size_t i = 0; i < 3; ++i) {
    const BigInt s_inside = plane.inside(i, way.s);
    const Nearing end_inside = way.end_inside(plane, i);
    const Nearing inside{s_weight.c0 * s_inside + end_weight * end_inside.c0,
                         s_weight.c1 * s_inside + end_weight * end_inside.c1};
    if (inside.sign() < 0) return true;
  }
  return false;
}

bool open_past(const Plane& plane, const Way& way) {
  const BigInt s_side = plane.side(way.s);
  const Nearing end_side = way.end_side(plane);
  const int s_sign = sign_of(s_side), end_sign = end_side.sign();
  if (s_sign == 0 && end_sign == 0) return is_apart_in_plane(plane, way);
  if (s_sign == 0) return !plane.holds(way.s);
  if (end_sign == 0) return !ends_in(plane, way);
  return s_sign == end_sign || crosses_outside(plane, way, s_side, end_side);
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
  return open_past(plane, {{scaled_triple<BigInt>(s, place_of(places.points)), 1},
                           exact_point(hit, places),
                           scaled_triple<BigInt>(hit.towards, place_of(places.direction))});
}

}  // namespace pierce::predicate
