// SPDX-License-Identifier: Apache-2.0
//
// Doubles of any number of bits, for what has to be right whatever numbers look like.
#pragma once

#include <cmath>

#include "pierce/types.h"
#include "support/rng.h"

namespace pierce::hard {

/// Of few bits or of many, and seldom of an extreme size.
inline double number(Rng& rng) {
  if (rng.one_in(12)) return rng.coin() ? 0.0 : -0.0;
  const int places = rng.one_in(3) ? rng.between(1, 12) : 52;
  const double x = std::ldexp(std::round(std::ldexp(rng.symmetric(), places)), -places);
  if (rng.one_in(40)) return std::ldexp(x, rng.between(-1060, 1000));
  return rng.one_in(6) ? std::ldexp(x, rng.between(-60, 60)) : x;
}
inline Vec3<double> point(Rng& rng) { return {number(rng), number(rng), number(rng)}; }

/// The next double on either side.
inline double neighbour(double x, Rng& rng) {
  return std::nextafter(x, rng.coin() ? kInfinity<double> : -kInfinity<double>);
}

}  // namespace pierce::hard
