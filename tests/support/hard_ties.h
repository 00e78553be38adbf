// SPDX-License-Identifier: Apache-2.0
//
// Cases whose t, u or v lies exactly half way between two floats, or as near to that as can be:
// what the rounding of a hit must get right. The triangle lies across an axis and has legs of a
// power of two, so t, u, v are single differences, which may be one bit longer than the type.
#pragma once

#include <limits>

#include "pierce/types.h"
#include "support/hard_numbers.h"
#include "support/rng.h"

namespace pierce::hard {

/// Fills ray and corners; some numbers may come out infinite.
template <class Real>
void draw_tie(Rng& rng, Ray<Real>& ray, Vec3<Real>& a, Vec3<Real>& b, Vec3<Real>& c) {
  constexpr int kDigits = std::numeric_limits<Real>::digits;
  // Where the exponents lie: mostly about 1, sometimes so low that results are subnormal.
  const int base = rng.one_in(4) ? std::numeric_limits<Real>::min_exponent + rng.between(-3, 30)
                                 : rng.between(-20, 20);
  const auto odd_of_full_length = [&] {
    const auto top = std::uint64_t{1} << (kDigits - 1);
    const auto odd = static_cast<Real>(top | rng.below(top) | 1);
    return std::ldexp(odd, base - kDigits);  // in [2^(base-1), 2^base)
  };
  const auto little = [&] {  // half an ulp of the above, or thereabouts
    const Real half = std::ldexp(Real(rng.coin() ? 1 : -1), base - kDigits - 1);
    return rng.one_in(3) ? nudged(half, rng.between(-1, 1)) : half;
  };
  const std::size_t axis = rng.below(3), side = (axis + 1) % 3, other = (axis + 2) % 3;
  ray.origin = {0, 0, 0};
  ray.direction = {0, 0, 0};
  component(ray.direction, axis) = std::ldexp(Real(rng.coin() ? 1 : -1), rng.between(-2, 2));
  a = {0, 0, 0};
  component(a, axis) = odd_of_full_length();
  component(ray.origin, axis) = little();
  component(ray.origin, side) = odd_of_full_length();
  component(a, side) = little();
  b = c = a;
  component(b, side) = std::ldexp(Real(1), base + rng.between(0, 3));
  // The leg must be a power of two from a, not from 0, for u to be a short number; if it is not,
  // u comes near a tie only by chance, but v and t remain.
  if (rng.coin()) component(b, side) = component(a, side) + component(b, side);
  component(c, other) = std::ldexp(Real(rng.coin() ? 1 : -1), base + 2);
  if (rng.coin()) component(ray.origin, other) = component(c, other) / 8;
  if (rng.one_in(3)) {
    Real& x = component(rng.coin() ? ray.direction : ray.origin, rng.below(3));
    x = nudged(x, rng.between(-1, 1));
  }
}

}  // namespace pierce::hard
