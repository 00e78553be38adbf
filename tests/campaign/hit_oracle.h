// SPDX-License-Identifier: Apache-2.0
//
// Hits and crossings by their definitions, in integers. With A = a - o, B = b - o, C = c - o the
// line o + t d meets the plane at t = A . (B x C) / N . d, and the corners weigh there as
// d . (B x C), d . (C x A), d . (A x B) do against their sum, N . d.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "campaign/world.h"
#include "pierce/options.h"

namespace pierce::campaign {

struct ExactHit {
  Ratio t, u, v, w;
  TriangleRef ref;
  Facing facing;
};

/// A ray over doubles, and what it does not see.
struct Question {
  Point origin, direction;
  double t_min, t_max;
  Range range = Range::Closed;
  TriangleRef skip = {};
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;
  std::span<const std::uint32_t> masks = {};  // of the geometries; none: all bits

  [[nodiscard]] bool sees(const TriangleRef& ref) const {
    return ref != skip && ((masks.empty() ? kAllBits : masks[ref.geometry]) & mask) != 0;
  }
  [[nodiscard]] bool sees(Facing facing) const {
    return sides == Sides::Both || (sides == Sides::Front) == (facing == Facing::Front);
  }
};

/// One line and one triangle as integers: the determinants that everything is decided by.
struct LineAndTriangle {
  IntVec d, a, b, c;           // corners relative to the origin
  IntVec normal;               // (b - a) x (c - a)
  Int side_a, side_b, side_c;  // of the edges opposite a, b, c
  Int den, top;                // N . d, and the numerator of t

  LineAndTriangle(const Point& origin, const Point& direction, const Corners& corners) {
    Scale scale;
    scale.see(origin).see(direction).see(corners.a).see(corners.b).see(corners.c);
    const IntVec o = scale.integers(origin);
    d = scale.integers(direction);
    a = scale.integers(corners.a) - o;
    b = scale.integers(corners.b) - o;
    c = scale.integers(corners.c) - o;
    normal = cross(b - a, c - a);
    side_a = dot(d, cross(b, c));
    side_b = dot(d, cross(c, a));
    side_c = dot(d, cross(a, b));
    den = dot(normal, d);
    top = dot(normal, a);
  }
};

/// The hit of the whole line, -inf < t < inf.
inline std::optional<ExactHit> line_hit(const Point& o, const Point& d, const Placed& placed) {
  const LineAndTriangle m(o, d, placed.corners);
  const int sign = sgn(m.den);
  if (sign == 0) return std::nullopt;
  for (const Int* side : {&m.side_a, &m.side_b, &m.side_c}) {
    if (sgn(*side) * sign < 0) return std::nullopt;
  }
  return ExactHit{ratio(m.top, m.den),
                  ratio(m.side_b, m.den),
                  ratio(m.side_c, m.den),
                  ratio(m.side_a, m.den),
                  placed.ref,
                  sign < 0 ? Facing::Front : Facing::Back};
}

/// -1, 0 or 1 as t is less than, equal to or greater than a number that may be infinite.
inline int compare(const Ratio& t, double end) {
  if (std::isinf(end)) return end > 0 ? -1 : 1;
  return cmp(t, Ratio(end));
}

inline bool in_range(const Ratio& t, const Question& question) {
  const int start = compare(t, question.t_min);
  if (start < 0 || (start == 0 && question.range == Range::OpenStart)) return false;
  return compare(t, question.t_max) <= 0;
}

/// All hits of the line in their order.
inline std::vector<ExactHit> line_hits(const World& near, const Point& o, const Point& d) {
  std::vector<ExactHit> hits;
  for (const Placed& placed : near) {
    if (auto hit = line_hit(o, d, placed)) hits.push_back(std::move(*hit));
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const ExactHit& p, const ExactHit& q) { return p.t < q.t; });
  return hits;
}

