// SPDX-License-Identifier: Apache-2.0
//
// The nearest triangle of a traversal, as far as it is known, and what is still to be traversed.
#pragma once

#include <cstdint>

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

/// A node or a leaf, and how far away it is at least, by any measure.
template <class Number>
struct NearEntry {
  Number distance;
  std::uint32_t ref;
};

/// Pushes an entry; those from `first` on stay in order, the nearest on top.
template <class Number>
void push_nearest_on_top(const NearEntry<Number>& entry, NearEntry<Number>* first,
                         NearEntry<Number>*& top) {
  NearEntry<Number>* at = top++;
  for (; at > first && at[-1].distance < entry.distance; --at) *at = at[-1];
  *at = entry;
}

}  // namespace pierce::kernels
