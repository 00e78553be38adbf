// SPDX-License-Identifier: Apache-2.0
//
// Where the next ray may start: proposes points near a hit, nearest first, in double. Nothing here
// decides anything; whoever asks says which proposals will not do, and which triangle is in the
// way.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pierce/vector.h"
#include "predicate/hit_point.h"
#include "support/finite.h"

namespace pierce::scene {

inline double max_norm(const Vec3<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// To max-norm 1; zero stays zero.
inline Vec3<double> shrunk(const Vec3<double>& p) {
  const double size = max_norm(p);
  return size > 0 ? Vec3<double>{p.x / size, p.y / size, p.z / size} : p;
}

/// About the normal, of length 1 in max-norm, whatever the size of the triangle.
inline Vec3<double> about_normal(const predicate::TriangleD& t) {
  const auto edge = [](const Vec3<double>& p, const Vec3<double>& q) {  // halves: no overflow
    return shrunk({p.x / 2 - q.x / 2, p.y / 2 - q.y / 2, p.z / 2 - q.z / 2});
  };
  return shrunk(cross(edge(t.b, t.a), edge(t.c, t.a)));
}

/// Calls `obstacle(point)` for one point after the other until it finds none; it answers with the
/// normal of a triangle that is in the way, turned to the side where the start should be (zero if
/// there is no such side).
///
/// First the hit point rounded, then one unit in the last place on along the normal, then at twice
/// the distance each time: along the sum of the normals of all that were in the way (the perceptron
/// algorithm: it finds a direction that leads away from all of them if there is one), and along the
/// ray.
template <class Real>
class StartPoints {
 public:
  /// `last`: to be tried when all else fails.
  StartPoints(const predicate::HitPoint& hit, const Vec3<double>& normal,
              const std::optional<Vec3<Real>>& last)
      : x_(hit.rounded()), way_(shrunk(hit.towards)), normal_(normal), last_(last) {
    const double half_unit =
        max_norm(x_) * static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
    step_ = std::max(half_unit, static_cast<double>(std::numeric_limits<Real>::denorm_min()));
  }

  [[nodiscard]] const Vec3<double>& hit() const { return x_; }

  template <class Obstacle>
  std::optional<Vec3<Real>> first_free(const Obstacle& obstacle) const {
    Vec3<double> away = normal_;
    const auto is_free = [&](const Vec3<Real>& s) {
      if (!is_finite_number(s.x) || !is_finite_number(s.y) || !is_finite_number(s.z)) return false;
      const std::optional<Vec3<double>> found = obstacle(s);
      if (found) away = away + *found;
      return !found;
    };
    const Vec3<Real> rounded = moved({0, 0, 0}, 0);
    if (is_free(rounded)) return rounded;
    const Vec3<Real> beside = nudged(rounded);
    if (is_free(beside)) return beside;
    double distance = step_;
    for (int i = 0; i < kDoublings; ++i, distance *= 2) {
      for (int attempt = 0; attempt < 3; ++attempt) {
        const Vec3<Real> s = moved(attempt == 2 ? way_ : shrunk(away), distance);
        if (is_free(s)) return s;
      }
    }
    if (last_ && is_free(*last_)) return *last_;
    return std::nullopt;
  }

 private:
  // How often the distance is doubled before giving up: from half a unit in the last place to the
  // size of the number.
  static constexpr int kDoublings = std::numeric_limits<Real>::digits + 2;

  [[nodiscard]] Vec3<Real> moved(const Vec3<double>& direction, double distance) const {
    const auto number = [distance](double x, double d) {
      return static_cast<Real>(d == 0 ? x : x + d * distance);
    };
    return {number(x_.x, direction.x), number(x_.y, direction.y), number(x_.z, direction.z)};
  }

  // One unit in the last place on, along the axis that the normal is nearest to.
  [[nodiscard]] Vec3<Real> nudged(Vec3<Real> s) const {
    const auto next = [](Real& x, double towards) {
      x = std::nextafter(x, std::copysign(kInfinity<Real>, static_cast<Real>(towards)));
    };
    const int axis = longest_axis(normal_);
    next(axis == 0 ? s.x : axis == 1 ? s.y : s.z, component(normal_, axis));
    return s;
  }

  Vec3<double> x_, way_, normal_;
  std::optional<Vec3<Real>> last_;
  double step_;
};

}  // namespace pierce::scene
