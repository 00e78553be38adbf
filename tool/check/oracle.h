// SPDX-License-Identifier: Apache-2.0
//
// The oracle of `pierce check`: the definitions themselves. Every triangle near the ray is given to
// a textbook method over exact numbers; what hits is put in order by exact t, and only then
// rounded.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "check/exact.h"
#include "check/near_triangles.h"
#include "pierce/textbook/determinants.h"
#include "pierce/vector.h"

namespace pierce::tool {

template <class Real>
class Oracle {
 public:
  explicit Oracle(MeshView<Real> mesh) : mesh_(mesh), near_(mesh) {}

  /// Every hit, in order, and how many of them lie exactly at t_min: those come first, and
  /// Range::OpenStart leaves them out.
  struct Answer {
    std::vector<Hit<Real>> hits;
    std::size_t at_start = 0;
  };

  [[nodiscard]] Answer all_hits(const Ray<Real>& ray) const {
    std::vector<std::uint32_t> near;
    near_.find(ray, near);
    const Ray<Exact> exact_ray = exact(ray);
    std::vector<Found> found;
    for (const std::uint32_t triangle : near) {
      if (std::optional<Found> hit = test(exact_ray, triangle)) found.push_back(*std::move(hit));
    }
    std::sort(found.begin(), found.end(), [](const Found& x, const Found& y) {
      const int order = compare(x.t, y.t);
      return order != 0 ? order < 0 : x.triangle < y.triangle;
    });

    Answer answer;
    for (const Found& f : found) {
      answer.hits.push_back({round_to<Real>(f.t), round_to<Real>(f.u), round_to<Real>(f.v),
                             round_to<Real>(Exact(1) - f.u - f.v), 0, f.triangle, f.facing});
      if (f.t == Exact(static_cast<double>(ray.t_min))) ++answer.at_start;
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

  [[nodiscard]] std::optional<Found> test(const Ray<Exact>& ray, std::uint32_t triangle) const {
    const Triangle& corners = mesh_.triangles[triangle];
    const Vec3<Exact> a = exact(mesh_.vertices[corners[0]]);
    const Vec3<Exact> b = exact(mesh_.vertices[corners[1]]);
    const Vec3<Exact> c = exact(mesh_.vertices[corners[2]]);
    const auto hit = textbook::determinants(ray, a, b, c);
    if (!hit) return std::nullopt;
    const Exact n_d = dot(cross(b - a, c - a), ray.direction);
    return Found{hit->t, hit->u, hit->v, triangle, n_d < 0 ? Facing::Front : Facing::Back};
  }

  MeshView<Real> mesh_;
  NearTriangles near_;
};

}  // namespace pierce::tool