/// Those of the line's hits that the question asks for.
inline std::vector<ExactHit> asked(const std::vector<ExactHit>& line, const Question& question) {
  std::vector<ExactHit> hits;
  for (const ExactHit& hit : line) {
    if (question.sees(hit.ref) && question.sees(hit.facing) && in_range(hit.t, question)) {
      hits.push_back(hit);
    }
  }
  return hits;
}

template <class Real>
Hit<Real> rounded_hit(const ExactHit& hit) {
  return {rounded<Real>(hit.t),
          rounded<Real>(hit.u),
          rounded<Real>(hit.v),
          rounded<Real>(hit.w),
          hit.ref.geometry,
          hit.ref.triangle,
          hit.facing};
}

/// Whether the shifted ray has passed `end` when it meets the plane: the sign of t - end.
inline int shifted_compare(const LineAndTriangle& m, double end) {
  if (std::isinf(end)) return end > 0 ? -1 : 1;
  const int sign = sgn(m.den);
  const Ratio difference = Ratio(m.top) - Ratio(end) * Ratio(m.den);
  if (difference != 0) return sgn(difference) * sign;
  return -infinitesimal_sign(m.normal) * sign;
}

/// +1 for leaving, -1 for entering, 0 for no passage of the shifted ray through the triangle.
inline int passage(const Question& ray, const Corners& corners) {
  const LineAndTriangle m(ray.origin, ray.direction, corners);
  const int sign = sgn(m.den);
  if (sign == 0) return 0;
  const auto side = [&](const Int& value, const IntVec& p, const IntVec& q) {
    return value != 0 ? sgn(value) : infinitesimal_sign(cross(m.d, q - p));
  };
  if (side(m.side_a, m.b, m.c) != sign || side(m.side_b, m.c, m.a) != sign ||
      side(m.side_c, m.a, m.b) != sign) {
    return 0;
  }
  if (shifted_compare(m, ray.t_min) < 0 || shifted_compare(m, ray.t_max) > 0) return 0;
  return sign;
}

/// Whether p lies on the closed triangle, which may be but a segment or a point.
inline bool lies_on(const Point& p, const Corners& corners) {
  const auto outside = [](double x, double a, double b, double c) {
    return x < std::min({a, b, c}) || x > std::max({a, b, c});
  };
  const auto& [ca, cb, cc] = corners;
  if (outside(p.x, ca.x, cb.x, cc.x) || outside(p.y, ca.y, cb.y, cc.y) ||
      outside(p.z, ca.z, cb.z, cc.z)) {
    return false;
  }
  Scale scale;
  scale.see(p).see(ca).see(cb).see(cc);
  const IntVec o = scale.integers(p);
  const IntVec a = scale.integers(ca) - o, b = scale.integers(cb) - o, c = scale.integers(cc) - o;
  const IntVec normal = cross(b - a, c - a);
  const auto on_segment = [](const IntVec& q, const IntVec& r) {
    return is_zero(cross(q, r)) && dot(q, r) <= 0;
  };
  if (is_zero(normal)) return on_segment(a, b) || on_segment(b, c) || on_segment(c, a);
  return dot(normal, a) == 0 && dot(normal, cross(a, b)) >= 0 && dot(normal, cross(b, c)) >= 0 &&
         dot(normal, cross(c, a)) >= 0;
}

inline bool lies_on_any(const World& world, const Point& p) {
  return std::any_of(world.begin(), world.end(),
                     [&](const Placed& placed) { return lies_on(p, placed.corners); });
}

/// `near` are the candidates of the ray's line in `world`.
inline Crossings crossings_of(const World& world, const World& near, const Question& ray) {
  Crossings result;
  for (const Placed& placed : near) {
    if (!ray.sees(placed.ref)) continue;
    const int passed = passage(ray, placed.corners);
    if (!ray.sees(passed > 0 ? Facing::Back : Facing::Front)) continue;
    result.count += passed != 0;
    result.signed_count += passed;
  }
  result.origin_on_surface = std::any_of(world.begin(), world.end(), [&](const Placed& placed) {
    return ray.sees(placed.ref) && lies_on(ray.origin, placed.corners);
  });
  return result;
}

}  // namespace pierce::campaign
