// SPDX-License-Identifier: Apache-2.0
//
// The nearest triangle of a traversal, as far as it is known.
#pragma once

#include "kernels/points/nearest.h"

namespace pierce::kernels {

/// Between what a distance surely lies. NaN bounds say nothing.
template <class Number>
struct DistanceBounds {
  Number low, high;
};

template <class Number>
struct NearestSoFar {
  Candidate triangle;
  DistanceBounds<Number> distance{};
  Number limit;  // nothing farther matters any more

  void offer(const Candidate& candidate, const DistanceBounds<Number>& bounds,
             NearestResolver& resolver) {
    if (triangle.primitive != kNone) {
      if (bounds.low > distance.high || candidate.primitive == triangle.primitive) return;
      if (!(bounds.high < distance.low) && !resolver.is_nearer(candidate, triangle)) {
        // Farther, or equally near: so the true distance to beat is no larger than this.
        if (bounds.high < limit) limit = bounds.high;
        return;
      }
    }
    triangle = candidate;
    distance = bounds;
    if (bounds.high < limit) limit = bounds.high;
  }
};

}  // namespace pierce::kernels
