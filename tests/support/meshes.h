// SPDX-License-Identifier: Apache-2.0
//
// Meshes for tests, made from nothing: closed ones (ball, torus, surface of a set of voxels) whose
// triangles all face outward, and unruly ones (soups, copies, needles).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "pierce/types.h"
#include "support/hard_numbers.h"
#include "support/rng.h"

namespace pierce::hard {

template <class Real>
struct Mesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;

  [[nodiscard]] MeshView<Real> view() const { return {vertices, triangles}; }

  std::uint32_t add(const Vec3<Real>& v) {
    vertices.push_back(v);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
};

/// The same mesh in another type, each number rounded.
template <class To, class From>
Mesh<To> converted(const Mesh<From>& mesh) {
  Mesh<To> result;
  result.triangles = mesh.triangles;
  for (const auto& v : mesh.vertices) {
    result.add({static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)});
  }
  return result;
}

/// A ball of 20 * 4^levels triangles around the origin, radius 1.
template <class Real>
Mesh<Real> icosphere(int levels) {
  Mesh<double> ball;
  const double g = std::numbers::phi;
  const auto add = [&](double x, double y, double z) {
    const double r = std::sqrt(x * x + y * y + z * z);
    return ball.add({x / r, y / r, z / r});
  };
  for (const double s : {-1.0, 1.0}) {
    for (const double q : {-g, g}) {
      add(0, s, q);
      add(s, q, 0);
      add(q, 0, s);
    }
  }
  // The faces of the icosahedron are the triples of corners at the least mutual distance; every
  // corner is as good as a normal, so outward is where the determinant is positive.
  const auto& v = ball.vertices;
  const auto close = [&](std::uint32_t i, std::uint32_t j) {
    return v[i].x * v[j].x + v[i].y * v[j].y + v[i].z * v[j].z > 0.4;
  };
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (!close(i, j) || !close(j, k) || !close(k, i)) continue;
        const double volume = v[i].x * (v[j].y * v[k].z - v[j].z * v[k].y) +
                              v[i].y * (v[j].z * v[k].x - v[j].x * v[k].z) +
                              v[i].z * (v[j].x * v[k].y - v[j].y * v[k].x);
        ball.triangles.push_back(volume > 0 ? Triangle{i, j, k} : Triangle{i, k, j});
      }
    }
  }
  for (; levels > 0; --levels) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(i, j), 0);
      const auto p = ball.vertices[i], q = ball.vertices[j];
      if (is_new) at->second = add(p.x + q.x, p.y + q.y, p.z + q.z);
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : ball.triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t :
           {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
        finer.push_back(t);
      }
    }
    ball.triangles = std::move(finer);
  }
  return converted<Real>(ball);
}

/// The closed surface of a set of unit voxels (integer coordinates), two triangles a face, split
/// along one diagonal or the other by the parity of the place.
template <class Real>
Mesh<Real> voxel_surface(const std::set<std::array<int, 3>>& voxels) {
  Mesh<Real> mesh;
  std::map<std::array<int, 3>, std::uint32_t> corners;
  const auto corner = [&](const std::array<int, 3>& at) {
    const auto [found, is_new] = corners.try_emplace(at, 0);
    if (is_new) {
      found->second =
          mesh.add({static_cast<Real>(at[0]), static_cast<Real>(at[1]), static_cast<Real>(at[2])});
    }
    return found->second;
  };
  for (const auto& voxel : voxels) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        auto neighbour = voxel;
        neighbour[axis] += step;
        if (voxels.count(neighbour) != 0) continue;
        std::array<std::uint32_t, 4> ring{};  // counter-clockwise seen from +axis
        for (std::size_t i = 0; i < 4; ++i) {
          auto at = voxel;
          at[axis] += step > 0 ? 1 : 0;
          at[(axis + 1) % 3] += i == 1 || i == 2 ? 1 : 0;
          at[(axis + 2) % 3] += i >= 2 ? 1 : 0;
          ring[i] = corner(at);
        }
        if (step < 0) std::swap(ring[1], ring[3]);
        const std::size_t first = (voxel[0] + voxel[1] + voxel[2]) % 2 == 0 ? 0 : 1;
        const auto at = [&](std::size_t i) { return ring[(first + i) % 4]; };
        mesh.triangles.push_back({at(0), at(1), at(2)});
        mesh.triangles.push_back({at(0), at(2), at(3)});
      }
    }
  }
  return mesh;
}

