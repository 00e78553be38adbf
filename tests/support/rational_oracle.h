// SPDX-License-Identifier: Apache-2.0
//
// The definitions of what a hit and a crossing are, over GMP rationals, in the most literal way:
// solve o + t d = w a + u b + v c for (t, u, v) by Gaussian elimination and look at the result.
// Slow on purpose; the quicker oracles are measured against it.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "pierce/types.h"

namespace pierce::oracle {

using Rational = mpq_class;
using RationalVec = std::array<Rational, 3>;

/// mpq_class(double) is exact for every finite double.
template <class Real>
RationalVec rational(const Vec3<Real>& v) {
  return {Rational(static_cast<double>(v.x)), Rational(static_cast<double>(v.y)),
          Rational(static_cast<double>(v.z))};
}

/// Solves the 3x3 system with the given columns. The determinant comes along; if it is zero the
/// solution means nothing.
struct Solution {
  Rational determinant;
  RationalVec values;
};
inline Solution solve(const std::array<RationalVec, 3>& columns, const RationalVec& right) {
  std::array<std::array<Rational, 4>, 3> m;
  for (std::size_t row = 0; row < 3; ++row) {
    m[row] = {columns[0][row], columns[1][row], columns[2][row], right[row]};
  }
  Solution solution{1, {}};
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t pivot = k;
    while (pivot < 3 && m[pivot][k] == 0) ++pivot;
    if (pivot == 3) return {0, {}};
    if (pivot != k) {
      std::swap(m[pivot], m[k]);
      solution.determinant = -solution.determinant;
    }
    solution.determinant *= m[k][k];
    for (std::size_t row = 0; row < 3; ++row) {
      if (row == k || m[row][k] == 0) continue;
      const Rational factor = m[row][k] / m[k][k];
      for (std::size_t column = k; column < 4; ++column) m[row][column] -= factor * m[k][column];
    }
  }
  for (std::size_t k = 0; k < 3; ++k) solution.values[k] = m[k][3] / m[k][k];
  return solution;
}

struct RationalHit {
  Rational t, u, v, w;
  Facing facing;
};

/// Whether t lies in the ray's range; the ends may be infinite.
template <class Real>
bool in_range(const Rational& t, const Ray<Real>& ray, Range range) {
  const auto below = [&](Real bound) {  // -1, 0, 1: t < bound, t = bound, t > bound
    if (std::isinf(bound)) return bound > 0 ? -1 : 1;
    return cmp(t, Rational(static_cast<double>(bound)));
  };
  const int start = below(ray.t_min);
  return (range == Range::OpenStart ? start > 0 : start >= 0) && below(ray.t_max) <= 0;
}

template <class Real>
std::optional<RationalHit> rational_hit(const Ray<Real>& ray, const Vec3<Real>& a_real,
                                        const Vec3<Real>& b_real, const Vec3<Real>& c_real,
                                        Range range = Range::Closed) {
  const RationalVec o = rational(ray.origin), d = rational(ray.direction);
  const RationalVec a = rational(a_real), b = rational(b_real), c = rational(c_real);
  std::array<RationalVec, 3> columns;
  RationalVec right;
  for (std::size_t i = 0; i < 3; ++i) {  // u (b - a) + v (c - a) - t d = o - a
    columns[0][i] = b[i] - a[i];
    columns[1][i] = c[i] - a[i];
    columns[2][i] = -d[i];
    right[i] = o[i] - a[i];
  }
  const Solution solved = solve(columns, right);
  if (solved.determinant == 0) return std::nullopt;  // the determinant is -N . d
  const auto& [u, v, t] = solved.values;
  const Rational w = 1 - u - v;
  if (u < 0 || v < 0 || w < 0 || !in_range(t, ray, range)) return std::nullopt;
  return RationalHit{t, u, v, w, solved.determinant > 0 ? Facing::Front : Facing::Back};
}

}  // namespace pierce::oracle
