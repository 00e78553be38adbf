// SPDX-License-Identifier: Apache-2.0
#include "bounds/draw.h"

#include <utility>

namespace pierce::siege {
namespace {

using attack::max_norm;
using attack::on_grid;
using attack::operator+;
using attack::operator*;
using attack::rounded;
using attack::signed_unit;
using hard::component;

using Vec = Vec3<double>;

Vec minus(const Vec& p, const Vec& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
Vec cross(const Vec& p, const Vec& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
double dot(const Vec& p, const Vec& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

Vec inside(const Vec& p, double limit = 1) {
  const auto clamped = [limit](double x) { return std::clamp(x, -limit, limit); };
  return {clamped(p.x), clamped(p.y), clamped(p.z)};
}

/// point + offset, or less of the offset where the box ends.
Vec within(const Vec& point, const Vec& offset) {
  double room = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec p = point, o = offset;
    const double x = component(p, k), by = component(o, k);
    if (std::fabs(x + by) > 1) room = std::min(room, (std::copysign(1.0, by) - x) / by);
  }
  return inside(point + room * offset);
}

Vec finish(Rng& rng, const Plan& plan, const Vec& p) {
  if (plan.exact) return rounded(p);
  if (rng.coin()) return on_grid(p);
  return inside(on_grid(attack::awkward(rng, p)));
}

Vec draw_offset(Rng& rng, double size) {
  const auto part = [&] {
    if (rng.one_in(8)) return 0.0;
    return size * (rng.one_in(3) ? signed_unit(rng) : rng.symmetric());
  };
  return {part(), part(), part()};
}

/// Nearly along the ray, so that den is about as large as its bound.
Vec grazing(Rng& rng, double size, const Vec& direction, const Vec& aside) {
  const double e = size * (90 + 148 * size) * 0x1p-24 + 0x1p-40;
  const double off = e / (size * size) * std::ldexp(1 + rng.unit(), rng.between(-6, 4));
  return size * signed_unit(rng) * direction + std::min(off / size, 1.0) * aside;
}

/// A number that float rounds by nearly half a unit, so that (copy - number) * gradient has the
/// sign of `want`.
double bad(double x, double gradient, double want) {
  const auto copy = static_cast<float>(x);
  const double to = std::copysign(8.0, -gradient * want);
  const auto f = static_cast<double>(copy);
  const auto next = static_cast<double>(std::nextafter(copy, static_cast<float>(to)));
  return on_grid(f + 0.4998 * (next - f));
}
Vec bad(const Vec& p, const Vec& gradient, double want) {
  return {bad(p.x, gradient.x, want), bad(p.y, gradient.y, want), bad(p.z, gradient.z, want)};
}

void keep_valid(RayD& ray) {
  if (max_norm(ray.direction) < 1) ray.direction.x = std::copysign(1.0, ray.direction.x);
  ray.origin = inside(ray.origin, 2);
}

}  // namespace

Plan draw_plan(Rng& rng) {
  const int size = rng.one_in(4)   ? rng.between(-1, 1)
                   : rng.one_in(4) ? rng.between(-1, 32)
                                   : rng.between(2, 18);
  return {attack::Aim::DiscardHit, rng.one_in(3), size};
}

RayD draw_ray(Rng& rng, const Plan& plan, const Vec& target) {
  RayD ray;
  ray.t_min = -kInfinity<double>;
  ray.t_max = kInfinity<double>;
  const auto put = [&](const Vec& p) { return plan.exact ? rounded(p) : on_grid(p); };
  if (rng.coin()) {  // from as far as may be
    const auto across = [&](double x) { return -std::copysign(2 - 0.1 * rng.unit(), x); };
    ray.origin = put({across(target.x), across(target.y), across(target.z)});
    const Vec d = minus(target, ray.origin);
    ray.direction = put((rng.coin() ? 0.6 : 0.36) * d);
    if (max_norm(ray.direction) >= 1 && max_norm(ray.direction) < 2) return ray;
  }
  ray.direction = attack::draw_direction(rng, plan);
  const double far = rng.one_in(4) ? std::ldexp(rng.unit(), -rng.between(0, 30)) : 3 * rng.unit();
  for (double tau = signed_unit(rng) * far;; tau *= 0.9) {
    const Vec o = target + (-tau) * ray.direction;
    if (!(max_norm(o) <= 2)) continue;
    ray.origin = put(o);
    return ray;
  }
}

RayD draw_exact_ray(Rng& rng, const Vec& target) {
  RayD ray = draw_ray(rng, {attack::Aim::DiscardHit, false, 0}, {0, 0, 0});
  const auto few_bits = [](double x, double unit) { return std::trunc(x / unit) * unit; };
  Vec& d = ray.direction;
  d = {few_bits(d.x, 0x1p-29), few_bits(d.y, 0x1p-29), few_bits(d.z, 0x1p-29)};
  keep_valid(ray);
  for (double tau = few_bits(3 * rng.symmetric(), 0x1p-26);; tau = few_bits(tau / 2, 0x1p-26)) {
    ray.origin = target + (-tau) * d;
    if (max_norm(ray.origin) <= 2) return ray;
  }
}

Vec point_at(const RayD& ray, double tau) { return on_grid(ray.origin + tau * ray.direction); }

double draw_tau(Rng& rng, const RayD& ray) {
  double first = -4, last = 4;
  Vec o = ray.origin, d = ray.direction;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = component(o, k), slope = component(d, k);
    if (slope == 0) continue;
    const double one = (-1 - x) / slope, other = (1 - x) / slope;
    first = std::max(first, std::min(one, other));
    last = std::min(last, std::max(one, other));
  }
  return last > first ? first + (last - first) * rng.unit() : first;
}

Vec draw_point(Rng& rng, const RayD& ray) { return inside(point_at(ray, draw_tau(rng, ray))); }

TriangleD draw_around(Rng& rng, const Plan& plan, const RayD& ray, const Vec& point) {
  const double size = std::ldexp(0.5 + 0.5 * rng.unit(), -plan.size);
  const Vec p = draw_offset(rng, size), aside = draw_offset(rng, size);
  const Vec q = rng.coin() ? aside : grazing(rng, size, 0.5 * ray.direction, aside);
  return {finish(rng, plan, within(point, p)), finish(rng, plan, within(point, q)),
          finish(rng, plan, within(point, -1.0 * (p + q)))};
}

TriangleD draw_touched(Rng& rng, const Plan& plan, const RayD& ray, const Vec& point) {
  const double size = std::ldexp(0.5 + 0.5 * rng.unit(), -plan.size);
  const Vec along = draw_offset(rng, size), aside = draw_offset(rng, size);
  const double part = rng.one_in(4) ? std::ldexp(1.0, -rng.between(1, 30)) : rng.unit();
  Vec a = within(point, part * along), b = within(point, (part - 1) * along);
  Vec c = within(point, aside);
  switch (rng.below(8)) {
    case 0:  // a corner
      a = point;
      break;
    case 1:
      return draw_around(rng, plan, ray, point);
    case 2: {  // a needle or a sliver
      const double thin = std::ldexp(rng.symmetric(), -rng.between(4, 50));
      c = rng.coin() ? within(a, thin * aside) : within(a + rng.unit() * minus(b, a), thin * aside);
      break;
    }
    case 3:  // the ray all but lies in the plane
      c = within(point, grazing(rng, size, ray.direction, aside));
      break;
    default:  // an edge
      break;
  }
  TriangleD t{finish(rng, plan, a), finish(rng, plan, b), finish(rng, plan, c)};
  if (rng.one_in(4)) {  // a little beside
    Vec* const corners[3] = {&t.a, &t.b, &t.c};
    double& x = component(*corners[rng.below(3)], rng.below(3));
    const double moved =
        plan.exact || rng.coin()
            ? static_cast<double>(hard::nudged(static_cast<float>(x), rng.between(-3, 3)))
            : x + rng.between(-2, 2) * 0x1p-55;
    x = std::clamp(moved, -1.0, 1.0);
    if (!plan.exact) x = on_grid(x);
  }
  return t;
}

TriangleD draw_box_corner(Rng& rng, const Plan& plan, const RayD& ray, const Vec& point) {
  const double size = std::ldexp(0.5 + 0.5 * rng.unit(), -plan.size);
  Vec d = ray.direction;
  const std::size_t in = rng.below(3), out = (in + 1 + rng.below(2)) % 3, rest = 3 - in - out;
  TriangleD t{point, {}, {}};
  const bool edge = rng.coin();  // met in an edge along the third axis, else in the corner
  const auto corner = [&](double side, bool far) {
    Vec off{};
    if (far) {
      component(off, in) = std::copysign(size * rng.unit(), component(d, in));
      component(off, out) = -std::copysign(size * rng.unit(), component(d, out));
    }
    component(off, rest) = side * size * rng.unit();
    const Vec p = within(point, off);
    return plan.exact ? rounded(p) : on_grid(p);
  };
  t.b = corner(1, !edge || rng.one_in(4));
  t.c = corner(-1, true);
  if (edge) t.a = corner(-1, false);
  if (plan.exact) t.a = rounded(t.a);
  return t;
}

void round_edge_badly(Rng& rng, bool with_ray, RayD& ray, TriangleD& t) {
  const Vec p = minus(t.a, ray.origin), q = minus(t.b, ray.origin);
  const Vec by_a = cross(q, ray.direction), by_b = cross(ray.direction, p);
  const double want = signed_unit(rng);
  t.a = bad(t.a, by_a, want);
  t.b = bad(t.b, by_b, want);
  const Vec by_origin = -1.0 * (by_a + by_b);
  if (with_ray) {
    ray.origin = bad(ray.origin, by_origin, want);
    ray.direction = bad(ray.direction, cross(p, q), want);
    keep_valid(ray);
  }
  // Back to the ray by whole units of a float's last place, which changes no rounding.
  Vec lever = by_origin;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::fabs(component(lever, k)) > std::fabs(component(lever, axis))) axis = k;
  }
  const double off = dot(ray.direction, cross(minus(t.a, ray.origin), minus(t.b, ray.origin)));
  const double steps = std::nearbyint(off / (0x1p-24 * component(lever, axis)));
  const double a = component(t.a, axis) + steps * 0x1p-24;
  const double b = component(t.b, axis) + steps * 0x1p-24;
  if (std::fabs(steps) <= 1000) component(t.a, axis) = a, component(t.b, axis) = b;
  t.a = inside(t.a);
  t.b = inside(t.b);
}

void round_place_badly(Rng& rng, bool with_ray, RayD& ray, TriangleD& t) {
  const Vec normal = cross(minus(t.b, t.a), minus(t.c, t.a));
  const double want = signed_unit(rng);
  for (Vec* corner : {&t.a, &t.b, &t.c}) *corner = inside(bad(*corner, normal, want));
  if (!with_ray) return;
  const double tau = place_of(ray, t);
  ray.origin = bad(ray.origin, normal, -want);
  ray.direction = bad(ray.direction, tau * normal, -want);
  keep_valid(ray);
}

double place_of(const RayD& ray, const TriangleD& t) {
  const Vec normal = cross(minus(t.b, t.a), minus(t.c, t.a));
  return dot(normal, minus(t.a, ray.origin)) / dot(normal, ray.direction);
}

}  // namespace pierce::siege
