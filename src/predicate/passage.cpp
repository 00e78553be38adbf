// SPDX-License-Identifier: Apache-2.0
#include "predicate/passage.h"

#include <algorithm>
#include <cmath>

#include "predicate/certify.h"
#include "predicate/exact_pair.h"

namespace pierce::predicate {
namespace {

// The sign of s . p for the symbolic shift s.
template <class Number>
int sign_of_shift(const Triple<Number>& p) {
  if (const int x = sign_of(p.x); x != 0) return x;
  if (const int y = sign_of(p.y); y != 0) return y;
  return sign_of(p.z);
}

template <class Integer>
int passage_in(const RayD& ray, const TriangleD& triangle, const Places& places) {
  const ExactParts<Integer> parts = exact_parts<Integer>(ray, triangle, places);
  const auto pair = exact_pair(parts);
  if (pair.den_sign == 0) return 0;
  // Inside of each edge: its side if that is not zero, else what the shift makes of it. (Not zero
  // either: an edge along the ray would make den zero.)
  const auto inside = [&](const auto& side, const auto& edge) {
    const int sign = sign_of(side);
    return (sign != 0 ? sign : pair.den_sign * sign_of_shift(cross(parts.d, edge))) > 0;
  };
  if (!inside(pair.value.v, parts.e1) ||                                                // (a, b)
      !inside(pair.value.w, parts.e2 - parts.e1) ||                                     // (b, c)
      !inside(pair.value.u, Triple<Integer>{-parts.e2.x, -parts.e2.y, -parts.e2.z})) {  // (c, a)
    return 0;
  }
  const auto above = [&](double bound) {
    const int sign = compare_t(pair, bound);
    return (sign != 0 ? sign : -pair.den_sign * sign_of_shift(cross(parts.e1, parts.e2))) > 0;
  };
  return above(ray.t_min) && !above(ray.t_max) ? pair.den_sign : 0;
}

// Of the segment (p, q), by the signs of (x - p) x (q - p) and (x - p) . (x - q).
template <class Integer>
bool on_segment(const Triple<Integer>& from_p, const Triple<Integer>& from_q) {
  const auto area = cross(from_p, from_q);
  return sign_of(area.x) == 0 && sign_of(area.y) == 0 && sign_of(area.z) == 0 &&
         sign_of(dot(from_p, from_q)) <= 0;
}

// p, q, r: the corners as seen from the point.
template <class Integer>
bool holds_origin(const Triple<Integer>& p, const Triple<Integer>& q, const Triple<Integer>& r) {
  const auto normal = cross(q - p, r - p);
  if (sign_of_shift(normal) == 0) {
    return on_segment(p, q) || on_segment(q, r) || on_segment(r, p);
  }
  if (sign_of(dot(normal, p)) != 0) return false;
  // In its plane: on the same side of all edges as the normal says.
  const auto side = [&](const Triple<Integer>& from, const Triple<Integer>& to) {
    const auto area = cross(from, to);
    const int x = sign_of(area.x) * sign_of(normal.x);
    const int y = sign_of(area.y) * sign_of(normal.y);
    return x != 0 ? x : y != 0 ? y : sign_of(area.z) * sign_of(normal.z);
  };
  return side(p, q) >= 0 && side(q, r) >= 0 && side(r, p) >= 0;
}

bool within(double x, double a, double b, double c) {
  return x >= std::min({a, b, c}) && x <= std::max({a, b, c});
}

}  // namespace

Passage decide_passage(const RayD& ray, const TriangleD& triangle, LadderCounts& counts) {
  // Sure of a hit in double means sure that nothing is zero: the shift changes nothing.
  const Filtered filtered = filter_determinants(ray, triangle);
  const Certified hit = certify_hit(filtered, ray);
  if (hit != Certified::Unsure) {
    ++counts.certified;
    if (hit == Certified::No) return Passage::None;
    return filtered.value.den > 0 ? Passage::Leaving : Passage::Entering;
  }
  int passage = 0;
  const Width width = with_places(
      ray,
      [&]<class Integer>(const Places& places) {
        passage = passage_in<Integer>(ray, triangle, places);
      },
      triangle);
  ++(width == Width::Any ? counts.settled_big : counts.settled);
  return static_cast<Passage>(passage);
}

bool decide_on_triangle(const Vec3<double>& point, const TriangleD& t) {
  if (!within(point.x, t.a.x, t.b.x, t.c.x) || !within(point.y, t.a.y, t.b.y, t.c.y) ||
      !within(point.z, t.a.z, t.b.z, t.c.z)) {
    return false;
  }
  bool on = false;
  with_places(
      RayD{point, {1, 0, 0}},
      [&]<class Integer>(const Places& places) {
        const int place = places.points.empty() ? 0 : places.points.low;
        const auto x = scaled_triple<Integer>(point, place);
        on = holds_origin<Integer>(scaled_triple<Integer>(t.a, place) - x,
                                   scaled_triple<Integer>(t.b, place) - x,
                                   scaled_triple<Integer>(t.c, place) - x);
      },
      t);
  return on;
}

}  // namespace pierce::predicate
