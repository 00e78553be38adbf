// SPDX-License-Identifier: Apache-2.0
//
// One ray and one triangle, drawn mostly at the hard places: rays through vertices, edge points
// and face points computed exactly, rounded to the type and then moved by 0, 1 or 2 ulp; grazing
// and coplanar rays; slivers, needles and degenerate triangles; every magnitude; t ranges that end
// exactly at the hit or one ulp beside it; signed zeros.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "pierce/types.h"
#include "support/hard_numbers.h"
#include "support/hard_ties.h"
#include "support/quick_oracle.h"
#include "support/rng.h"

namespace pierce::hard {

template <class Real>
struct Case {
  Ray<Real> ray;
  Vec3<Real> a, b, c;
  Range range = Range::Closed;
};

/// The exact point (i a + j b + k c) / 2^bits rounded to the type (infinite on overflow).
template <class Real>
Vec3<Real> rounded_point(const oracle::DyadicVec& p) {
  return {oracle::round_dyadic<Real>(p.x), oracle::round_dyadic<Real>(p.y),
          oracle::round_dyadic<Real>(p.z)};
}

namespace detail {

template <class Real>
void draw_triangle(Rng& rng, Style style, Case<Real>& hard) {
  hard.a = vec<Real>(rng, style);
  hard.b = vec<Real>(rng, style);
  hard.c = vec<Real>(rng, style);
  const auto near = [&](const Vec3<Real>& p) {
    Vec3<Real> q = p;
    Real& x = component(q, rng.below(3));
    x = nudged(x, rng.between(-2, 2));
    return q;
  };
  switch (rng.below(12)) {
    case 0: {  // all in one coordinate plane
      const std::size_t axis = rng.below(3);
      component(hard.b, axis) = component(hard.c, axis) = component(hard.a, axis);
      break;
    }
    case 1: {  // right-angled along the axes
      hard.b = hard.c = hard.a;
      const std::size_t axis = rng.below(3);
      component(hard.b, axis) = number<Real>(rng, style);
      component(hard.c, (axis + 1) % 3) = number<Real>(rng, style);
      break;
    }
    case 2:  // a needle: two corners all but coincide
      hard.c = near(hard.b);
      break;
    case 3: {  // a sliver, or exactly degenerate: c on the line ab but for an ulp
      const auto a = oracle::exact(hard.a), b = oracle::exact(hard.b);
      const oracle::Dyadic k(mpz_class(rng.between(-8, 16)), -3);
      const auto c = rounded_point<Real>(a + k * (b - a));
      if (is_finite(c)) hard.c = rng.coin() ? near(c) : c;
      break;
    }
    case 4:  // as small as can be
      hard.b = near(hard.a);
      hard.c = near(hard.a);
      break;
    case 5:  // a corner at the origin
      hard.a = {0, 0, 0};
      break;
    default:
      break;
  }
}

/// A point of a feature (vertex, edge, face) or just outside: exact.
template <class Real>
oracle::DyadicVec draw_target(Rng& rng, const Case<Real>& hard) {
  using oracle::Dyadic;
  const int bits = rng.coin() ? rng.between(0, 3) : rng.between(4, 20);
  const int whole = 1 << bits;
  int j = rng.between(0, whole), k = rng.between(0, whole - j);
  switch (rng.below(8)) {
    case 0:
    case 1:  // a vertex
      j = rng.coin() ? 0 : whole;
      k = j == 0 && rng.coin() ? whole : 0;
      break;
    case 2:
      j = 0;  // on edge ca
      break;
    case 3:
      k = 0;  // on edge ab
      break;
    case 4:
      k = whole - j;  // on edge bc
      break;
    case 5:  // outside, on the line through an edge or anywhere
      j = rng.between(-whole, 2 * whole);
      k = rng.coin() ? 0 : rng.between(-whole, 2 * whole);
      break;
    default:
      break;
  }
  const auto weight = [&](int n) { return Dyadic(mpz_class(n), -bits); };
  return weight(whole - j - k) * oracle::exact(hard.a) + weight(j) * oracle::exact(hard.b) +
         weight(k) * oracle::exact(hard.c);
}

template <class Real>
Vec3<Real> draw_direction(Rng& rng, Style style, const Case<Real>& hard) {
  using oracle::exact;
  switch (rng.below(8)) {
    case 0: {  // along an axis
      Vec3<Real> d{0, 0, 0};
      component(d, rng.below(3)) = rng.coin() ? Real(1) : number<Real>(rng, style);
      return d;
    }
    case 1: {  // in a coordinate plane
      Vec3<Real> d = vec<Real>(rng, rng.coin() ? style : Style::SmallInteger);
      component(d, rng.below(3)) = 0;
      return d;
    }
    case 2: {  // in the triangle's plane, up to rounding
      const oracle::Dyadic j(rng.between(-3, 3)), k(rng.between(-3, 3));
      return rounded_point<Real>(j * (exact(hard.b) - exact(hard.a)) +
                                 k * (exact(hard.c) - exact(hard.a)));
    }
    case 3:
      return vec<Real>(rng, Style::SmallInteger);
    case 4: {  // all but along an axis: the other components vanish beside it
      Vec3<Real> d = vec<Real>(rng, rng.coin() ? Style::Unit : Style::SmallInteger);
      const std::size_t axis = rng.below(3);
      for (std::size_t i = 1; i < 3; ++i) {
        Real& x = component(d, (axis + i) % 3);
        x = std::ldexp(x, -rng.between(20, 140));
      }
      return d;
    }
    default:
      return vec<Real>(rng, style);
  }
}

template <class Real>
void draw_ray(Rng& rng, Style style, Case<Real>& hard) {
  using oracle::Dyadic;
  const auto target = draw_target(rng, hard);
  const Style ray_style = rng.one_in(8) ? rng.pick(kAllStyles) : style;
  switch (rng.below(5)) {
    case 0:  // no aim at all
      hard.ray.origin = vec<Real>(rng, ray_style);
      hard.ray.direction = vec<Real>(rng, ray_style);
      break;
    case 1: {  // the origin on the target itself or t = 0 all but
      hard.ray.origin = rounded_point<Real>(target);
      hard.ray.direction = draw_direction(rng, ray_style, hard);
      break;
    }
    case 2: {  // direction = (target - origin) / 2^k
      hard.ray.origin = vec<Real>(rng, ray_style);
      const Dyadic scale(mpz_class(1), rng.coin() ? 0 : -rng.between(-4, 4));
      hard.ray.direction = rounded_point<Real>(scale * (target - oracle::exact(hard.ray.origin)));
      break;
    }
    default: {  // origin = target - t direction, near or far
      hard.ray.direction = draw_direction(rng, ray_style, hard);
      if (!is_finite(hard.ray.direction)) break;
      const int far = rng.one_in(4) ? rng.between(-60, 100) : rng.between(-2, 4);
      const Dyadic t(mpz_class(rng.one_in(3) ? -rng.between(0, 9) : rng.between(1, 9)), far);
      hard.ray.origin = rounded_point<Real>(target - t * oracle::exact(hard.ray.direction));
    }
  }
  for (int nudges = rng.coin() ? 0 : rng.between(1, 3); nudges > 0; --nudges) {
    Vec3<Real>& v = rng.coin() ? hard.ray.origin : hard.ray.direction;
    Real& x = component(v, rng.below(3));
    x = nudged(x, rng.between(-2, 2));
  }
}

template <class Real>
void draw_range(Rng& rng, Case<Real>& hard) {
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  if (rng.one_in(4)) hard.range = Range::OpenStart;
  Ray<Real>& ray = hard.ray;
  switch (rng.below(10)) {
    case 0:
    case 1:
      ray.t_min = -kInf;
      break;
    case 2:
      ray.t_min = number<Real>(rng, rng.pick(kAllStyles));
      ray.t_max = number<Real>(rng, rng.pick(kAllStyles));
      break;
    case 3:
    case 4:
    case 5: {  // an end at the hit, to the ulp
      const oracle::LineAndTriangle pair(ray, hard.a, hard.b, hard.c);
      ray.t_min = -kInf;
      const auto hit = pair.hit(ray, Range::Closed);
      if (!hit) break;
      Real t = oracle::round_ratio<Real>(hit->t_num, hit->den);
      if (rng.coin()) t = nudged(t, rng.between(-2, 2));
      (rng.coin() ? ray.t_min : ray.t_max) = t;
      break;
    }
    default:
      break;
  }
}

}  // namespace detail

/// A case of any style; the ray is valid, the corners are finite.
template <class Real>
Case<Real> hard_case(Rng& rng) {
  for (;;) {
    Case<Real> hard;
    const Style style = rng.coin() ? rng.pick(kTameStyles) : rng.pick(kAllStyles);
    if (rng.one_in(12)) {
      draw_tie(rng, hard.ray, hard.a, hard.b, hard.c);
    } else {
      detail::draw_triangle(rng, style, hard);
      detail::draw_ray(rng, style, hard);
    }
    if (!is_valid(hard.ray)) continue;
    if (rng.one_in(4)) {  // the same shape elsewhere on the scale
      const int reach = rng.coin() ? 40 : std::numeric_limits<Real>::max_exponent;
      const int up = rng.between(-reach, reach), along = rng.between(-reach, reach);
      const auto scale = [](Vec3<Real>& v, int by) {
        v = {std::ldexp(v.x, by), std::ldexp(v.y, by), std::ldexp(v.z, by)};
      };
      for (Vec3<Real>* v : {&hard.a, &hard.b, &hard.c, &hard.ray.origin}) scale(*v, up);
      scale(hard.ray.direction, along);
    }
    if (!is_valid(hard.ray) || !is_finite(hard.a) || !is_finite(hard.b) || !is_finite(hard.c)) {
      continue;
    }
    detail::draw_range(rng, hard);
    if (rng.one_in(4)) {  // the sign of zero means nothing
      for (Vec3<Real>* v : {&hard.a, &hard.b, &hard.c, &hard.ray.origin, &hard.ray.direction}) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (component(*v, axis) == 0 && rng.coin()) component(*v, axis) = Real(-0.0);
        }
      }
      if (hard.ray.t_min == 0) hard.ray.t_min = Real(-0.0);
    }
    return hard;
  }
}

}  // namespace pierce::hard
