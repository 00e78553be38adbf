// SPDX-License-Identifier: Apache-2.0
//
// The ladder for one ray and one triangle: double first, exact where double is unsure. Everything
// the scenes answer goes through these functions; they never fail and never guess.
#pragma once

#include <compare>
#include <cstdint>

#include "predicate/certify.h"
#include "predicate/ladder_counts.h"
#include "predicate/round.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// A hit that is decided, with what is known of its place in the order.
struct DecidedHit {
  TriangleD triangle;
  Filtered filtered;
  Interval t;  // holds the true t
  Facing facing;
  std::uint8_t zeros = 0;  // weights known to be exactly zero (kZeroU ...), from the exact rung
};

/// Whether the ray hits the triangle within its range; fills `hit` if so.
bool decide_hit(const RayD& ray, const TriangleD& triangle, DecidedHit& hit, LadderCounts& counts);

/// Whether the point of a hit is a corner of another triangle, or lies on an edge of it, because it
/// is a corner of both, or on an edge of both; fills the weights there that are zero. Unless the
/// ray is parallel to the other one's plane it hits that, too, at the same t.
bool meets_same_feature(const DecidedHit& hit, const TriangleD& other, std::uint8_t& zeros);

/// Whether the ray surely hits a triangle that `meets_same_feature`; fills `hit` if so.
bool certify_same_point(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                        const Interval& t, DecidedHit& hit);

/// Compares the t of two hits of one ray.
std::strong_ordering decide_order(const RayD& ray, const DecidedHit& first,
                                  const DecidedHit& second, LadderCounts& counts);

}  // namespace pierce::predicate
