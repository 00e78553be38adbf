// SPDX-License-Identifier: Apache-2.0
#include "check/hard_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "check/lots.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

template <class Real>
using Vec = Vec3<Real>;

template <class Real>
struct Corners {
  Vec<Real> a, b, c;
};

template <class Real>
Real nudge(Real x, int ulps) {
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  for (; ulps > 0; --ulps) x = std::nextafter(x, kInf);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -kInf);
  return x;
}

template <class Real>
bool is_finite(const Vec<Real>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Draws one ray at a triangle. Sums are computed in the scene's own type, so that their rounding
// is part of the hardness; offsets are multiples of a coarse power of two, so that often there is
// none and the ray goes exactly where it is aimed.
template <class Real>
class Draw {
 public:
  Draw(Lots lots, const Corners<Real>& t, const Vec3<double>& centre, double radius)
      : lots_(lots), t_(t), centre_(centre), radius_(radius) {
    // Corners in any order: all that follows is about corner a or edge a b.
    if (lots_.below(2) != 0) std::swap(t_.a, t_.b);
    if (lots_.below(2) != 0) std::swap(t_.b, t_.c);
    if (lots_.below(2) != 0) std::swap(t_.a, t_.c);
  }

  Ray<Real> ray() {
    Ray<Real> ray = aimed();
    if (lots_.below(2) == 0) move_by_ulps(ray);
    cut_range(ray);
    return ray;
  }

 private:
  Ray<Real> aimed() {
    switch (lots_.below(12)) {
      case 0:  // at random
        return between(anywhere(), anywhere());
      case 1:  // through a vertex, from a coarse grid about it
        return coarse(t_.a, t_.a);
      case 2:  // through the middle of an edge, at t = 1/2
        return halfway();
      case 3:  // through the centroid, at t = 1/3
        return a_third_of_the_way();
      case 4:  // through a point of an edge or a face, as rounded
        return coarse(feature_point(), feature_point());
      case 5:  // from anywhere to a feature
        return between(anywhere(), feature_point());
      case 6:  // along an edge
        return {t_.a - small() * (t_.b - t_.a), t_.b - t_.a};
      case 7:  // in the plane
        return {t_.a + small() * (t_.b - t_.a) + small() * (t_.c - t_.a),
                small() * (t_.b - t_.a) + small() * (t_.c - t_.a)};
      case 8:  // parallel to an axis, past a feature
        return axis_parallel();
      case 9:  // from a vertex of the mesh or a feature, into the open
        return {feature_point(), convert<Real>(radius_ * lots_.cube())};
      case 10:  // from one feature to another, through the mesh
        return between(feature_point(), feature_point());
      default:  // grazing: in the plane, but for little
        return {t_.a + coarse_step(), (t_.b - t_.a) + small() * (t_.c - t_.a)};
    }
  }

  Ray<Real> between(const Vec<Real>& from, const Vec<Real>& to) { return {from, to - from}; }

  // Through `at`, exactly if the difference is exact; and o + 1 d = target.
  Ray<Real> coarse(const Vec<Real>& at, const Vec<Real>& target) {
    const Vec<Real> step = coarse_step();
    return {at - step, lots_.below(2) != 0 ? step : target - (at - step)};
  }

  Ray<Real> halfway() {
    const Vec<Real> x = coarse_step();
    return {t_.a + x, (t_.b - t_.a) - Real(2) * x};
  }

  Ray<Real> a_third_of_the_way() {
    const Vec<Real> x = coarse_step();
    return {t_.a + x, (t_.b - t_.a) + (t_.c - t_.a) - Real(3) * x};
  }

  Ray<Real> axis_parallel() {
    Vec<Real> d = {0, 0, 0};
    writable_component(d, lots_.below(3)) = static_cast<Real>(lots_.below(2) != 0 ? 1 : -1);
    if (lots_.below(3) == 0) d = static_cast<Real>(radius_) * d;
    Vec<Real> o = feature_point();
    if (lots_.below(3) != 0) o = o - static_cast<Real>(2 * radius_) * d;
    return {o, d};
  }

  Vec<Real> anywhere() { return convert<Real>(centre_ + 1.5 * radius_ * lots_.cube()); }

  // A vertex, a point of an edge, or a point of the face: rounded where it must be.
  Vec<Real> feature_point() {
    const auto part = [&] { return static_cast<Real>(lots_.between(1, 7)) / 8; };
    switch (lots_.below(4)) {
      case 0:
        return t_.a;
      case 1:
        return Real(0.5) * (t_.a + t_.b);
      case 2:
        return t_.a + part() * (t_.b - t_.a);
      default: {
        const Vec<Real> along = t_.a + part() * (t_.b - t_.a);
        return along + part() * (t_.c - along);
      }
    }
  }

  Real small() { return static_cast<Real>(lots_.between(-3, 3)); }

  // Some small integers times a power of two near the size of the triangle or of the mesh.
  Vec<Real> coarse_step() {
    const Vec<Real> e = t_.b - t_.a;
    double size = static_cast<double>(std::max({std::fabs(e.x), std::fabs(e.y), std::fabs(e.z)}));
    if (size == 0 || lots_.below(2) != 0) size = radius_;
    const double unit = size > 0 ? std::ldexp(1.0, std::ilogb(size) - lots_.between(0, 3)) : 1;
    const auto some = [&] { return static_cast<Real>(lots_.between(-9, 9) * unit); };
    const Real x = some(), y = some();
    return {x, y, some()};
  }

  void move_by_ulps(Ray<Real>& ray) {
    const bool all = lots_.below(2) != 0;
    for (Vec<Real>* v : {&ray.origin, &ray.direction}) {
      for (Real* x : {&v->x, &v->y, &v->z}) {
        if (all || lots_.below(3) == 0) *x = nudge(*x, lots_.between(-2, 2));
      }
    }
  }

  // Some rays are cut where their aim is (t is 1, 1/2, 1/3 or 0 there), or a little beside.
  void cut_range(Ray<Real>& ray) {
    constexpr Real kInf = std::numeric_limits<Real>::infinity();
    const Real ends[] = {0, 1, Real(0.5), Real(1) / 3, Real(-1), 2};
    const auto end = [&] { return nudge(ends[lots_.below(6)], lots_.between(-1, 1)); };
    switch (lots_.below(8)) {
      case 0:
        ray.t_max = end();
        break;
      case 1:
        ray.t_min = end();
        break;
      case 2:
        ray.t_min = -kInf;
        break;
      case 3:
        ray.t_min = end();
        ray.t_max = end();
        break;
      default:
        break;
    }
  }

  Lots lots_;
  Corners<Real> t_;
  Vec3<double> centre_;
  double radius_;
};

template <class Real>
bool is_valid(const Ray<Real>& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != Vec<Real>{0, 0, 0};
}

}  // namespace

