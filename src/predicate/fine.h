// SPDX-License-Identifier: Apache-2.0
//
// The determinants in double-double, for about twice the bits of the double rung: what its bounds
// become is in docs/algorithm.md, "Rounding".
#pragma once

#include <cmath>

#include "exact/double_double.h"
#include "predicate/bounds.h"
#include "predicate/filtered.h"
#include "predicate/types.h"

namespace pierce::predicate {

inline Triple<exact::DoubleDouble> exact_difference(const Vec3<double>& p, const Vec3<double>& q) {
  return {exact::two_sum(p.x, -q.x), exact::two_sum(p.y, -q.y), exact::two_sum(p.z, -q.z)};
}

/// Each is within kFiner times the error that `filter_determinants` states, if that is usable.
inline auto fine_determinants(const RayD& ray, const TriangleD& triangle) {
  return determinants_of(exact_difference(triangle.a, ray.origin),
                         exact_difference(triangle.b, triangle.a),
                         exact_difference(triangle.c, triangle.a), triple(ray.direction));
}

/// Their high parts, with bounds on how far these are off: of den and T as they are, of the others
/// as far as their signs go. `rough`, which must be usable, is what double says.
inline Filtered filter_finely(const RayD& ray, const TriangleD& triangle, const Filtered& rough) {
  const auto value = fine_determinants(ray, triangle);
  // The low parts are at most 2^-53 of the high ones, and of the sign they say nothing.
  constexpr double kRoom = 1 + 0x1p-50;
  const auto with_low = [](double err, const exact::DoubleDouble& x) {
    return err * bounds::kFiner * kRoom + 0x1p-52 * std::fabs(x.high);
  };
  Filtered fine;
  fine.value = {value.den.high, value.u.high, value.v.high, value.w.high, value.t.high};
  fine.den_err = with_low(rough.den_err, value.den);
  fine.uv_err = rough.uv_err * bounds::kFiner * kRoom;
  fine.w_err = rough.w_err * bounds::kFiner * kRoom;
  fine.t_err = with_low(rough.t_err, value.t);
  fine.usable = fine.normal_usable = true;
  return fine;
}

}  // namespace pierce::predicate
