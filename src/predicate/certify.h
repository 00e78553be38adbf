// SPDX-License-Identifier: Apache-2.0
//
// The double rung: the determinants in double, with bounds on their errors. Says yes, no or unsure.
//
// Every bound is a constant times a product of the operands' largest magnitudes; the constants are
// derived in docs/algorithm.md ("The double rung") from the number of roundings on the longest way
// through determinants.h, and are attacked by tests/unit/certify_bounds_test.cpp.
#pragma once

#include "predicate/filtered.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// An interval that holds a real number for sure; empty of meaning (-inf, inf) when nothing is
/// known.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// Whether the ray hits the triangle within its range.
Certified certify_hit(const Filtered& filtered, const RayD& ray);

/// The t of a pair whose den is surely not zero; (-inf, inf) if that is not sure.
Interval t_interval(const Filtered& filtered);

}  // namespace pierce::predicate
