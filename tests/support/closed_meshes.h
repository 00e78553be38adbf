// SPDX-License-Identifier: Apache-2.0
//
// The closed meshes that the property tests go through, the Stanford bunny among them, and points
// that are surely inside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/read_mesh.h"
#include "support/brute_force.h"
#include "support/meshes.h"

namespace pierce::hard {

template <class Real>
struct NamedMesh {
  std::string name;
  Mesh<Real> mesh;
};

/// The bunny of Debian's package glmark2-data, 69,666 triangles, closed.
template <class Real>
Mesh<Real> bunny() {
  const auto file = io::read_mesh("/usr/share/glmark2/models/bunny.obj");
  return converted<Real>(Mesh<double>{file.vertices, file.triangles});
}

/// Small enough for the brute-force oracle on hundreds of rays. Rounding to float keeps a mesh
/// closed, since triangles share their vertices.
template <class Real>
std::vector<NamedMesh<Real>> small_closed_meshes() {
  Rng rng(5, 5);
  return {{"icosphere", icosphere<Real>(3)},
          {"lattice cube", lattice_cube<Real>(4)},
          {"voxels", random_voxels<Real>(rng, 5)},
          {"torus", torus<Real>(24, 12)}};
}

/// Every vertex and every edge's midpoint (computed in double, rounded to the type).
template <class Real>
std::vector<Vec3<Real>> vertices_and_midpoints(const Mesh<Real>& mesh) {
  std::vector<Vec3<Real>> points = mesh.vertices;
  std::set<std::pair<std::uint32_t, std::uint32_t>> seen;
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto edge = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      if (!seen.insert({edge.first, edge.second}).second) continue;
      const auto& p = mesh.vertices[edge.first];
      const auto& q = mesh.vertices[edge.second];
      const auto middle = [](Real x, Real y) {
        return static_cast<Real>((static_cast<double>(x) + static_cast<double>(y)) / 2);
      };
      points.push_back({middle(p.x, q.x), middle(p.y, q.y), middle(p.z, q.z)});
    }
  }
  return points;
}

/// Points that the oracle says are inside: between the first two hits of rays aimed at faces.
template <class Real>
std::vector<Vec3<Real>> points_inside(Rng& rng, const Mesh<Real>& mesh, std::size_t count) {
  const oracle::BruteForce<Real> truth(mesh.view());
  std::vector<Vec3<Real>> inside;
  while (inside.size() < count) {
    const Triangle& triangle = mesh.triangles[rng.below(mesh.triangles.size())];
    const auto& a = mesh.vertices[triangle[0]];
    const auto& b = mesh.vertices[triangle[1]];
    const auto& c = mesh.vertices[triangle[2]];
    const Vec3<Real> p{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, (a.z + b.z + c.z) / 3};
    const auto d = vec<Real>(rng, Style::Unit);
    const Ray<Real> ray{{p.x - 16 * d.x, p.y - 16 * d.y, p.z - 16 * d.z}, d};
    const auto hits = truth.all_hits(ray);
    if (hits.size() < 2) continue;
    const Real t = (hits[0].t + hits[1].t) / 2;
    const Vec3<Real> middle{ray.origin.x + t * d.x, ray.origin.y + t * d.y, ray.origin.z + t * d.z};
    if (truth.locate(middle) == Location::Inside) inside.push_back(middle);
  }
  return inside;
}

}  // namespace pierce::hard
