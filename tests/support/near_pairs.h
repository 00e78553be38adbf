// SPDX-License-Identifier: Apache-2.0
//
// Pairs of which double knows little: rays that start on a triangle, meet it on an edge, or lie in
// its plane, but for what rounding leaves.
#pragma once

#include <cmath>

#include "predicate/types.h"
#include "support/rng.h"

namespace pierce::hard {

struct NearPair {
  predicate::RayD ray;
  predicate::TriangleD triangle;
};

inline Vec3<double> weighted(const predicate::TriangleD& t, double u, double v) {
  const double w = 1 - u - v;
  return {w * t.a.x + u * t.b.x + v * t.c.x, w * t.a.y + u * t.b.y + v * t.c.y,
          w * t.a.z + u * t.b.z + v * t.c.z};
}

// A triangle of numbers of up to 53 bits, and a ray that starts on it, or meets it on an edge, or
// lies in its plane, but for what rounding leaves.
inline NearPair nearly(Rng& rng) {
  const int bits = rng.between(4, 53);
  const auto number = [&] {
    return std::ldexp(std::floor(std::ldexp(rng.symmetric(), bits)), -bits);
  };
  const auto point = [&] { return Vec3<double>{number(), number(), number()}; };
  const double size = std::ldexp(1, -rng.between(0, 20));
  const auto beside = [&](const Vec3<double>& p) {
    return Vec3<double>{p.x + size * number(), p.y + size * number(), p.z + size * number()};
  };
  NearPair pair;
  predicate::TriangleD& t = pair.triangle;
  t.a = point();
  t.b = beside(t.a);
  t.c = beside(t.a);
  const double u = rng.unit(), v = rng.coin() ? 0 : (1 - u) * rng.unit();
  const Vec3<double> at = weighted(t, rng.coin() ? u : 0.5, rng.coin() ? v : 0.25);
  pair.ray = {point(), point()};
  const int kind = rng.between(0, 3);
  if (kind == 0) pair.ray.origin = at;
  const auto towards = [&](const Vec3<double>& p) {
    const Vec3<double>& o = pair.ray.origin;
    return Vec3<double>{p.x - o.x, p.y - o.y, p.z - o.z};
  };
  if (kind == 1) pair.ray.direction = towards(at);
  if (kind == 2) pair.ray.origin = at, pair.ray.direction = towards(weighted(t, 0.5, 0.25));
  if (kind == 3) pair.ray.origin = beside(at), pair.ray.direction = towards(at);
  pair.ray.open_start = rng.coin();
  if (rng.one_in(4)) pair.ray.t_max = rng.coin() ? 1 : std::ldexp(1, -rng.between(40, 70));
  if (rng.one_in(8)) pair.ray.t_min = std::ldexp(rng.symmetric(), -rng.between(20, 60));
  return pair;
}

}  // namespace pierce::hard
