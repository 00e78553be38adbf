// SPDX-License-Identifier: Apache-2.0
//
// The determinants in double, with bounds on their errors. Each bound is a constant times a product
// of the operands' largest magnitudes; the constants are derived in docs/algorithm.md ("The double
// rung") from the number of roundings on the longest way through determinants.h. Inline: every hit
// is rounded from these numbers.
#pragma once

#include <algorithm>
#include <cmath>

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
};

inline double max_norm(const Triple<double>& p) {
  return std::max(std::max(std::fabs(p.x), std::fabs(p.y)), std::fabs(p.z));
}

inline Triple<double> triple(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

inline Filtered filter_determinants(const RayD& ray, const TriangleD& triangle) {
  const Triple<double> a = triple(triangle.a);
  const Triple<double> s = a - triple(ray.origin);
  const Triple<double> e1 = triple(triangle.b) - a;
  const Triple<double> e2 = triple(triangle.c) - a;
  const Triple<double> d = triple(ray.direction);
  const double s_max = max_norm(s);
  const double e1_max = max_norm(e1);
  const double e2_max = max_norm(e2);
  const double d_max = max_norm(d);

  Filtered f;
  f.value = determinants_of(s, e1, e2, d);
  f.usable =
      std::min(std::min(s_max, e1_max), std::min(e2_max, d_max)) >= bounds::kSmallestMagnitude &&
      std::max(std::max(s_max, e1_max), std::max(e2_max, d_max)) <= bounds::kLargestMagnitude;
  const double e12 = e1_max * e2_max;
  f.den_err = bounds::kDenFactor * (e12 * d_max);
  f.uv_err = bounds::kUvFactor * (d_max * s_max * std::max(e1_max, e2_max));
  f.t_err = bounds::kTFactor * (e12 * s_max);
  // W = (den - U) - V: the errors of its parts, and two roundings of at most |den| + |U| + |V|
  // each.
  const double parts = std::fabs(f.value.den) + std::fabs(f.value.u) + std::fabs(f.value.v);
  f.w_err =
      (f.den_err + 2 * f.uv_err + 2 * bounds::kDoubleUlp * parts) * (1 + 8 * bounds::kDoubleUlp);
  return f;
}

}  // namespace pierce::predicate
