// SPDX-License-Identifier: Apache-2.0
//
// Rays and triangles in filter space that come as near to the bounds of the leaf cull as we know
// how: rays through vertices and edges (exactly, to 2^-52), as seen from the far side of the scene
// along its diagonals, with every number rounded the wrong way; edges of all sizes down to a float's
// last place; needles; every sign. Of a few neighbours the one that the model calls worst is taken.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "support/cull_model.h"
#include "support/hard_numbers.h"
#include "support/one_leaf.h"
#include "support/rng.h"

namespace pierce::attack {

using hard::Rng;

inline Vec3<double> operator+(const Vec3<double>& p, const Vec3<double>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}
inline Vec3<double> operator*(double k, const Vec3<double>& p) {
  return {k * p.x, k * p.y, k * p.z};
}

/// On the grid of 2^-55: numbers within 4 then take 57 bits, and the exact referee is quick.
inline double on_grid(double x) { return std::nearbyint(x * 0x1p55) * 0x1p-55; }
inline Vec3<double> on_grid(const Vec3<double>& p) {
  return {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
}

/// A float, or one moved by nearly half a unit in its last place: rounded as far as can be.
inline double awkward(Rng& rng, double x) {
  const auto f = static_cast<float>(x);
  const double below = std::nextafter(f, 0.0F);
  const double half = 0.5 * (static_cast<double>(f) - below);
  const double off = rng.coin() ? 0x1.fffp-1 : rng.unit();
  return f + (rng.coin() ? off : -off) * half;
}
inline Vec3<double> awkward(Rng& rng, const Vec3<double>& p) {
  return {awkward(rng, p.x), awkward(rng, p.y), awkward(rng, p.z)};
}

/// What an attack aims at.
enum class Aim { DiscardHit, CertainMiss, DiscardByRange, CertainOutOfRange };

struct Plan {
  Aim aim;
  bool exact;  // everything is a float
  int size;    // edges of about 2^-size
};

inline double signed_unit(Rng& rng) { return rng.coin() ? 1.0 : -1.0; }

/// A point of the box, mostly near a corner of it.
inline Vec3<double> draw_place(Rng& rng) {
  const auto far = [&] { return signed_unit(rng) * (1 - 0.1 * rng.unit() * rng.unit()); };
  if (rng.one_in(4)) return {rng.symmetric(), rng.symmetric(), rng.symmetric()};
  return {far(), far(), far()};
}

inline predicate::TriangleD draw_triangle(Rng& rng, const Plan& plan) {
  const double size = std::ldexp(1.0 + rng.unit(), -plan.size);
  const auto edge = [&] {
    return size * (rng.one_in(3) ? signed_unit(rng) : rng.symmetric());
  };
  const Vec3<double> a = draw_place(rng);
  Vec3<double> b = a + Vec3<double>{edge(), edge(), edge()};
  Vec3<double> c = a + Vec3<double>{edge(), edge(), edge()};
  if (rng.one_in(6)) c = a + (rng.symmetric() * (b + (-1.0 * a)) + 0x1p-12 * (c + (-1.0 * a)));
  const auto inside = [](double x) { return std::clamp(x, -1.0, 1.0); };
  predicate::TriangleD t;
  const auto finish = [&](const Vec3<double>& p) {
    Vec3<double> q = {inside(p.x), inside(p.y), inside(p.z)};
    q = plan.exact ? Vec3<double>{static_cast<float>(q.x), static_cast<float>(q.y),
                                  static_cast<float>(q.z)}
                   : on_grid(awkward(rng, q));
    return Vec3<double>{inside(q.x), inside(q.y), inside(q.z)};
  };
  t.a = finish(a);
  t.b = finish(b);
  t.c = finish(c);
  return t;
}

/// A point of the triangle, mostly on its border.
inline Vec3<double> draw_target(Rng& rng, const predicate::TriangleD& t) {
  double u = rng.unit();
  double v = rng.unit() * (1 - u);
  switch (rng.below(8)) {
    case 0:
      u = 0;
      break;
    case 1:
      v = 0;
      break;
    case 2:
    case 3:
      v = 1 - u;
      break;
    case 4:
      u = rng.coin() ? 0 : 1;
      v = u > 0 ? 0 : static_cast<double>(rng.below(2));
      break;
    case 5:
      u = v = 0x1p-10 * rng.unit();
      break;
    default:
      break;
  }
  return (1 - u - v) * t.a + (u * t.b + v * t.c);
}

inline Vec3<double> draw_direction(Rng& rng, const Plan& plan) {
  const auto large = [&] { return signed_unit(rng) * (2 - 0.2 * rng.unit() * rng.unit()); };
  Vec3<double> d = {large(), large(), large()};
  if (rng.one_in(3)) d = {2 * rng.symmetric(), 2 * rng.symmetric(), 2 * rng.symmetric()};
  if (rng.one_in(8)) hard::component(d, rng.below(3)) = std::ldexp(rng.symmetric(), -50);
  if (rng.one_in(16)) hard::component(d, rng.below(3)) = rng.coin() ? 0.0 : -0.0;
  const double size = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
  if (size < 1) hard::component(d, rng.below(3)) = signed_unit(rng);
  if (plan.exact) {
    return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)};
  }
  return on_grid(awkward(rng, d));
}

