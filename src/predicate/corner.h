// SPDX-License-Identifier: Apache-2.0
//
// A line exactly through a corner of a triangle: rays that start at a mesh's own vertices, or aim
// at them. Whatever the numbers, it takes two products to know, and t is one quotient.
#pragma once

#include <cstdint>
#include <optional>

#include "predicate/certify.h"
#include "predicate/filtered.h"
#include "predicate/quotient.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// Where on the ray's line `p` is, if it surely lies there; its t.
std::optional<Quotient> place_on_line(const RayD& ray, const Vec3<double>& p);

/// What is known of a pair whose line surely passes through a corner.
struct CornerHit {
  bool hit;            // whether that is within the ray's range; if not there is no hit
  std::uint8_t zeros;  // the weights of the others
  Interval t;
  Facing facing;
};

/// Nothing if that is not sure, nor that the line crosses the plane. `filtered`: of the pair.
std::optional<CornerHit> meet_corner(const RayD& ray, const TriangleD& triangle,
                                     const Filtered& filtered);

/// t, u, v, w and facing of a hit, correctly rounded, whose `zeros` are those of a corner; nothing
/// if double cannot say.
template <class Real>
std::optional<Hit<Real>> round_at_corner(const RayD& ray, const TriangleD& triangle,
                                         std::uint8_t zeros, const Filtered& filtered);

}  // namespace pierce::predicate
