// SPDX-License-Identifier: Apache-2.0
//
// Winding numbers of surfaces that need not be closed: what is answered, and what may be asked for.
#pragma once

#include "pierce/options.h"

namespace pierce {

/// How often the surface winds around a point: the sum of the solid angles of all triangles as seen
/// from there, each positive where its back faces the point, divided by 4 pi. Around a closed
/// surface it is a whole number; around one with holes it is nearly one except near the holes. A
/// triangle whose plane holds the point counts 0, also one that holds the point itself (the mean of
/// its two sides).
struct WindingNumber {
  double value = 0;
  double error = 0;  ///< the true number is no farther than this from `value`

  friend bool operator==(const WindingNumber&, const WindingNumber&) = default;
};

/// For one point or a batch of them.
struct WindingOptions {
  /// How large an error may be, 0 or more. One that double arithmetic cannot keep (about 1e-15
  /// times the number of open edges near by) is come as near to as it can: see the error returned.
  double tolerance = 1e-6;
  WorkOptions work = {};  ///< points count as rays in its statistics
};

}  // namespace pierce
