// SPDX-License-Identifier: Apache-2.0
//
// What next_origin promises, decided by its words: the segment from the start to the ray's point at
// t - e (before the hit) or t + e (beyond it) meets no triangle that has area, for every e that is
// small enough. Signs of numbers c0 + c1 e for e -> 0 decide.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "campaign/hit_oracle.h"

namespace pierce::campaign {

/// c0 + c1 e, where e is positive and smaller than everything.
struct Near {
  Ratio c0, c1;
  [[nodiscard]] int sign() const { return c0 != 0 ? sgn(c0) : sgn(c1); }
};

struct RatioVec {
  Ratio x, y, z;
  explicit RatioVec(const Point& p) : x(p.x), y(p.y), z(p.z) {}
  RatioVec(Ratio px, Ratio py, Ratio pz) : x(std::move(px)), y(std::move(py)), z(std::move(pz)) {}
};

inline RatioVec operator-(const RatioVec& p, const RatioVec& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
inline Ratio dot(const RatioVec& p, const RatioVec& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }
inline RatioVec cross(const RatioVec& p, const RatioVec& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

/// The segment from s to h + e d, or rather what there is of it for every small e.
struct Segment {
  RatioVec s, h, d;

  /// The side of n . (x - s) on which the end lies, times something positive.
  [[nodiscard]] Near end_against(const RatioVec& n, const RatioVec& from) const {
    return {dot(n, h - from), dot(n, d)};
  }
  /// (end - s) x (p - s) . (q - s): the side on which the line of the segment passes p, q.
  [[nodiscard]] Near side(const RatioVec& p, const RatioVec& q) const {
    const RatioVec n = cross(p - s, q - s);
    return end_against(n, s);
  }
};

/// Whether all of three signs are strictly on one side.
inline bool same_strict_side(int p, int q, int r) { return p != 0 && p == q && p == r; }

/// In the triangle's plane: some edge of the triangle, or the segment itself, has the other figure
/// strictly on one side.
inline bool separated_in_plane(const Segment& segment, const std::array<RatioVec, 3>& corners,
                               const RatioVec& normal) {
  for (int i = 0; i < 3; ++i) {
    const RatioVec& from = corners[i];
    const RatioVec inward = cross(normal, corners[(i + 1) % 3] - from);
    const bool start_out = dot(inward, segment.s - from) < 0;
    if (start_out && segment.end_against(inward, from).sign() < 0) return true;
  }
  std::array<int, 3> sides;
  for (int i = 0; i < 3; ++i) {
    const RatioVec n = cross(corners[i] - segment.s, normal);
    sides[i] = segment.end_against(n, segment.s).sign();
  }
  return same_strict_side(sides[0], sides[1], sides[2]);
}

inline bool segment_meets(const Segment& segment, const Corners& triangle) {
  const std::array<RatioVec, 3> corners{RatioVec(triangle.a), RatioVec(triangle.b),
                                        RatioVec(triangle.c)};
  const auto& [a, b, c] = corners;
  const RatioVec normal = cross(b - a, c - a);
  if (normal.x == 0 && normal.y == 0 && normal.z == 0) return false;
  const int start = sgn(dot(normal, segment.s - a));
  const int end = segment.end_against(normal, a).sign();
  if (start == 0 && end == 0) return !separated_in_plane(segment, corners, normal);
  if (start == end) return false;
  const int ab = segment.side(a, b).sign();
  const int bc = segment.side(b, c).sign();
  const int ca = segment.side(c, a).sign();
  const bool negative = ab < 0 || bc < 0 || ca<0, positive = ab> 0 || bc > 0 || ca > 0;
  return !(negative && positive);
}

/// Whether the boxes of the segment and the triangle are apart; h is known to within h_low, h_high.
inline bool boxes_apart(const Point& s, const Point& h_low, const Point& h_high,
                        const Corners& corners) {
  const auto apart = [&](double sx, double low, double high, double a, double b, double c) {
    return std::max(sx, high) < std::min({a, b, c}) || std::min(sx, low) > std::max({a, b, c});
  };
  const auto& [a, b, c] = corners;
  return apart(s.x, h_low.x, h_high.x, a.x, b.x, c.x) ||
         apart(s.y, h_low.y, h_high.y, a.y, b.y, c.y) ||
         apart(s.z, h_low.z, h_high.z, a.z, b.z, c.z);
}

/// What is wrong with a start; empty if nothing is.
inline std::string fault_of_start(const World& world, const Question& ray, const ExactHit& hit,
                                  Side side, const Point& start) {
  const RatioVec o(ray.origin), d(ray.direction);
  const RatioVec h{o.x + hit.t * d.x, o.y + hit.t * d.y, o.z + hit.t * d.z};
  const int way = side == Side::Before ? -1 : 1;
  const Segment segment{RatioVec(start), h, RatioVec(way * d.x, way * d.y, way * d.z)};
  const double down = -kInfinity<double>, up = kInfinity<double>;
  const auto to = [](const Ratio& x, double end) {
    return std::nextafter(rounded<double>(x), end);
  };
  const Point low{to(h.x, down), to(h.y, down), to(h.z, down)};
  const Point high{to(h.x, up), to(h.y, up), to(h.z, up)};
  if (lies_on_any(world, start)) return "the start lies on a triangle";
  for (const auto& [corners, ref] : world) {
    if (!boxes_apart(start, low, high, corners) && segment_meets(segment, corners)) {
      return "triangle " + std::to_string(ref.triangle) + " of geometry " +
             std::to_string(ref.geometry) + " is in the way";
    }
    const bool inner_hit = hit.u > 0 && hit.v > 0 && hit.w > 0;
    if (inner_hit && ref == hit.ref) {
      const RatioVec a(corners.a);
      const RatioVec normal = cross(RatioVec(corners.b) - a, RatioVec(corners.c) - a);
      if (sgn(dot(normal, segment.s - a)) != sgn(dot(normal, segment.d))) {
        return "the start is not strictly on its side of the plane";
      }
    }
  }
  return "";
}

/// Whether the promise has it that there is a start: if the ray's own origin will do.
inline bool must_have_start(const World& world, const Question& ray, const ExactHit& hit,
                            Side side) {
  return side == Side::Before && hit.t > 0 &&
         fault_of_start(world, ray, hit, side, ray.origin).empty();
}

}  // namespace pierce::campaign
