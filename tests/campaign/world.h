// SPDX-License-Identifier: Apache-2.0
//
// What the campaign asks about: meshes as doubles, and the triangles that a line may meet. The one
// thing here that is not exact is certainly_missed, which says nothing when it is not sure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "campaign/exact.h"
#include "support/meshes.h"

namespace pierce::campaign {

using hard::Mesh;

struct Corners {
  Point a, b, c;
};

struct Placed {
  Corners corners;
  TriangleRef ref;
};

/// All triangles of all geometries, in the order of (geometry, triangle).
using World = std::vector<Placed>;

template <class Real>
Point as_point(const Vec3<Real>& p) {
  return {double{p.x}, double{p.y}, double{p.z}};
}

template <class Real>
World world_of(std::span<const Mesh<Real>> meshes) {
  World world;
  for (std::uint32_t g = 0; g < meshes.size(); ++g) {
    const auto& mesh = meshes[g];
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[i];
      world.push_back({{as_point(mesh.vertices[t[0]]), as_point(mesh.vertices[t[1]]),
                        as_point(mesh.vertices[t[2]])},
                       {g, i}});
    }
  }
  return world;
}

/// Long double has a range that no product of three doubles leaves, and differences that are right
/// to 2^-64. A side of the line is d . (P x Q), three times two products of three factors, each
/// wrong by at most 8 roundings: it is certain if it is larger than 2^-60 of their sum.
using Wide = long double;

struct WideVec {
  Wide x, y, z;
  WideVec(const Point& p, const Point& o)
      : x(Wide(p.x) - Wide(o.x)), y(Wide(p.y) - Wide(o.y)), z(Wide(p.z) - Wide(o.z)) {}
};

inline int certain_side(const Point& d, const WideVec& p, const WideVec& q) {
  const Wide yz = p.y * q.z, zy = p.z * q.y, zx = p.z * q.x;
  const Wide xz = p.x * q.z, xy = p.x * q.y, yx = p.y * q.x;
  const Wide value = d.x * (yz - zy) + d.y * (zx - xz) + d.z * (xy - yx);
  const Wide sum = std::fabs(d.x) * (std::fabs(yz) + std::fabs(zy)) +
                   std::fabs(d.y) * (std::fabs(zx) + std::fabs(xz)) +
                   std::fabs(d.z) * (std::fabs(xy) + std::fabs(yx));
  const Wide bound = sum * 0x1p-60L;
  return value > bound ? 1 : value < -bound ? -1 : 0;
}

/// Whether the line o + t d, whatever the sign of t, has two edges on different sides for sure.
inline bool certainly_missed(const Point& o, const Point& d, const Corners& corners) {
  const WideVec a(corners.a, o), b(corners.b, o), c(corners.c, o);
  const int ab = certain_side(d, a, b);
  const int bc = certain_side(d, b, c);
  if (ab * bc < 0) return true;
  const int ca = certain_side(d, c, a);
  return ab * ca < 0 || bc * ca < 0;
}

/// The triangles that the line may meet.
inline World candidates(const World& world, const Point& o, const Point& d) {
  World near;
  for (const Placed& placed : world) {
    if (!certainly_missed(o, d, placed.corners)) near.push_back(placed);
  }
  return near;
}

}  // namespace pierce::campaign
