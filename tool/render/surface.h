// SPDX-License-Identifier: Apache-2.0
//
// The place where a ray meets a mesh, for people who want to draw it: point, normals and whatever
// else the corners of the triangle have. Nothing here is exact; nothing here decides a hit.
#pragma once

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "io/mesh.h"
#include "pierce/barycentric.h"
#include "pierce/vector.h"
#include "render/color.h"

namespace pierce::tool {

/// A unit vector of the same direction; zero stays zero.
[[nodiscard]] inline Vec3<double> normalized(const Vec3<double>& v) {
  const double length = std::hypot(v.x, v.y, v.z);
  return length > 0 ? 1 / length * v : v;
}

template <class Real>
class Surface {
 public:
  /// `attributes` and the mesh must outlive the surface. `smooth`: where the file has no normals,
  /// make them from those of the triangles round each vertex.
  Surface(MeshView<Real> mesh, const io::Mesh& attributes, bool smooth)
      : mesh_(mesh), attributes_(attributes) {
    if (smooth && attributes.normals.empty()) made_normals_ = make_normals();
  }

  [[nodiscard]] bool has_colors() const { return !attributes_.colors.empty(); }
  [[nodiscard]] bool has_texcoords() const { return !attributes_.texcoords.empty(); }

  /// Of unit length, on the side that the corners run round counter-clockwise.
  [[nodiscard]] Vec3<double> face_normal(const Hit<Real>& hit) const {
    const std::array<Vec3<double>, 3> p = corners(hit.triangle);
    return normalized(cross(scaled(p[1] - p[0]), scaled(p[2] - p[0])));
  }

  /// The corners' normals interpolated, if there are any; else the face's.
  [[nodiscard]] Vec3<double> normal(const Hit<Real>& hit) const {
    const std::span<const Vec3<float>> normals =
        attributes_.normals.empty() ? std::span(made_normals_) : std::span(attributes_.normals);
    if (normals.empty()) return face_normal(hit);
    const Vec3<double> n = normalized(convert<double>(at(hit, normals)));
    return n == Vec3<double>{0, 0, 0} ? face_normal(hit) : n;
  }

  [[nodiscard]] Vec3<double> point(const Hit<Real>& hit) const {
    return interpolate(weights<double>(hit), corners(hit.triangle));
  }

  [[nodiscard]] Color color(const Hit<Real>& hit) const {
    return at(hit, std::span(attributes_.colors));
  }

  [[nodiscard]] std::array<float, 2> texcoord(const Hit<Real>& hit) const {
    const Triangle& t = mesh_.triangles[hit.triangle];
    const auto& all = attributes_.texcoords;
    return interpolate(weights<float>(hit), std::array{all[t[0]], all[t[1]], all[t[2]]});
  }

 private:
  template <class Scalar>
  static std::array<Scalar, 3> weights(const Hit<Real>& hit) {
    return {static_cast<Scalar>(hit.w), static_cast<Scalar>(hit.u), static_cast<Scalar>(hit.v)};
  }

  [[nodiscard]] Vec3<float> at(const Hit<Real>& hit, std::span<const Vec3<float>> values) const {
    const Triangle& t = mesh_.triangles[hit.triangle];
    return interpolate(weights<float>(hit), std::array{values[t[0]], values[t[1]], values[t[2]]});
  }

  [[nodiscard]] std::array<Vec3<double>, 3> corners(std::size_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {convert<double>(mesh_.vertices[t[0]]), convert<double>(mesh_.vertices[t[1]]),
            convert<double>(mesh_.vertices[t[2]])};
  }

  // Brings the largest component near 1, so that products neither overflow nor vanish.
  static Vec3<double> scaled(const Vec3<double>& v) {
    const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    if (largest == 0) return v;
    const int exponent = -std::ilogb(largest);
    return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
  }

  // At each vertex the mean of its triangles' normals, weighted by the angle they have there.
  [[nodiscard]] std::vector<Vec3<float>> make_normals() const {
    std::vector<Vec3<double>> sum(mesh_.vertices.size());
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const std::array<Vec3<double>, 3> p = corners(i);
      const Vec3<double> n = normalized(cross(scaled(p[1] - p[0]), scaled(p[2] - p[0])));
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3<double> e = normalized(p[(k + 1) % 3] - p[k]);
        const Vec3<double> f = normalized(p[(k + 2) % 3] - p[k]);
        Vec3<double>& s = sum[mesh_.triangles[i][k]];
        s = s + std::acos(std::clamp(dot(e, f), -1.0, 1.0)) * n;
      }
    }
    std::vector<Vec3<float>> normals(sum.size());
    for (std::size_t v = 0; v < sum.size(); ++v) normals[v] = convert<float>(normalized(sum[v]));
    return normals;
  }

  MeshView<Real> mesh_;
  const io::Mesh& attributes_;
  std::vector<Vec3<float>> made_normals_;
};

}  // namespace pierce::tool
