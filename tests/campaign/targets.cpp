// SPDX-License-Identifier: Apache-2.0
//
// Aiming. Points on edges and faces are rounded, so most are next to the surface and few on it; on
// lattices nearly all are on it. Directions are differences of two such points, or edges, or axes.
#include "campaign/targets.h"

#include <algorithm>
#include <cmath>

namespace pierce::campaign {
namespace {

double far_power(Rng& rng) { return std::ldexp(1.0, rng.pick({1, 3, 20, 28, 29, 40, 60})); }

Point mix(const Corners& t, double u, double v, double w) {
  return {w * t.a.x + u * t.b.x + v * t.c.x, w * t.a.y + u * t.b.y + v * t.c.y,
          w * t.a.z + u * t.b.z + v * t.c.z};
}

/// A point at a corner, an edge or the face of some triangle, nudged by 0 to 2 places.
template <class Real>
Vec3<Real> surface_point(Rng& rng, const World& world) {
  if (world.empty()) return in_cube<Real>(rng, 1);
  const Corners& t = rng.pick(world).corners;
  Point p{};
  switch (rng.below(5)) {
    case 0:
      p = rng.pick({t.a, t.b, t.c});
      break;
    case 1:
      p = mix(t, 0.5, 0.5, 0);
      break;
    case 2: {
      const double u = rng.pick({0.25, 0.75, rng.unit()});
      p = rng.one_in(2) ? mix(t, u, 0, 1 - u) : mix(t, 0, u, 1 - u);
      break;
    }
    case 3:
      p = mix(t, 0.25, 0.25, 0.5);
      break;
    default: {
      const double u = rng.unit(), v = rng.unit() * (1 - u);
      p = mix(t, u, v, 1 - u - v);
    }
  }
  return nudged(rng, finite<Real>(p.x, p.y, p.z), rng.one_in(2) ? 0 : rng.between(0, 2));
}

template <class Real>
Vec3<Real> difference(const Vec3<Real>& p, const Vec3<Real>& q) {
  return finite<Real>(double{p.x} - double{q.x}, double{p.y} - double{q.y},
                      double{p.z} - double{q.z});
}

template <class Real>
Vec3<Real> scaled(const Vec3<Real>& p, int power) {
  const auto times = [&](Real x) { return finite<Real>(std::ldexp(double{x}, power)); };
  return {times(p.x), times(p.y), times(p.z)};
}

/// An edge of a triangle, or a sum of two: a direction in its plane.
template <class Real>
Vec3<Real> direction_in_plane(Rng& rng, const World& world) {
  const Corners& t = rng.pick(world).corners;
  const Point from = rng.one_in(2) ? t.a : mix(t, 0.5, 0.5, 0);
  const Point to = rng.one_in(2) ? t.b : t.c;
  return finite<Real>(to.x - from.x, to.y - from.y, to.z - from.z);
}

template <class Real>
Vec3<Real> free_direction(Rng& rng, const World& world) {
  switch (rng.below(world.empty() ? 4 : 6)) {
    case 0: {
      Vec3<Real> d{0, Real(-0.0), 0};
      rng.pick({&d.x, &d.y, &d.z})[0] = rng.one_in(2) ? Real(1) : Real(-1);
      return d;
    }
    case 1:
      return {Real(rng.between(-3, 3)), Real(rng.between(-3, 3)), Real(rng.between(-3, 3))};
    case 2:
      return {any_size<Real>(rng), any_size<Real>(rng), any_size<Real>(rng)};
    case 3:
      return in_cube<Real>(rng, 1);
    default:
      return direction_in_plane<Real>(rng, world);
  }
}

/// The same direction at another length, or a component of it gone, or a little beside it.
template <class Real>
Vec3<Real> varied(Rng& rng, Vec3<Real> d) {
  using Limits = std::numeric_limits<Real>;
  if (rng.one_in(4)) d = nudged(rng, d, rng.between(1, 2));
  if (rng.one_in(6))
    d = scaled(d, rng.between(Limits::min_exponent - 40, Limits::max_exponent - 1));
  if (rng.one_in(10)) rng.pick({&d.x, &d.y, &d.z})[0] = rng.pick({Real(0), Real(-0.0)});
  if (rng.one_in(16)) rng.pick({&d.x, &d.y, &d.z})[0] = any_size<Real>(rng);
  if (rng.one_in(10)) {  // nearly, but not quite, along a plane of the axes
    const Real largest = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    rng.pick({&d.x, &d.y, &d.z})[0] = std::ldexp(largest, -rng.between(20, 70));
  }
  return d;
}

template <class Real>
void make_valid(Rng& rng, Vec3<Real>& d) {
  while (d.x == 0 && d.y == 0 && d.z == 0) d = in_cube<Real>(rng, 1);
}

}  // namespace

template <class Real>
Surroundings<Real>::Surroundings(std::span<const Mesh<Real>> meshes) : world(world_of(meshes)) {
  if (world.empty()) return;
  Point low = world[0].corners.a, high = low;
  for (const auto& [t, ref] : world) {
    low = {std::min({low.x, t.a.x, t.b.x, t.c.x}), std::min({low.y, t.a.y, t.b.y, t.c.y}),
           std::min({low.z, t.a.z, t.b.z, t.c.z})};
    high = {std::max({high.x, t.a.x, t.b.x, t.c.x}), std::max({high.y, t.a.y, t.b.y, t.c.y}),
            std::max({high.z, t.a.z, t.b.z, t.c.z})};
  }
  centre = {low.x / 2 + high.x / 2, low.y / 2 + high.y / 2, low.z / 2 + high.z / 2};
  size = std::max({high.x / 2 - low.x / 2, high.y / 2 - low.y / 2, high.z / 2 - low.z / 2});
  if (size == 0) size = std::max(std::numeric_limits<double>::min(), std::fabs(centre.x));
}

template <class Real>
Vec3<Real> any_point(Rng& rng, const Surroundings<Real>& around) {
  const World& world = around.world;
  const Point& centre = around.centre;
  const double size = around.size;
  const auto out = [&](double k) {
    return finite<Real>(centre.x + rng.within(k * size), centre.y + rng.within(k * size),
                        centre.z + rng.within(k * size));
  };
  switch (rng.below(12)) {
    case 0:
    case 1:
    case 2:
      return surface_point<Real>(rng, world);
    case 3:
    case 4:
      return out(1);
    case 5:
    case 6:
      return out(3);
    case 7:
      return out(far_power(rng));
    case 8: {  // each coordinate of another corner: in line with edges and planes
      const auto p = surface_point<Real>(rng, world), q = surface_point<Real>(rng, world);
      return {p.x, q.y, p.z};
    }
    case 9:
      return {any_size<Real>(rng), any_size<Real>(rng), any_size<Real>(rng)};
    case 10: {  // half way between two hard points
      const auto p = as_point(surface_point<Real>(rng, world));
      const auto q = as_point(surface_point<Real>(rng, world));
      return finite<Real>(p.x / 2 + q.x / 2, p.y / 2 + q.y / 2, p.z / 2 + q.z / 2);
    }
    default: {
      const Real tiny = finite<Real>(rng.pick({1e-300, 1e-40, 0.0, -0.0}));
      return {tiny, rng.one_in(2) ? tiny : Real(rng.between(-2, 2)), tiny};
    }
  }
}

template <class Real>
Ray<Real> aimed_ray(Rng& rng, const Surroundings<Real>& around) {
  Ray<Real> ray{any_point(rng, around), {0, 0, 0}};
  const auto target = surface_point<Real>(rng, around.world);
  switch (rng.below(4)) {
    case 0:
      ray.direction = free_direction<Real>(rng, around.world);
      break;
    case 1: {  // exactly through the target, if the sum is exact
      ray.direction = free_direction<Real>(rng, around.world);
      const int k = rng.between(-8, 8);
      const auto& d = ray.direction;
      ray.origin =
          finite<Real>(double{target.x} + k * double{d.x}, double{target.y} + k * double{d.y},
                       double{target.z} + k * double{d.z});
      break;
    }
    default:
      ray.direction = difference(target, ray.origin);
  }
  ray.direction = varied(rng, ray.direction);
  make_valid(rng, ray.direction);
  return ray;
}

template <class Real>
std::vector<Ray<Real>> bundle(Rng& rng, const Surroundings<Real>& around, std::size_t count) {
  const Ray<Real> middle = aimed_ray(rng, around);
  const auto side = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const bool parallel = rng.one_in(2), by_places = rng.one_in(3);
  const auto& moved = parallel ? middle.origin : middle.direction;
  const double reach = parallel ? around.size
                                : std::max({std::fabs(double{moved.x}), std::fabs(double{moved.y}),
                                            std::fabs(double{moved.z})});
  const double step = reach * std::ldexp(1.0, -rng.between(4, 26));
  const auto u = in_cube<double>(rng, 1), v = in_cube<double>(rng, 1);
  std::vector<Ray<Real>> rays;
  for (std::size_t n = 0; n < count; ++n) {
    const int i = static_cast<int>(n) / side - side / 2, j = static_cast<int>(n) % side - side / 2;
    Ray<Real> ray = middle;
    auto& p = parallel ? ray.origin : ray.direction;
    if (by_places) {
      p = {nudged(p.x, i), nudged(p.y, j), p.z};
    } else {
      p = finite<Real>(double{p.x} + step * (i * u.x + j * v.x),
                       double{p.y} + step * (i * u.y + j * v.y),
                       double{p.z} + step * (i * u.z + j * v.z));
    }
    make_valid(rng, ray.direction);
    rays.push_back(ray);
  }
  return rays;
}

template struct Surroundings<float>;
template struct Surroundings<double>;
template Vec3<float> any_point(Rng&, const Surroundings<float>&);
template Vec3<double> any_point(Rng&, const Surroundings<double>&);
template Ray<float> aimed_ray(Rng&, const Surroundings<float>&);
template Ray<double> aimed_ray(Rng&, const Surroundings<double>&);
template std::vector<Ray<float>> bundle(Rng&, const Surroundings<float>&, std::size_t);
template std::vector<Ray<double>> bundle(Rng&, const Surroundings<double>&, std::size_t);

}  // namespace pierce::campaign
