// SPDX-License-Identifier: Apache-2.0
//
// Which of two neighbouring numbers is nearer to a number of a hit: what is left to ask where the
// rounding was not certain. Ties are frequent where coordinates are round, so this is for the
// numbers that fit into one word each; whatever does not is left to the exact rung.
#pragma once

#include <cstdint>

#include "predicate/types.h"

namespace pierce::predicate {

/// `low` and `high` are what both ends of an interval that holds a number of this hit round to; a
/// bit of `wanted` (kNumberT ..., settle.h) each. Of those that it can decide, sets `low` to the
/// correctly rounded number, and returns the bits. `low.facing` is that of the hit.
template <class Real>
std::uint8_t round_between(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                           const Hit<Real>& high, Hit<Real>& low);

extern template std::uint8_t round_between<float>(const RayD&, const TriangleD&, std::uint8_t,
                                                  const Hit<float>&, Hit<float>&);
extern template std::uint8_t round_between<double>(const RayD&, const TriangleD&, std::uint8_t,
                                                   const Hit<double>&, Hit<double>&);

}  // namespace pierce::predicate
