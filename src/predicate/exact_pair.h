// SPDX-License-Identifier: Apache-2.0
//
// The determinants of one ray and some triangles in integers: chooses the width, then hands the
// numbers to whoever asked.
#pragma once

#include <algorithm>

#include "exact/scaled_integers.h"
#include "predicate/determinants.h"
#include "predicate/settle.h"
#include "predicate/types.h"
#include "support/finite.h"

namespace pierce::predicate {

using exact::compare_scaled;
using exact::sign_of;

/// Determinants with one sign made good (den > 0 unless it is 0) and the powers of two taken out:
///   u = U / den, v = V / den, w = W / den, t = T / den * 2^t_place.
template <class Mixed, class Lengths>
struct ExactPair {
  Determinants<Mixed, Lengths> value;
  int den_sign;  // of N . d
  int t_place;
};

/// The places (powers of two) that the integers count in.
struct Places {
  exact::BitSpan points, direction;

  explicit Places(const RayD& ray) {
    include(points, ray.origin);
    include(direction, ray.direction);
  }
  void include(const TriangleD& triangle) {
    include(points, triangle.a);
    include(points, triangle.b);
    include(points, triangle.c);
  }
  [[nodiscard]] Width width() const {
    const int bits = std::max(points.width(), direction.width());
    if (bits <= exact::kCoordinateBits<1>) return Width::One;
    if (bits <= exact::kCoordinateBits<2>) return Width::Two;
    return bits <= exact::kCoordinateBits<4> ? Width::Four : Width::Any;
  }

 private:
  static void include(exact::BitSpan& span, const Vec3<double>& p) {
    span.include(p.x);
    span.include(p.y);
    span.include(p.z);
  }
};

template <class Integer>
Triple<Integer> scaled_triple(const Vec3<double>& p, int place) {
  return {exact::scaled_integer<Integer>(p.x, place), exact::scaled_integer<Integer>(p.y, place),
          exact::scaled_integer<Integer>(p.z, place)};
}

/// The integers of S, E1, E2 and d.
template <class Integer>
struct ExactParts {
  Triple<Integer> s, e1, e2, d;
  int t_place;
};

template <class Integer>
ExactParts<Integer> exact_parts(const RayD& ray, const TriangleD& triangle, const Places& places) {
  const int point_place = places.points.empty() ? 0 : places.points.low;
  const int direction_place = places.direction.empty() ? 0 : places.direction.low;
  const auto a = scaled_triple<Integer>(triangle.a, point_place);
  return {a - scaled_triple<Integer>(ray.origin, point_place),
          scaled_triple<Integer>(triangle.b, point_place) - a,
          scaled_triple<Integer>(triangle.c, point_place) - a,
          scaled_triple<Integer>(ray.direction, direction_place), point_place - direction_place};
}

template <class Integer>
auto exact_pair(const ExactParts<Integer>& parts) {
  auto value = determinants_of(parts.s, parts.e1, parts.e2, parts.d);
  const int den_sign = sign_of(value.den);
  if (den_sign < 0) value = {-value.den, -value.u, -value.v, -value.w, -value.t};
  using Mixed = decltype(value.den);
  using Lengths = decltype(value.t);
  return ExactPair<Mixed, Lengths>{value, den_sign, parts.t_place};
}

/// Sign of t - bound, for t = T / den 2^t_place. `den` is asked for den, whose sign is `den_sign`.
template <class Number, class Den>
int compare_t(const Number& t, const Den& den, int den_sign, int t_place, double bound) {
  if (is_infinite(bound)) return bound > 0 ? -1 : 1;
  if (bound == 0) return den_sign * sign_of(t);
  // T / den 2^t_place against m 2^e: T 2^(t_place - e) against m den.
  const exact::BinaryParts parts = exact::binary_parts(bound);
  const auto& number = den();
  const auto scaled = number * exact::integer_like(number, parts.significand);
  return den_sign * compare_scaled(t, t_place - parts.exponent, scaled);
}
/// The same of a pair whose den is not 0.
template <class Pair>
int compare_t(const Pair& pair, double bound) {
  const auto den = [&]() -> const auto& { return pair.value.den; };
  return compare_t(pair.value.t, den, 1, pair.t_place, bound);
}

/// Calls `use.operator()<Integer>(places)` with the integers that hold the ray and the triangles,
/// and says how wide they are.
template <class Use, class... Triangles>
Width with_places(const RayD& ray, const Use& use, const Triangles&... triangles) {
  Places places(ray);
  (places.include(triangles), ...);
  const Width width = places.width();
  switch (width) {
    case Width::One:
      use.template operator()<exact::FixedInt<1>>(places);
      break;
    case Width::Two:
      use.template operator()<exact::FixedInt<2>>(places);
      break;
    case Width::Four:
      use.template operator()<exact::FixedInt<4>>(places);
      break;
    case Width::Any:
      use.template operator()<exact::BigInt>(places);
      break;
  }
  return width;
}

}  // namespace pierce::predicate
