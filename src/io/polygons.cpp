// SPDX-License-Identifier: Apache-2.0
//
// Triangles whose signed areas add up to the polygon's cover each point as often as its border
// winds around it, so triangles that all have the polygon's sign (or no area) cover the inside once
// and nothing else. That is what makes a fan right, and what ears are cut for.
#include "io/polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "exact/scaled_integers.h"
#include "io/ear_cutter.h"
#include "predicate/axis_passage.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

using Points = std::span<const Vec3<double>>;
using Axis = std::uint8_t;

bool is_finite_point(const Vec3<double>& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// Nearest to the normal, as well as doubles can tell.
Axis axis_of(Points p) {
  Vec3<double> normal{};
  for (std::size_t i = 2; i < p.size(); ++i) {
    const Vec3<double> e = {p[i - 1].x - p[0].x, p[i - 1].y - p[0].y, p[i - 1].z - p[0].z};
    const Vec3<double> f = {p[i].x - p[0].x, p[i].y - p[0].y, p[i].z - p[0].z};
    normal.x += e.y * f.z - e.z * f.y;
    normal.y += e.z * f.x - e.x * f.z;
    normal.z += e.x * f.y - e.y * f.x;
  }
  const std::array<double, 3> size = {std::fabs(normal.x), std::fabs(normal.y),
                                      std::fabs(normal.z)};
  return static_cast<Axis>(std::max_element(size.begin(), size.end()) - size.begin());
}

// The sign of the area of the polygon's shadow, exactly.
int area_sign(Points points, Axis axis) {
  exact::BitSpan bits;
  for (const Vec3<double>& p : points) {
    bits.include(p.x);
    bits.include(p.y);
    bits.include(p.z);
  }
  if (bits.empty()) return 0;
  const auto along = [&](const Vec3<double>& p, Axis k) {
    const double x = k % 3 == 0 ? p.x : k % 3 == 1 ? p.y : p.z;
    return exact::scaled_integer<exact::BigInt>(x, bits.low);
  };
  const auto i = static_cast<Axis>(axis + 1), j = static_cast<Axis>(axis + 2);
  exact::BigInt area = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3<double>&p = points[k], &q = points[(k + 1) % points.size()];
    area += along(p, i) * along(q, j) - along(p, j) * along(q, i);
  }
  return exact::sign_of(area);
}

// Whether all triangles of the fan have one sign, or none; 0 if none has an area.
bool fan_is_right(Points p, Axis axis, bool& any_area) {
  int sign = 0;
  for (std::size_t i = 2; i < p.size(); ++i) {
    const int here = turn(p[0], p[i - 1], p[i], axis);
    if (here == 0) continue;
    if (sign != 0 && here != sign) return false;
    sign = here;
  }
  any_area = sign != 0;
  return true;
}

bool is_flat(Points p) {
  predicate::LadderCounts unused;
  // Against the plane of the first triangle that has one.
  std::size_t third = 2;
  const auto spans_plane = [&](std::size_t k) {
    for (const Axis axis : {Axis{0}, Axis{1}, Axis{2}}) {
      if (turn(p[0], p[k - 1], p[k], axis) != 0) return true;
    }
    return false;
  };
  while (third < p.size() && !spans_plane(third)) ++third;
  if (third == p.size()) return true;
  const predicate::TriangleD plane = {p[0], p[third - 1], p[third]};
  return std::all_of(p.begin(), p.end(), [&](const Vec3<double>& q) {
    return predicate::decide_side_of_plane(q, plane, unused) == 0;
  });
}

}  // namespace

void Polygons::append(std::span<const std::uint32_t> corners, std::vector<Triangle>& triangles) {
  if (corners.size() > 3) {
    fans_.push_back({triangles.size(), static_cast<std::uint32_t>(corners.size() - 2)});
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

void Polygons::finish(Mesh& mesh) const {
  std::vector<std::uint32_t> corners;
  std::vector<Vec3<double>> points;
  EarCutter cutter;
  EarCutter::Ears ears;
  std::uint64_t crossing = 0;
  for (const Fan& fan : fans_) {
    const auto triangles = std::span(mesh.triangles).subspan(fan.first, fan.triangles);
    corners.assign({triangles[0][0], triangles[0][1]});
    for (const Triangle& t : triangles) corners.push_back(t[2]);
    points.clear();
    for (const std::uint32_t corner : corners) points.push_back(mesh.vertices[corner]);
    ++mesh.polygons.all;
    if (!std::all_of(points.begin(), points.end(), is_finite_point)) continue;
    if (!is_flat(points)) ++mesh.polygons.not_flat;
    Axis axis = axis_of(points);
    bool any_area = false;
    if (fan_is_right(points, axis, any_area) && any_area) continue;
    int sign = area_sign(points, axis);
    for (Axis k = 0; sign == 0 && k < 3; ++k) {
      axis = k;
      sign = area_sign(points, axis);
    }
    if (sign == 0) {  // no shape at all, or as much one way as the other
      const bool right = fan_is_right(points, 0, any_area) && fan_is_right(points, 1, any_area) &&
                         fan_is_right(points, 2, any_area);
      crossing += right ? 0 : 1;
      continue;
    }
    if (fan_is_right(points, axis, any_area)) continue;
    ears.clear();
    if (!cutter.cut(points, axis, sign, ears)) {
      ++crossing;
      continue;
    }
    ++mesh.polygons.refanned;
    for (std::size_t i = 0; i < ears.size(); ++i) {
      triangles[i] = {corners[ears[i][0]], corners[ears[i][1]], corners[ears[i][2]]};
    }
  }
  if (crossing > 0) {
    mesh.warnings.push_back(
        fmt::format("{} with a border that crosses itself: fanned from the "
                    "first corner",
                    counted(crossing, "polygon", "polygons")));
  }
}

}  // namespace pierce::io