template <class Real>
HardRays<Real>::HardRays(MeshView<Real> mesh, std::uint64_t seed) : mesh_(mesh), seed_(seed) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3<double> low = {kInf, kInf, kInf}, high = -low;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3<double> p = convert<double>(mesh.vertices[v]);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  centre_ = 0.5 * low + 0.5 * high;
  const Vec3<double> half = 0.5 * high - 0.5 * low;
  radius_ = std::max({half.x, half.y, half.z});
}

template <class Real>
Ray<Real> HardRays<Real>::operator()(std::uint64_t index) const {
  for (std::uint64_t attempt = 0; attempt < 16; ++attempt) {
    Lots lots(seed_ + attempt, index);
    const Triangle& t = mesh_.triangles[lots.below(mesh_.triangles.size())];
    const Corners<Real> corners = {mesh_.vertices[t[0]], mesh_.vertices[t[1]],
                                   mesh_.vertices[t[2]]};
    const Ray<Real> ray = Draw<Real>(lots, corners, centre_, radius_).ray();
    if (is_valid(ray)) return ray;
  }
  // Numbers so large or so small that everything overflowed or vanished.
  return {convert<Real>(centre_), {0, 0, 1}};
}

template class HardRays<float>;
template class HardRays<double>;

}  // namespace pierce::tool