inline double max_norm(const Vec3<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// An origin from which the ray meets the target, as far away as may be.
inline Vec3<double> draw_origin(Rng& rng, const Plan& plan, const Vec3<double>& target,
                                const Vec3<double>& d) {
  for (double reach = 3;; reach *= 0.9) {
    const double tau = (rng.coin() ? reach : -reach) * (rng.coin() ? 1 : rng.unit());
    Vec3<double> o = target + (-tau) * d;
    if (!(max_norm(o) <= 2)) continue;
    if (plan.exact) {
      return {static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z)};
    }
    return on_grid(o);
  }
}

/// How near the case is to what the plan aims at; over 1 the bound is broken.
inline float score(const LeafCase& c, const Plan& plan, bool fused) {
  const predicate::TriangleD& t = c.triangles.front();
  const CullModel model(c.ray, t, fused, plan.exact);
  const predicate::RayD line{c.ray.origin, c.ray.direction, -kInfinity<double>, kInfinity<double>};
  const bool hit = predicate::settle_hit(line, t).hit;
  switch (plan.aim) {
    case Aim::DiscardHit:
      return hit ? model.outside() : -1;
    case Aim::CertainMiss:
      return hit ? -1 : model.inside();
    case Aim::DiscardByRange:
    case Aim::CertainOutOfRange: {
      if (!hit || !model.safe()) return -1;
      const double tau = predicate::settle_numbers<double>(line, t).t;
      return static_cast<float>(std::fabs(static_cast<double>(model.tau) - tau) /
                                static_cast<double>(model.tau_err));
    }
  }
  return -1;
}

struct Attack {
  LeafCase c;
  float score = -2;
};

/// One attack: the worst of a few neighbours.
inline Attack draw_attack(Rng& rng, const Plan& plan, int neighbours) {
  Attack worst;
  const bool fused = rng.coin();
  LeafCase c;
  c.triangles = {draw_triangle(rng, plan)};
  c.ray.direction = draw_direction(rng, plan);
  for (int i = 0; i < neighbours; ++i) {
    if (i % 4 == 3) c.ray.direction = draw_direction(rng, plan);
    c.ray.origin = draw_origin(rng, plan, draw_target(rng, c.triangles.front()), c.ray.direction);
    c.ray.t_min = -kInfinity<double>;
    c.ray.t_max = kInfinity<double>;
    const float reached = score(c, plan, fused);
    if (reached > worst.score) worst = {c, reached};
  }
  return worst;
}

}  // namespace pierce::attack
