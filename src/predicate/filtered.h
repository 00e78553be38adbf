// SPDX-License-Identifier: Apache-2.0
//
// The determinants in double, with bounds on their errors. Each bound is a constant times a product
// of the operands' largest magnitudes; the constants are derived in docs/algorithm.md ("The double
// rung") from the number of roundings on the longest way through determinants.h. Inline: every hit
// is rounded from these numbers.
//
// They are taken two at a time: (E1, d) x (E2, S) is (N, R), and its scalar products with the same
// vectors, turned round, are (den, V) and (T, -U).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "predicate/bounds.h"
#include "predicate/determinants.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// The determinants in double; each is within its `_err` of the true one. When `usable` is false
/// (a magnitude outside [2^-150, 2^150], or zero) nothing may be concluded from the rest.
struct Filtered {
  Determinants<double, double> value;
  double den_err, uv_err, w_err, t_err;
  bool usable;
  bool normal_usable;  // so far as E1, E2 and d go: den may be concluded from
};

/// Two doubles side by side; every operation is done on each, and rounds as it would alone.
using Twin = double __attribute__((vector_size(16)));

inline Twin larger(Twin p, Twin q) { return p < q ? q : p; }
inline Twin smaller(Twin p, Twin q) { return q < p ? q : p; }
inline Twin absolute(Twin p) {
  using Bits = std::int64_t __attribute__((vector_size(16)));
  constexpr std::int64_t kAllButSign = std::numeric_limits<std::int64_t>::max();
  return reinterpret_cast<Twin>(reinterpret_cast<Bits>(p) & Bits{kAllButSign, kAllButSign});
}

inline Twin turned(Twin p) { return Twin{p[1], p[0]}; }
inline Triple<Twin> turned(const Triple<Twin>& p) {
  return {turned(p.x), turned(p.y), turned(p.z)};
}

inline Triple<Twin> beside(const Vec3<double>& p, const Vec3<double>& q) {
  return {Twin{p.x, q.x}, Twin{p.y, q.y}, Twin{p.z, q.z}};
}

inline Twin max_norms(const Triple<Twin>& p) {
  return larger(larger(absolute(p.x), absolute(p.y)), absolute(p.z));
}

inline Triple<double> triple(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

inline Filtered filter_determinants(const RayD& ray, const TriangleD& triangle) {
  const Triple<Twin> e1_d = beside(triangle.b, ray.direction) - beside(triangle.a, {0, 0, 0});
  const Triple<Twin> e2_s = beside(triangle.c, triangle.a) - beside(triangle.a, ray.origin);

  const Triple<Twin> n_r = cross(e1_d, e2_s);
  const Twin den_v = dot(n_r, turned(e1_d));
  const Twin t_u = dot(n_r, turned(e2_s));
  const double den = den_v[0];
  const double v = den_v[1];
  const double u = -t_u[1];

  const Twin e1_d_max = max_norms(e1_d);
  const Twin e2_s_max = max_norms(e2_s);
  const Twin least = smaller(e1_d_max, e2_s_max);
  const Twin most = larger(e1_d_max, e2_s_max);
  Filtered f;
  f.value = {den, u, v, den - u - v, t_u[0]};
  f.usable = std::min(least[0], least[1]) >= bounds::kSmallestMagnitude &&
             std::max(most[0], most[1]) <= bounds::kLargestMagnitude;
  f.normal_usable = std::min(least[0], e1_d_max[1]) >= bounds::kSmallestMagnitude &&
                    std::max(most[0], e1_d_max[1]) <= bounds::kLargestMagnitude;
  const Twin products = e1_d_max * e2_s_max;  // |E1| |E2| and |d| |S|
  const Twin cubes = products * Twin{e1_d_max[1], most[0]};
  f.den_err = bounds::kDenFactor * cubes[0];
  f.uv_err = bounds::kUvFactor * cubes[1];
  f.t_err = bounds::kTFactor * (products[0] * e2_s_max[1]);
  const double parts = std::fabs(den) + std::fabs(u) + std::fabs(v);
  f.w_err = f.den_err + 2 * f.uv_err + bounds::kWFactor * parts;
  return f;
}

}  // namespace pierce::predicate
