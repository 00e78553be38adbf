// SPDX-License-Identifier: Apache-2.0
//
// The place where a ray meets a mesh, for people who want to draw it: point, normals and whatever
// else the corners of the triangle have. Nothing here is exact; nothing here decides a hit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "io/mesh.h"
#include "loaded_scene.h"
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
  /// The meshes must outlive the surface. `smooth`: where a file has no normals, make them from
  /// those of the triangles round each vertex.
  Surface(const Meshes<Real>& meshes, bool smooth) {
    for (std::size_t i = 0; i < meshes.views().size(); ++i) {
      const io::Mesh& attributes = meshes.geometries()[i].mesh;
      parts_.push_back({meshes.views()[i], attributes, {}});
      if (smooth && attributes.normals.empty()) parts_[i].made_normals = make_normals(parts_[i]);
    }
  }

  /// Whether any of the meshes has some.
  [[nodiscard]] bool has_colors() const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return !part.attributes.colors.empty(); });
  }
  [[nodiscard]] bool has_texcoords() const {
    return std::any_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return !part.attributes.texcoords.empty(); });
  }

  /// Of unit length, on the side that the corners run round counter-clockwise.
  [[nodiscard]] Vec3<double> face_normal(const Hit<Real>& hit) const {
    const std::array<Vec3<double>, 3> p = corners(part_of(hit), hit.triangle);
    return normalized(cross(scaled(p[1] - p[0]), scaled(p[2] - p[0])));
  }

  /// How far the hit is from the nearest edge of its triangle, and how high that is at the least.
  struct EdgeDistance {
    double distance, height;
  };
  [[nodiscard]] EdgeDistance edge_distance(const Hit<Real>& hit) const {
    const std::array<Vec3<double>, 3> p = corners(part_of(hit), hit.triangle);
    const std::array<double, 3> weight = weights<double>(hit);
    constexpr double kInf = std::numeric_limits<double>::infinity();
    EdgeDistance least = {kInf, kInf};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<double> along = normalized(p[(k + 2) % 3] - p[(k + 1) % 3]);
      const Vec3<double> to = p[k] - p[(k + 1) % 3], up = to - dot(to, along) * along;
      const double height = std::hypot(up.x, up.y, up.z);
      least.distance = std::min(least.distance, weight[k] * height);
      least.height = std::min(least.height, height);
    }
    return least;
  }

  /// The corners' normals interpolated, if there are any; else the face's.
  [[nodiscard]] Vec3<double> normal(const Hit<Real>& hit) const {
    const Part& part = part_of(hit);
    const auto& normals =
        part.attributes.normals.empty() ? part.made_normals : part.attributes.normals;
    if (normals.empty()) return face_normal(hit);
    const Vec3<double> n = normalized(convert<double>(at(hit, normals)));
    return n == Vec3<double>{0, 0, 0} ? face_normal(hit) : n;
  }

  /// Of the mesh that was hit; `otherwise` if that one has none.
  [[nodiscard]] Color color(const Hit<Real>& hit, const Color& otherwise) const {
    const auto& colors = part_of(hit).attributes.colors;
    return colors.empty() ? otherwise : at(hit, colors);
  }

  [[nodiscard]] std::optional<std::array<float, 2>> texcoord(const Hit<Real>& hit) const {
    const Part& part = part_of(hit);
    const Triangle& t = part.mesh.triangles[hit.triangle];
    const auto& all = part.attributes.texcoords;
    if (all.empty()) return std::nullopt;
    return interpolate(weights<float>(hit), std::array{all[t[0]], all[t[1]], all[t[2]]});
  }

 private:
  struct Part {
    MeshView<Real> mesh;
    const io::Mesh& attributes;
    std::vector<Vec3<float>> made_normals;
  };

  [[nodiscard]] const Part& part_of(const Hit<Real>& hit) const { return parts_[hit.geometry]; }

  template <class Scalar>
  static std::array<Scalar, 3> weights(const Hit<Real>& hit) {
    return {static_cast<Scalar>(hit.w), static_cast<Scalar>(hit.u), static_cast<Scalar>(hit.v)};
  }

  [[nodiscard]] Vec3<float> at(const Hit<Real>& hit, std::span<const Vec3<float>> values) const {
    const Triangle& t = part_of(hit).mesh.triangles[hit.triangle];
    return interpolate(weights<float>(hit), std::array{values[t[0]], values[t[1]], values[t[2]]});
  }

  static std::array<Vec3<double>, 3> corners(const Part& part, std::size_t triangle) {
    const Triangle& t = part.mesh.triangles[triangle];
    return {convert<double>(part.mesh.vertices[t[0]]), convert<double>(part.mesh.vertices[t[1]]),
            convert<double>(part.mesh.vertices[t[2]])};
  }

  // Brings the largest component near 1, so that products neither overflow nor vanish.
  static Vec3<double> scaled(const Vec3<double>& v) {
    const double largest = std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
    if (largest == 0) return v;
    const int exponent = -std::ilogb(largest);
    return {std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
  }

  // At each vertex the mean of its triangles' normals, weighted by the angle they have there.
  static std::vector<Vec3<float>> make_normals(const Part& part) {
    std::vector<Vec3<double>> sum(part.mesh.vertices.size());
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
      const std::array<Vec3<double>, 3> p = corners(part, i);
      const Vec3<double> n = normalized(cross(scaled(p[1] - p[0]), scaled(p[2] - p[0])));
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3<double> e = normalized(p[(k + 1) % 3] - p[k]);
        const Vec3<double> f = normalized(p[(k + 2) % 3] - p[k]);
        Vec3<double>& s = sum[part.mesh.triangles[i][k]];
        s = s + std::acos(std::clamp(dot(e, f), -1.0, 1.0)) * n;
      }
    }
    std::vector<Vec3<float>> normals(sum.size());
    for (std::size_t v = 0; v < sum.size(); ++v) normals[v] = convert<float>(normalized(sum[v]));
    return normals;
  }

  std::vector<Part> parts_;
};

}  // namespace pierce::tool
