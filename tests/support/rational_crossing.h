// SPDX-License-Identifier: Apache-2.0
//
// The definition of a crossing over GMP rationals: the ray's origin becomes o + (e, e^2, e^3) and
// the linear system of a hit is solved with that right-hand side. t, u, v, w then are polynomials
// in e whose sign, for e -> 0, is that of the first coefficient that is not zero.
#pragma once

#include <array>

#include "support/rational_oracle.h"

namespace pierce::oracle {

using InfinitesimalRational = std::array<Rational, 4>;  // x0 + x1 e + x2 e^2 + x3 e^3

inline int sign_of(const InfinitesimalRational& x) {
  for (const Rational& coefficient : x) {
    if (coefficient != 0) return sgn(coefficient);
  }
  return 0;
}

/// How the shifted ray passes through the triangle: +1 leaving (N . d > 0), -1 entering, 0 not.
template <class Real>
int rational_passage(const Ray<Real>& ray, const Vec3<Real>& a_real, const Vec3<Real>& b_real,
                     const Vec3<Real>& c_real) {
  const RationalVec o = rational(ray.origin), d = rational(ray.direction);
  const RationalVec a = rational(a_real), b = rational(b_real), c = rational(c_real);
  std::array<RationalVec, 3> columns;
  std::array<RationalVec, 4> right;  // one right-hand side for each power of e
  for (std::size_t i = 0; i < 3; ++i) {
    columns[0][i] = b[i] - a[i];
    columns[1][i] = c[i] - a[i];
    columns[2][i] = -d[i];
    right[0][i] = o[i] - a[i];
    for (std::size_t power = 1; power < 4; ++power) right[power][i] = power == i + 1 ? 1 : 0;
  }
  InfinitesimalRational u, v, w, t;
  Rational determinant;
  for (std::size_t power = 0; power < 4; ++power) {
    const Solution solved = solve(columns, right[power]);
    if (solved.determinant == 0) return 0;
    determinant = solved.determinant;
    u[power] = solved.values[0];
    v[power] = solved.values[1];
    t[power] = solved.values[2];
    w[power] = (power == 0 ? 1 : 0) - u[power] - v[power];
  }
  if (sign_of(u) < 0 || sign_of(v) < 0 || sign_of(w) < 0) return 0;
  const auto side_of = [&](Real bound) {  // the sign of t - bound
    if (std::isinf(bound)) return bound > 0 ? -1 : 1;
    InfinitesimalRational difference = t;
    difference[0] -= Rational(static_cast<double>(bound));
    return sign_of(difference);
  };
  if (side_of(ray.t_min) < 0 || side_of(ray.t_max) > 0) return 0;
  return determinant < 0 ? 1 : -1;  // the determinant is -N . d
}

}  // namespace pierce::oracle
