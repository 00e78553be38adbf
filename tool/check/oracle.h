// SPDX-License-Identifier: Apache-2.0
//
// The oracle of `pierce check`: the definitions themselves. Every triangle near the ray is given to
// a textbook method over exact numbers; what hits is put in order by exact t, and only then
// rounded.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "check/exact.h"
#include "check/exact_crossings.h"
#include "check/near_triangles.h"
#include "pierce/textbook/determinants.h"
#include "pierce/vector.h"

namespace pierce::tool {

template <class Real>
class Oracle {
 public:
  explicit Oracle(MeshView<Real> mesh) : mesh_(mesh), near_(mesh) {}

  /// Every hit, in order; how many of them lie exactly at t_min: those come first, and
  /// Range::OpenStart leaves them out. And the passages.
  struct Answer {
    std::vector<Hit<Real>> hits;
    std::size_t at_start = 0;
    Crossings crossings = {};
  };

  [[nodiscard]] Answer ask(const Ray<Real>& ray) const {
    std::vector<std::uint32_t> near;
    near_.find(ray, near);
    const Ray<Exact> exact_ray = exact(ray);
    std::vector<Found> found;
    Answer answer;
    for (const std::uint32_t triangle : near) {
      const std::array<Vec3<Exact>, 3> corners = corners_of(triangle);
      if (auto hit = test(exact_ray, corners, triangle)) found.push_back(*std::move(hit));
      count(passage(ray, exact_ray.origin, exact_ray.direction, corners), answer.crossings);
      answer.crossings.origin_on_surface |= on_triangle(exact_ray.origin, corners);
    }
    std::sort(found.begin(), found.end(), [](const Found& x, const Found& y) {
      const int order = compare(x.t, y.t);
      return order != 0 ? order < 0 : x.triangle < y.triangle;
    });

    for (const Found& f : found) {
      answer.hits.push_back({round_to<Real>(f.t), round_to<Real>(f.u), round_to<Real>(f.v),
                             round_to<Real>(Exact(1) - f.u - f.v), 0, f.triangle, f.facing});
      if (std::isfinite(ray.t_min) && f.t == Exact(static_cast<double>(ray.t_min)))
        ++answer.at_start;
    }
    return answer;
  }

 private:
  struct Found {
    Exact t, u, v;
    std::uint32_t triangle;
    Facing facing;
  };

  static Vec3<Exact> exact(const Vec3<Real>& v) {
    return {Exact(static_cast<double>(v.x)), Exact(static_cast<double>(v.y)),
            Exact(static_cast<double>(v.z))};
  }

  static Ray<Exact> exact(const Ray<Real>& ray) {
    const auto end = [](Real t) {
      if (!std::isinf(t)) return Bound<Exact>(Exact(static_cast<double>(t)));
      return t > 0 ? Bound<Exact>::infinity() : Bound<Exact>::minus_infinity();
    };
    return {exact(ray.origin), exact(ray.direction), end(ray.t_min), end(ray.t_max)};
  }

  static void count(int passage, Crossings& crossings) {
    crossings.count += passage != 0 ? 1 : 0;
    crossings.signed_count += passage;
  }

  [[nodiscard]] std::array<Vec3<Exact>, 3> corners_of(std::uint32_t triangle) const {
    const Triangle& t = mesh_.triangles[triangle];
    return {exact(mesh_.vertices[t[0]]), exact(mesh_.vertices[t[1]]), exact(mesh_.vertices[t[2]])};
  }

  static std::optional<Found> test(const Ray<Exact>& ray, const std::array<Vec3<Exact>, 3>& corners,
                                   std::uint32_t triangle) {
    const auto& [a, b, c] = corners;
    const auto hit = textbook::determinants(ray, a, b, c);
    if (!hit) return std::nullopt;
    const Exact n_d = dot(cross(b - a, c - a), ray.direction);
    return Found{hit->t, hit->u, hit->v, triangle, n_d < 0 ? Facing::Front : Facing::Back};
  }

  MeshView<Real> mesh_;
  NearTriangles near_;
};

}  // namespace pierce::tool
