// SPDX-License-Identifier: Apache-2.0
//
// Correct rounding of a hit without exact arithmetic, where that is certain: the numbers are
// computed with more bits than asked for, and taken if their whole error interval rounds to one
// value.
#pragma once

#include <cstdint>

#include "predicate/filtered.h"
#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// Says which numbers of `result` (kNumberT ..., settle.h) are certainly the correctly rounded
/// ones, of t, u, v and w; the others are unspecified, and facing, if there are none. `zeros`:
/// weights known to be exactly zero. Those to float are computed in double, those to double in
/// double-double.
std::uint8_t round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                             std::uint8_t zeros, Hit<float>& result);
std::uint8_t round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                             std::uint8_t zeros, Hit<double>& result);

/// Of correctly rounded doubles, the floats that the exact numbers round to; false if that is not
/// certain: one of them lies on a border between two floats, or next to one.
bool round_again(const Hit<double>& finer, Hit<float>& result);

/// t, u, v, w and facing of a hit, correctly rounded to Real. The triangle is surely hit; `zeros`:
/// weights known to be exactly zero.
template <class Real>
Hit<Real> round_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                    LadderCounts& counts);

/// The same of a hit each of whose numbers is known to lie in an interval whose lower end rounds to
/// what stands in `low`, and its upper end to that of `high`: makes `low` the correctly rounded
/// numbers. Its facing is known, and so are weights that are `zeros`.
template <class Real>
void round_bounded_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                       const Hit<Real>& high, Hit<Real>& low, LadderCounts& counts);

extern template void round_bounded_hit<float>(const RayD&, const TriangleD&, std::uint8_t,
                                              const Hit<float>&, Hit<float>&, LadderCounts&);
extern template void round_bounded_hit<double>(const RayD&, const TriangleD&, std::uint8_t,
                                               const Hit<double>&, Hit<double>&, LadderCounts&);
extern template Hit<float> round_hit<float>(const RayD&, const TriangleD&, std::uint8_t,
                                            LadderCounts&);
extern template Hit<double> round_hit<double>(const RayD&, const TriangleD&, std::uint8_t,
                                              LadderCounts&);

}  // namespace pierce::predicate