/// The surface of an n x n x n block of voxels: a cube with all lattice points as vertices.
template <class Real>
Mesh<Real> lattice_cube(int n) {
  std::set<std::array<int, 3>> voxels;
  for (int i = 0; i < n * n * n; ++i) voxels.insert({i / (n * n), i / n % n, i % n});
  return voxel_surface<Real>(voxels);
}

/// Voxels of an n-cube, each there with probability 1/2: touching corners and edges, holes.
template <class Real>
Mesh<Real> random_voxels(Rng& rng, int n) {
  std::set<std::array<int, 3>> voxels;
  for (int i = 0; i < n * n * n; ++i) {
    if (rng.coin()) voxels.insert({i / (n * n), i / n % n, i % n});
  }
  return voxel_surface<Real>(voxels);
}

/// Faces outward; with few quads around and across it is all corners.
template <class Real>
Mesh<Real> torus(std::uint32_t around, std::uint32_t across, double thickness = 0.35) {
  Mesh<Real> mesh;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
      const double r = 1 + thickness * std::cos(b);
      mesh.add(finite<Real>(r * std::cos(a), r * std::sin(a), thickness * std::sin(b)));
    }
  }
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const std::uint32_t k = (i + 1) % around, l = (j + 1) % across;
      const auto at = [&](std::uint32_t x, std::uint32_t y) { return x * across + y; };
      mesh.triangles.push_back({at(i, j), at(k, j), at(k, l)});
      mesh.triangles.push_back({at(i, j), at(k, l), at(i, l)});
    }
  }
  return mesh;
}

/// A height field of 2 n^2 triangles over [0, 1]^2.
template <class Real>
Mesh<Real> terrain(Rng& rng, std::uint32_t n) {
  Mesh<Real> mesh;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      const double x = double(i) / n, y = double(j) / n;
      const double z = 0.1 * std::sin(9 * x) * std::cos(7 * y) + 0.01 * rng.unit();
      mesh.add({static_cast<Real>(x), static_cast<Real>(y), static_cast<Real>(z)});
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

/// Triangles between random vertices of one style; vertices are shared, some triangles degenerate.
template <class Real>
Mesh<Real> soup(Rng& rng, Style style, std::uint32_t triangles) {
  Mesh<Real> mesh;
  const std::uint32_t vertices = std::max(3u, triangles);
  for (std::uint32_t i = 0; i < vertices; ++i) mesh.add(vec<Real>(rng, style));
  const auto any = [&] { return static_cast<std::uint32_t>(rng.below(vertices)); };
  for (std::uint32_t i = 0; i < triangles; ++i) {
    const std::uint32_t a = any(), b = any();
    mesh.triangles.push_back({a, b, any()});
  }
  return mesh;
}

/// Every triangle several times, some reversed or with their corners rotated.
template <class Real>
Mesh<Real> copies(Rng& rng, Mesh<Real> mesh, int times) {
  const auto once = mesh.triangles;
  for (int i = 1; i < times; ++i) {
    for (const auto& [a, b, c] : once) {
      mesh.triangles.push_back(rng.coin()   ? Triangle{a, b, c}
                               : rng.coin() ? Triangle{b, c, a}
                                            : Triangle{a, c, b});
    }
  }
  return mesh;
}

/// Long thin triangles in all directions from points in the unit cube.
template <class Real>
Mesh<Real> needles(Rng& rng, std::uint32_t count) {
  Mesh<Real> mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3<Real> a = vec<Real>(rng, Style::Unit), along = vec<Real>(rng, Style::Unit);
    const Vec3<Real> b{a.x + along.x, a.y + along.y, a.z + along.z};
    const Vec3<Real> c = nudged(rng, b, 3);
    const auto first = mesh.add(a);
    mesh.add(b);
    mesh.add(c);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace pierce::hard
