// SPDX-License-Identifier: Apache-2.0
//
// Convex things without a common point are parted by a plane square to one of these: the normal of
// a face, the cross product of an edge of each, or, where all is in one plane or one line, the
// cross product of an edge and a coordinate axis, or such an axis (docs/algorithm.md, "Questions of
// a mesh").
#include "predicate/touch.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "predicate/axis_passage.h"
#include "predicate/exact_pair.h"
#include "predicate/passage.h"

namespace pierce::predicate {
namespace {

// Of some points the least and the greatest value, against those of others.
template <class Points, class Value>
bool parted(const Points& p, const Points& q, const Value& value) {
  const auto all_below = [&](const Points& below, const Points& above) {
    for (const auto& low : below) {
      for (const auto& high : above) {
        if (sign_of(value(high) - value(low)) <= 0) return false;
      }
    }
    return true;
  };
  return all_below(p, q) || all_below(q, p);
}

template <class Integer>
using Points = std::span<const Triple<Integer>>;

template <class Integer, class Axis>
bool parted_along(Points<Integer> p, Points<Integer> q, const Triple<Axis>& axis) {
  return parted(p, q, [&](const Triple<Integer>& point) { return dot(axis, point); });
}

// Square to an edge and to a coordinate axis, for each of the three; and along each.
template <class Integer>
bool parted_in_shadow(Points<Integer> p, Points<Integer> q, const Triple<Integer>& edge) {
  using T = Triple<Integer>;
  return parted(p, q, [&](const T& v) { return v.x * edge.y - v.y * edge.x; }) ||
         parted(p, q, [&](const T& v) { return v.y * edge.z - v.z * edge.y; }) ||
         parted(p, q, [&](const T& v) { return v.z * edge.x - v.x * edge.z; });
}
template <class Integer>
bool parted_along_axes(Points<Integer> p, Points<Integer> q) {
  using T = Triple<Integer>;
  return parted(p, q, [](const T& v) { return v.x; }) ||
         parted(p, q, [](const T& v) { return v.y; }) ||
         parted(p, q, [](const T& v) { return v.z; });
}

template <class Integer>
std::array<Triple<Integer>, 3> edges_of(Points<Integer> t) {
  return {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
}

// `use.operator()<Integer>(t, others)` with all as integers, less the triangle's first corner.
template <std::size_t N, class Use>
void as_integers(const TriangleD& triangle, const std::array<Vec3<double>, N>& others,
                 LadderCounts& counts, const Use& use) {
  const TriangleD ends{others.front(), others.back(), others.front()};
  const auto convert = [&]<class Integer>(const Places& places) {
    const int place = places.points.empty() ? 0 : places.points.low;
    const auto from = scaled_triple<Integer>(triangle.a, place);
    const std::array<Triple<Integer>, 3> t{from - from,
                                           scaled_triple<Integer>(triangle.b, place) - from,
                                           scaled_triple<Integer>(triangle.c, place) - from};
    std::array<Triple<Integer>, N> points{};
    for (std::size_t i = 0; i < N; ++i) {
      points[i] = scaled_triple<Integer>(others[i], place) - from;
    }
    use(Points<Integer>(t), Points<Integer>(points));
  };
  const Width width = with_places(RayD{triangle.a, {1, 0, 0}}, convert, triangle, ends);
  ++(width == Width::Any ? counts.settled_big : counts.settled);
}

bool settle_segment_touches(const Vec3<double>& from, const Vec3<double>& to,
                            const TriangleD& triangle, LadderCounts& counts) {
  bool apart = false;
  const auto look = [&]<class Integer>(Points<Integer> t, Points<Integer> s) {
    const auto edges = edges_of(t);
    const Triple<Integer> along = s[1] - s[0];
    apart = parted_along_axes(t, s) || parted_along(t, s, cross(edges[0], edges[1])) ||
            parted_in_shadow(t, s, along);
    for (const auto& edge : edges) {
      apart = apart || parted_along(t, s, cross(edge, along)) || parted_in_shadow(t, s, edge);
    }
  };
  as_integers(triangle, std::array{from, to}, counts, look);
  return !apart;
}

// Signs of what a line has on either side.
bool same_side(int a, int b, int c) {
  return !((a > 0 || b > 0 || c > 0) && (a < 0 || b < 0 || c < 0));
}

struct Box {
  Vec3<double> lower, upper;
};
Box box_of(const TriangleD& t) {
  return {{std::min({t.a.x, t.b.x, t.c.x}), std::min({t.a.y, t.b.y, t.c.y}),
           std::min({t.a.z, t.b.z, t.c.z})},
          {std::max({t.a.x, t.b.x, t.c.x}), std::max({t.a.y, t.b.y, t.c.y}),
           std::max({t.a.z, t.b.z, t.c.z})}};
}
bool meet(const Box& p, const Box& q) {
  return p.lower.x <= q.upper.x && q.lower.x <= p.upper.x && p.lower.y <= q.upper.y &&
         q.lower.y <= p.upper.y && p.lower.z <= q.upper.z && q.lower.z <= p.upper.z;
}

using Corners = std::array<Vec3<double>, 3>;

bool any_edge_touches(const Corners& p, const TriangleD& q, LadderCounts& counts) {
  return decide_segment_touches(p[0], p[1], q, counts) ||
         decide_segment_touches(p[1], p[2], q, counts) ||
         decide_segment_touches(p[2], p[0], q, counts);
}

// Whether q's last corner is, seen across the edge that both have, in the plane and on the side of
// p's.
bool folded(const Corners& p, const Corners& q, LadderCounts& counts) {
  const TriangleD triangle{p[0], p[1], p[2]};
  if (decide_side_of_plane(q[2], triangle, counts) != 0) return false;
  bool same = false;
  const auto look = [&]<class Integer>(Points<Integer> t, Points<Integer> other) {
    same = sign_of(dot(cross(t[1], t[2]), cross(t[1], other[0]))) > 0;
  };
  as_integers(triangle, std::array{q[2]}, counts, look);
  return same;
}

}  // namespace

bool decide_segment_touches(const Vec3<double>& from, const Vec3<double>& to,
                            const TriangleD& triangle, LadderCounts& counts) {
  const int before = decide_side_of_plane(from, triangle, counts);
  const int after = decide_side_of_plane(to, triangle, counts);
  if (before * after > 0) return false;
  if (before == 0 && after == 0) return settle_segment_touches(from, to, triangle, counts);
  // The line passes through the plane; where, say the sides of the edges.
  const auto side = [&](const Vec3<double>& p, const Vec3<double>& q) {
    return decide_side_of_plane(from, {to, p, q}, counts);
  };
  return same_side(side(triangle.a, triangle.b), side(triangle.b, triangle.c),
                   side(triangle.c, triangle.a));
}

bool decide_box_touches(const Vec3<double>& lower, const Vec3<double>& upper,
                        const TriangleD& triangle, LadderCounts& counts) {
  const Box box{lower, upper};
  if (!meet(box, box_of(triangle))) return false;
  for (const Vec3<double>& p : {triangle.a, triangle.b, triangle.c}) {
    if (meet(box, {p, p})) return true;
  }
  std::array<Vec3<double>, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = {(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                  (i & 4U) != 0 ? upper.z : lower.z};
  }
  bool apart = false;
  const auto look = [&]<class Integer>(Points<Integer> t, Points<Integer> b) {
    const auto edges = edges_of(t);
    apart = parted_along(t, b, cross(edges[0], edges[1]));
    for (const auto& edge : edges) apart = apart || parted_in_shadow(t, b, edge);
  };
  as_integers(triangle, corners, counts, look);
  return !apart;
}

bool decide_overlap(const TriangleD& p, const TriangleD& q, LadderCounts& counts) {
  if (!meet(box_of(p), box_of(q))) return false;
  // Corners that both have come first.
  Corners one{p.a, p.b, p.c}, other{q.a, q.b, q.c};
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at =
        std::find(other.begin() + static_cast<std::ptrdiff_t>(shared), other.end(), one[i]);
    if (at == other.end()) continue;
    std::swap(other[shared], *at);
    std::swap(one[shared++], one[i]);
  }
  switch (shared) {
    case 0:
      return any_edge_touches(one, q, counts) || any_edge_touches(other, p, counts);
    case 1:  // whoever leaves the corner through both leaves one of them first
      return decide_segment_touches(one[1], one[2], q, counts) ||
             decide_segment_touches(other[1], other[2], p, counts);
    case 2:
      return folded(one, other, counts);
    default:
      return true;
  }
}

}  // namespace pierce::predicate
