// SPDX-License-Identifier: Apache-2.0
//
// What an axis makes simple, exactly and without integers: floors and walls, whose t is a quotient,
// and rays along an axis, whose weights are 2 x 2 determinants.
#pragma once

#include <cstdint>
#include <optional>

#include "predicate/certify.h"
#include "predicate/quotient.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// t where the ray meets the plane of a triangle that stands across an axis along which it moves.
/// Nothing if there is no such axis, or the distance is no double.
std::optional<Quotient> place_across_axis(const RayD& ray, const TriangleD& triangle);

/// The same t, correctly rounded; nothing if double arithmetic cannot say.
template <class Real>
std::optional<Real> round_across_axis(const RayD& ray, const TriangleD& triangle);

/// Of a ray that moves along one axis alone.
struct AlongAxis {
  int u, v, w;  // signs of the determinants
  Interval t;   // if they all have that of den, or are 0, the t of the hit is within this

  /// The sign of den, which is their sum; 0 if they disagree or are all 0: then there is no hit.
  [[nodiscard]] int den() const {
    if (u >= 0 && v >= 0 && w >= 0) return u + v + w > 0 ? 1 : 0;
    return u <= 0 && v <= 0 && w <= 0 ? -1 : 0;
  }
};
/// Nothing if it does not, or the distances of the corners across that axis are no doubles.
std::optional<AlongAxis> look_along_axis(const RayD& ray, const TriangleD& triangle);

/// Sets those of u, v and w of such a ray's hit that are `wanted` (kNumberU ...), correctly
/// rounded; returns which of them it did set. However small they are, they cost no integers.
std::uint8_t round_along_axis(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                              Hit<double>& hit);

}  // namespace pierce::predicate
