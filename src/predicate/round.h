// SPDX-License-Identifier: Apache-2.0
//
// Correct rounding of a hit without exact arithmetic, where that is certain: the numbers are
// computed with more bits than asked for, and taken if their whole error interval rounds to one
// value.
#pragma once

#include <cstdint>

#include "predicate/certify.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// Fills t, u, v, w and facing of `result` and returns true if each is certainly the correctly
/// rounded one; otherwise returns false and `result` is unspecified. `zeros`: weights known to be
/// exactly zero. Float scenes compute in double, double scenes in double-double.
bool round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                     std::uint8_t zeros, Hit<float>& result);
bool round_certified(const RayD& ray, const TriangleD& triangle, const Filtered& filtered,
                     std::uint8_t zeros, Hit<double>& result);

}  // namespace pierce::predicate
