// SPDX-License-Identifier: Apache-2.0
//
// Shapes at their own size and place: what unruly meshes are made of before they are moved, split
// and spoilt.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/meshes.h"

namespace pierce::hard {

template <class Real>
void add_loose(Mesh<Real>& mesh, const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Triangles between random ones of the vertices that are there.
template <class Real>
void connect_at_random(Rng& rng, Mesh<Real>& mesh, int count) {
  for (int i = 0; i < count; ++i) {
    Triangle t;
    for (auto& corner : t) corner = static_cast<std::uint32_t>(rng.below(mesh.vertices.size()));
    mesh.triangles.push_back(t);
  }
}

template <class Real>
Mesh<Real> soup(Rng& rng, int count, double reach) {
  Mesh<Real> mesh;
  for (int i = 0; i < count; ++i) {
    const auto a = in_cube<Real>(rng, 1);
    const auto near = [&] {
      const auto d = in_cube<Real>(rng, reach);
      return Vec3<Real>{a.x + d.x, a.y + d.y, a.z + d.z};
    };
    const auto b = near(), c = near();
    add_loose(mesh, a, b, c);
  }
  return mesh;
}

/// Vertices with small integer coordinates: nearly everything coincides with something.
template <class Real>
Mesh<Real> lattice(Rng& rng, int count, std::array<int, 3> size) {
  Mesh<Real> mesh;
  for (int i = 0; i < std::max(4, count / 2); ++i) {
    const int x = rng.between(0, size[0]), y = rng.between(0, size[1]), z = rng.between(0, size[2]);
    mesh.vertices.push_back({Real(x), Real(y), Real(z)});
  }
  connect_at_random(rng, mesh, count);
  return mesh;
}

/// A sheet of n x m quads over x and y, its heights from a function.
template <class Real, class Height>
Mesh<Real> sheet(int n, int m, Height&& height) {
  Mesh<Real> mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) mesh.vertices.push_back({Real(i), Real(j), Real(height(i, j))});
  }
  const auto at = [m](int i, int j) { return static_cast<std::uint32_t>(i * (m + 1) + j); };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

template <class Real>
void add_box(Mesh<Real>& mesh, const Vec3<Real>& low, const Vec3<Real>& high) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kQuads{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& q : kQuads) {
    mesh.triangles.push_back({first + q[0], first + q[1], first + q[2]});
    mesh.triangles.push_back({first + q[0], first + q[2], first + q[3]});
  }
}

/// Integer boxes that touch, overlap and coincide.
template <class Real>
Mesh<Real> boxes(Rng& rng, int count, int size) {
  Mesh<Real> mesh;
  for (int i = 0; i < count; ++i) {
    const auto corner = [&] {
      return Vec3<Real>{Real(rng.between(0, size)), Real(rng.between(0, size)),
                        Real(rng.between(0, size))};
    };
    const auto low = corner();
    const auto extent = corner();
    add_box(mesh, low, {low.x + extent.x, low.y + extent.y, low.z + extent.z});
  }
  return mesh;
}

/// T-junctions: triangles cut at the middle of an edge, which their neighbours keep whole, again
/// and again, where the middle is a number of the type.
template <class Real>
void split_on_one_side(Rng& rng, Mesh<Real>& mesh, int splits) {
  for (int i = 0; i < splits && !mesh.triangles.empty(); ++i) {
    const std::size_t number = rng.below(mesh.triangles.size());
    const std::size_t k = rng.below(3);
    const Triangle t = mesh.triangles[number];
    const std::uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
    const Vec3<Real>&p = mesh.vertices[a], &q = mesh.vertices[b];
    if (p == q) continue;
    const Vec3<Real> m = {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
    if (m.x - p.x != q.x - m.x || m.y - p.y != q.y - m.y || m.z - p.z != q.z - m.z) continue;
    const std::uint32_t middle = mesh.add(m);
    mesh.triangles[number] = {a, middle, c};
    mesh.triangles.push_back({middle, b, c});
  }
}

/// A tetrahedron whose faces are split again and again: closed, its vertices shared.
template <class Real>
Mesh<Real> split_tetrahedron(Rng& rng, int splits, double jitter) {
  Mesh<Real> mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  for (int i = 0; i < splits; ++i) {
    auto& t = mesh.triangles[rng.below(mesh.triangles.size())];
    const std::uint32_t a = t[0], b = t[1], c = t[2];
    const auto mean = [&](Real Vec3<Real>::*axis) {
      return (mesh.vertices[a].*axis + mesh.vertices[b].*axis + 2 * mesh.vertices[c].*axis) / 4 +
             Real(rng.within(jitter));
    };
    const Vec3<Real> middle{mean(&Vec3<Real>::x), mean(&Vec3<Real>::y), mean(&Vec3<Real>::z)};
    const auto m = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(middle);
    t = {a, b, m};
    mesh.triangles.push_back({b, c, m});
    mesh.triangles.push_back({c, a, m});
  }
  return mesh;
}

/// Triangles around one hub; the rim is random, or nearly in a plane.
template <class Real>
Mesh<Real> fan(Rng& rng, int count, double height) {
  Mesh<Real> mesh;
  mesh.vertices.push_back(in_cube<Real>(rng, 0.1));
  for (int i = 0; i < count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    mesh.vertices.push_back(finite<Real>(std::cos(a), std::sin(a), rng.within(height)));
  }
  const auto n = static_cast<std::uint32_t>(count);
  for (std::uint32_t i = 0; i < n; ++i) mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % n});
  return mesh;
}

/// Triangles as long as the box and thinner than anything.
template <class Real>
Mesh<Real> needles(Rng& rng, int count, int places) {
  Mesh<Real> mesh;
  for (int i = 0; i < count; ++i) {
    auto a = in_cube<Real>(rng, 1), b = in_cube<Real>(rng, 1);
    if (rng.one_in(2)) a.x = -1, b.x = 1;
    if (rng.one_in(4)) a.y = -1, b.y = 1, a.z = -1, b.z = 1;
    add_loose(mesh, a, b, nudged(rng, rng.one_in(2) ? a : b, places));
  }
  return mesh;
}

}  // namespace pierce::hard
