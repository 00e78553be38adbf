// SPDX-License-Identifier: Apache-2.0
//
// The nearest point by its definition, over GMP rationals: of every corner, every foot on the
// inside of an edge and every foot on the inside of a face, the one at the least squared distance.
// All triangles, no tree, no cleverness, nothing shared with the library.
#pragma once

#include <gmpxx.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "pierce/nearest.h"
#include "support/rational_oracle.h"
#include "support/rounding.h"

namespace pierce::oracle {

struct RationalNearest {
  Rational squared;
  RationalVec weights;  // of a, b, c
  Feature feature;
};

inline Rational dot(const RationalVec& p, const RationalVec& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
inline RationalVec minus(const RationalVec& p, const RationalVec& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

/// Of one triangle. Candidates are tried in the order of Feature, and a later one has to be better.
inline RationalNearest nearest_on_triangle(const RationalVec& p,
                                           const std::array<RationalVec, 3>& corner) {
  std::optional<RationalNearest> best;
  const auto offer = [&](const RationalVec& weights, Feature feature) {
    RationalVec x;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = weights[0] * corner[0][i] + weights[1] * corner[1][i] + weights[2] * corner[2][i];
    }
    const RationalVec away = minus(p, x);
    const Rational squared = dot(away, away);
    if (!best || squared < best->squared) best = {squared, weights, feature};
  };
  for (std::size_t i = 0; i < 3; ++i) {
    RationalVec weights{0, 0, 0};
    weights[i] = 1;
    offer(weights, static_cast<Feature>(i));
  }
  for (std::size_t i = 0; i < 3; ++i) {  // ab, bc, ca
    const std::size_t j = (i + 1) % 3;
    const RationalVec along = minus(corner[j], corner[i]);
    const Rational length = dot(along, along);
    if (length == 0) continue;
    const Rational t = dot(minus(p, corner[i]), along) / length;
    if (t <= 0 || t >= 1) continue;
    RationalVec weights{0, 0, 0};
    weights[i] = 1 - t;
    weights[j] = t;
    offer(weights, static_cast<Feature>(3 + i));
  }
  // p = a + u (b - a) + v (c - a) + h N
  const RationalVec e = minus(corner[1], corner[0]), f = minus(corner[2], corner[0]);
  const RationalVec n{e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2],
                      e[0] * f[1] - e[1] * f[0]};
  const Solution solved = solve({e, f, n}, minus(p, corner[0]));
  const Rational& u = solved.values[0];
  const Rational& v = solved.values[1];
  if (solved.determinant != 0 && u > 0 && v > 0 && u + v < 1)
    offer({1 - u - v, u, v}, Feature::Face);
  return *best;
}

/// The square root of a rational, rounded once: a guess, put right by comparing with the squares of
/// the points half way between neighbours.
template <class Real>
Real round_square_root(const Rational& square) {
  using Limits = std::numeric_limits<Real>;
  if (square == 0) return 0;
  mpf_class fine(square, 4000);
  fine = sqrt(fine);
  const Real largest = Limits::max();
  Real guess = fine >= static_cast<double>(largest) ? largest : static_cast<Real>(fine.get_d());
  const auto exact = [](Real x) { return Rational(static_cast<double>(x)); };
  // Compares the root with the point half way between x and the next Real above.
  const auto against_half = [&](Real x) {
    const Rational step = x == largest ? Rational(exact(x) - exact(std::nextafter(x, Real(0))))
                                       : Rational(exact(std::nextafter(x, largest)) - exact(x));
    const Rational half = exact(x) + step / 2;
    return cmp(square, Rational(half * half));
  };
  const auto even = [](Real x) {
    int exponent = 0;
    const Real fraction = std::frexp(x, &exponent);
    const int digits = std::min(Limits::digits, exponent - Limits::min_exponent + Limits::digits);
    return std::fmod(std::ldexp(fraction, digits), Real(2)) == 0;
  };
  while (guess > 0) {  // too high?
    const Real below = std::nextafter(guess, Real(0));
    const int side = against_half(below);
    if (side > 0 || (side == 0 && even(guess))) break;
    guess = below;
  }
  for (;;) {  // too low?
    const int side = against_half(guess);
    if (side < 0 || (side == 0 && even(guess))) return guess;
    if (guess == largest) return Limits::infinity();
    guess = std::nextafter(guess, largest);
  }
}

/// Of all triangles; a default one if none is within the radius.
template <class Real>
NearestPoint<Real> nearest_point(std::span<const MeshView<Real>> meshes, const Vec3<Real>& point,
                                 Real radius = kInfinity<Real>) {
  const RationalVec p = rational(point);
  NearestPoint<Real> result;
  std::optional<RationalNearest> best;
  std::array<RationalVec, 3> best_corners;
  for (std::uint32_t g = 0; g < meshes.size(); ++g) {
    for (std::uint32_t i = 0; i < meshes[g].triangles.size(); ++i) {
      const Triangle& t = meshes[g].triangles[i];
      const std::array<RationalVec, 3> corners{rational(meshes[g].vertices[t[0]]),
                                               rational(meshes[g].vertices[t[1]]),
                                               rational(meshes[g].vertices[t[2]])};
      const RationalNearest found = nearest_on_triangle(p, corners);
      if (best && best->squared <= found.squared) continue;
      best = found;
      best_corners = corners;
      result.geometry = g;
      result.triangle = i;
    }
  }
  if (!best) return {};
  if (!std::isinf(radius)) {
    const Rational limit(static_cast<double>(radius));
    if (best->squared > limit * limit) return {};
  }
  result.feature = best->feature;
  result.distance = round_square_root<Real>(best->squared);
  result.w = round_rational<Real>(best->weights[0]);
  result.u = round_rational<Real>(best->weights[1]);
  result.v = round_rational<Real>(best->weights[2]);
  const auto along = [&](std::size_t axis) {
    return round_rational<Real>(best->weights[0] * best_corners[0][axis] +
                                best->weights[1] * best_corners[1][axis] +
                                best->weights[2] * best_corners[2][axis]);
  };
  result.point = {along(0), along(1), along(2)};
  return result;
}

}  // namespace pierce::oracle
