// SPDX-License-Identifier: Apache-2.0
//
// Rays and triangles in filter space that come as near to the bounds of the leaf cull as we know
// how: rays through vertices and edges (exactly, to 2^-52), as seen from the far side of the scene
// along its diagonals, with every number rounded the wrong way; edges of all sizes down to a
// float's last place; needles; every sign. Of a few neighbours the one that the model calls worst
// is taken.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "support/cull_model.h"
#include "support/hard_numbers.h"
#include "support/one_leaf.h"
#include "support/rng.h"

namespace pierce::attack {

using hard::Rng;

/// To float and back.
inline Vec3<double> rounded(const Vec3<double>& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

inline Vec3<double> operator+(const Vec3<double>& p, const Vec3<double>& q) {
  return {p.x + q.x, p.y + q.y, p.z + q.z};
}
inline Vec3<double> operator*(double k, const Vec3<double>& p) {
  return {k * p.x, k * p.y, k * p.z};
}

inline double max_norm(const Vec3<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

/// On the grid of 2^-55: numbers within 4 then take 57 bits, and the exact resolver is quick.
inline double on_grid(double x) { return std::nearbyint(x * 0x1p55) * 0x1p-55; }
inline Vec3<double> on_grid(const Vec3<double>& p) {
  return {on_grid(p.x), on_grid(p.y), on_grid(p.z)};
}

/// A float, or one moved by nearly half a unit in its last place: rounded as far as can be.
inline double awkward(Rng& rng, double x) {
  const auto nearest = static_cast<float>(x);
  const auto f = static_cast<double>(nearest);
  const double half = 0.5 * (f - static_cast<double>(std::nextafter(nearest, 0.0F)));
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

struct Weights {
  double u, v;
};

inline double signed_unit(Rng& rng) { return rng.coin() ? 1.0 : -1.0; }

/// A point of the box, mostly near a corner of it, now and then near the middle of some axes.
inline Vec3<double> draw_place(Rng& rng) {
  const auto far = [&] { return signed_unit(rng) * (1 - 0.1 * rng.unit() * rng.unit()); };
  if (rng.one_in(4)) {
    const auto any = [&] { return rng.coin() ? far() : std::ldexp(far(), -rng.between(1, 30)); };
    return {any(), any(), any()};
  }
  if (rng.one_in(4)) return {rng.symmetric(), rng.symmetric(), rng.symmetric()};
  return {far(), far(), far()};
}

inline predicate::TriangleD draw_triangle(Rng& rng, const Plan& plan) {
  const double size = std::ldexp(1.0 + rng.unit(), -plan.size);
  const auto edge = [&] { return size * (rng.one_in(3) ? signed_unit(rng) : rng.symmetric()); };
  const Vec3<double> a = draw_place(rng);
  Vec3<double> b = a + Vec3<double>{edge(), edge(), edge()};
  Vec3<double> c = a + Vec3<double>{edge(), edge(), edge()};
  if (rng.one_in(6)) c = a + (rng.symmetric() * (b + (-1.0 * a)) + 0x1p-12 * (c + (-1.0 * a)));
  const auto inside = [](double x) { return std::clamp(x, -1.0, 1.0); };
  predicate::TriangleD t;
  const auto finish = [&](const Vec3<double>& p) {
    Vec3<double> q = {inside(p.x), inside(p.y), inside(p.z)};
    q = plan.exact ? rounded(q) : on_grid(awkward(rng, q));
    return Vec3<double>{inside(q.x), inside(q.y), inside(q.z)};
  };
  t.a = finish(a);
  t.b = finish(b);
  t.c = finish(c);
  return t;
}

/// Weights of a point of the triangle, mostly on its border.
inline Weights draw_weights(Rng& rng) {
  const double u = rng.unit();
  const double v = rng.unit() * (1 - u);
  switch (rng.below(8)) {
    case 0:
      return {0, v};
    case 1:
      return {u, 0};
    case 2:
    case 3:
      return {u, 1 - u};
    case 4:  // a vertex
      return rng.coin() ? Weights{1, 0} : Weights{0, static_cast<double>(rng.below(2))};
    case 5:  // all but
      return {0x1p-10 * u, 0x1p-10 * v};
    default:
      return {u, v};
  }
}

inline Vec3<double> draw_direction(Rng& rng, const Plan& plan) {
  const auto large = [&] { return signed_unit(rng) * (2 - 0.2 * rng.unit() * rng.unit()); };
  Vec3<double> d = {large(), large(), large()};
  if (rng.one_in(3)) d = {2 * rng.symmetric(), 2 * rng.symmetric(), 2 * rng.symmetric()};
  if (rng.one_in(8)) hard::component(d, rng.below(3)) = std::ldexp(rng.symmetric(), -50);
  if (rng.one_in(16)) hard::component(d, rng.below(3)) = rng.coin() ? 0.0 : -0.0;
  if (max_norm(d) < 1) hard::component(d, rng.below(3)) = signed_unit(rng);
  return plan.exact ? rounded(d) : on_grid(awkward(rng, d));
}

/// What a case is made from: the origin follows from the rest.
struct Genes {
  predicate::TriangleD triangle;
  Vec3<double> direction;
  Weights at;
  double tau;  // where the triangle is met
};

inline Genes draw_genes(Rng& rng, const Plan& plan) {
  const double far = rng.one_in(4) ? std::ldexp(rng.unit(), -rng.between(0, 20)) : 3 * rng.unit();
  return {draw_triangle(rng, plan), draw_direction(rng, plan), draw_weights(rng),
          signed_unit(rng) * far};
}

/// The whole line that meets the triangle; from nearer by if the origin would be too far away.
inline LeafCase make_case(const Genes& g, const Plan& plan) {
  const predicate::TriangleD& t = g.triangle;
  const Vec3<double> target = (1 - g.at.u - g.at.v) * t.a + (g.at.u * t.b + g.at.v * t.c);
  LeafCase c;
  c.triangles = {t};
  c.ray.direction = g.direction;
  c.ray.t_min = -kInfinity<double>;
  c.ray.t_max = kInfinity<double>;
  for (double tau = g.tau;; tau *= 0.9) {
    const Vec3<double> o = target + (-tau) * g.direction;
    if (!(max_norm(o) <= 2)) continue;
    c.ray.origin = plan.exact ? rounded(o) : on_grid(o);
    return c;
  }
}

/// A near neighbour: one number moved by a little, mostly by units of a float's last place.
inline Genes neighbour(Rng& rng, const Plan& plan, Genes g) {
  const auto nudge = [&](Vec3<double>& p, double limit) {
    double& x = hard::component(p, rng.below(3));
    const auto f = hard::nudged(static_cast<float>(x), rng.between(-3, 3));
    x = std::clamp(plan.exact ? static_cast<double>(f) : on_grid(awkward(rng, f)), -limit, limit);
  };
  switch (rng.below(6)) {
    case 0:
      nudge(g.triangle.a, 1);
      break;
    case 1:
      nudge(g.triangle.b, 1);
      break;
    case 2:
      nudge(g.triangle.c, 1);
      break;
    case 3:
      nudge(g.direction, 0x1.fffffep0);
      break;
    case 4:
      g.tau *= 1 + std::ldexp(rng.symmetric(), -rng.between(3, 24));
      break;
    default:
      if (g.at.u > 0 && g.at.v > 0 && g.at.u + g.at.v < 1) g.at = draw_weights(rng);
      g.tau += std::ldexp(rng.symmetric(), -rng.between(18, 26));
  }
  if (max_norm(g.direction) < 1) g.direction.x = 1;
  return g;
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
  float score = -std::numeric_limits<float>::infinity();
};

/// One attack: the best of some draws, then a climb through neighbours.
inline Attack draw_attack(Rng& rng, const Plan& plan, int draws, int steps) {
  const bool fused = rng.coin();
  Attack best;
  Genes genes{};
  const auto offer = [&](const Genes& g) {
    const LeafCase c = make_case(g, plan);
    const float reached = score(c, plan, fused);
    if (!(reached >= best.score)) return;
    best = {c, reached};
    genes = g;
  };
  for (int i = 0; i < draws; ++i) offer(draw_genes(rng, plan));
  for (int i = 0; i < steps; ++i) offer(neighbour(rng, plan, genes));
  // Bounds scale: what is near them is so at every size.
  if (rng.coin()) make_smaller(rng.between(1, 26), best.c.ray, best.c.triangles);
  return best;
}

}  // namespace pierce::attack
