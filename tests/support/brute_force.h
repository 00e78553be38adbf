// SPDX-License-Identifier: Apache-2.0
//
// Every query of Scene answered by looking at every triangle with the quick oracle. To make meshes
// of some 10^5 triangles bearable, triangles that lie strictly on one side of a plane through the
// line are left out; that is decided per vertex and coordinate direction with a bound that holds
// for all numbers (see `SideMask`), so nothing that could be hit is ever left out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "pierce/options.h"
#include "pierce/types.h"
#include "support/quick_oracle.h"

namespace pierce::oracle {

/// On which side of the three planes through the line, each parallel to a coordinate axis, a point
/// strictly lies: bit 2i for the positive, bit 2i + 1 for the negative side of plane i.
///
/// With d1 (p2 - o2) = A and d2 (p1 - o1) = B, the computed A' has |A' - A| <= 2^-51 |A'| + 2^-1073
/// (two roundings of at most 2^-53 relative each, and one underflow of the product), B' likewise,
/// and the subtraction adds 2^-53 of |A'| + |B'|. So |x'| > 2^-50 (|A'| + |B'|) + 2^-1000 proves
/// the sign. Overflow gives inf or NaN on the right and the comparison is false: no claim.
using SideMask = std::uint8_t;

inline SideMask side_mask(const Vec3<double>& o, const Vec3<double>& d, const Vec3<double>& p) {
  const double rx = p.x - o.x, ry = p.y - o.y, rz = p.z - o.z;
  const auto side = [](double a, double b) {
    const double x = a - b;
    const double error = 0x1p-50 * (std::fabs(a) + std::fabs(b)) + 0x1p-1000;
    return static_cast<SideMask>((x > error ? 1 : 0) | (-x > error ? 2 : 0));
  };
  return static_cast<SideMask>(side(d.y * rz, d.z * ry) | side(d.z * rx, d.x * rz) << 2 |
                               side(d.x * ry, d.y * rx) << 4);
}

template <class Real>
class BruteForce {
 public:
  explicit BruteForce(MeshView<Real> mesh) : meshes_{mesh} {}
  explicit BruteForce(std::span<const MeshView<Real>> meshes)
      : meshes_(meshes.begin(), meshes.end()) {}

  std::vector<Hit<Real>> all_hits(const Ray<Real>& ray, Range range = Range::Closed,
                                  TriangleRef skip = {}) const {
    struct Found {
      QuickHit exact;
      TriangleRef of;
    };
    std::vector<Found> found;
    for_each_near(ray, [&](TriangleRef of, const LineAndTriangle& pair) {
      if (of == skip) return;
      if (auto hit = pair.hit(ray, range)) found.push_back({*std::move(hit), of});
    });
    std::sort(found.begin(), found.end(), [](const Found& x, const Found& y) {
      if (const int order = compare_t(x.exact, y.exact); order != 0) return order < 0;
      return std::tie(x.of.geometry, x.of.triangle) < std::tie(y.of.geometry, y.of.triangle);
    });
    std::vector<Hit<Real>> hits;
    hits.reserve(found.size());
    for (const Found& f : found) {
      hits.push_back(rounded<Real>(f.exact, f.of.geometry, f.of.triangle));
    }
    return hits;
  }

  /// A miss is a default Hit.
  Hit<Real> closest_hit(const Ray<Real>& ray, Range range = Range::Closed,
                        TriangleRef skip = {}) const {
    const auto hits = all_hits(ray, range, skip);
    return hits.empty() ? Hit<Real>{} : hits.front();
  }

  bool any_hit(const Ray<Real>& ray, Range range = Range::Closed, TriangleRef skip = {}) const {
    return !all_hits(ray, range, skip).empty();
  }

  Crossings crossings(const Ray<Real>& ray) const {
    return crossings(ray, Sides::Both, [](TriangleRef) { return true; });
  }

  /// Of the triangles that are seen, and in the directions that `sides` says.
  template <class Sees>
  Crossings crossings(const Ray<Real>& ray, Sides sides, Sees sees) const {
    Crossings result;
    for_each_near(ray, [&](TriangleRef of, const LineAndTriangle& pair) {
      const int passage = sees(of) ? pair.passage(ray) : 0;
      if (passage == 0 || (passage < 0 ? sides == Sides::Back : sides == Sides::Front)) return;
      ++result.count;
      result.signed_count += passage;
    });
    result.origin_on_surface = on_surface(ray.origin, sees);
    return result;
  }

  bool on_surface(const Vec3<Real>& p) const {
    return on_surface(p, [](TriangleRef) { return true; });
  }

  template <class Sees>
  bool on_surface(const Vec3<Real>& p, Sees sees) const {
    const auto apart = [](Real x, Real i, Real j, Real k) {
      return (x < i && x < j && x < k) || (x > i && x > j && x > k);
    };
    for (std::uint32_t g = 0; g < meshes_.size(); ++g) {
      for (std::uint32_t i = 0; i < meshes_[g].triangles.size(); ++i) {
        const auto& [a, b, c] = corners(meshes_[g], meshes_[g].triangles[i]);
        if (!sees(TriangleRef{g, i})) continue;
        if (apart(p.x, a.x, b.x, c.x) || apart(p.y, a.y, b.y, c.y) || apart(p.z, a.z, b.z, c.z)) {
          continue;
        }
        if (on_triangle(p, a, b, c)) return true;
      }
    }
    return false;
  }

  /// For closed meshes. The direction is any that is not special to the data; by the definition of
  /// crossings every direction gives the same answer.
  Location locate(const Vec3<Real>& p) const {
    if (on_surface(p)) return Location::OnSurface;
    const Ray<Real> ray{p, {Real(0.4375), Real(-0.28125), Real(0.8125)}};
    return crossings(ray).count % 2 == 1 ? Location::Inside : Location::Outside;
  }

 private:
  static std::array<Vec3<Real>, 3> corners(const MeshView<Real>& mesh, const Triangle& triangle) {
    return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
  }

  template <class Visit>
  void for_each_near(const Ray<Real>& ray, Visit visit) const {
    const auto wide = [](const Vec3<Real>& v) {
      return Vec3<double>{static_cast<double>(v.x), static_cast<double>(v.y),
                          static_cast<double>(v.z)};
    };
    const Vec3<double> o = wide(ray.origin), d = wide(ray.direction);
    std::vector<SideMask> mask;
    for (std::uint32_t g = 0; g < meshes_.size(); ++g) {
      const MeshView<Real>& mesh = meshes_[g];
      mask.resize(mesh.vertices.size());
      std::transform(mesh.vertices.begin(), mesh.vertices.end(), mask.begin(),
                     [&](const Vec3<Real>& p) { return side_mask(o, d, wide(p)); });
      for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& triangle = mesh.triangles[i];
        if ((mask[triangle[0]] & mask[triangle[1]] & mask[triangle[2]]) != 0) continue;
        const auto& [a, b, c] = corners(mesh, triangle);
        visit(TriangleRef{g, i}, LineAndTriangle(ray, a, b, c));
      }
    }
  }

  std::vector<MeshView<Real>> meshes_;
};

}  // namespace pierce::oracle
