// SPDX-License-Identifier: Apache-2.0
//
// The ladder for one ray and one triangle: double first, exact where double is unsure. Everything
// the scenes answer goes through these functions; they never fail and never guess.
#pragma once

#include <compare>
#include <cstdint>

#include "predicate/certify.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// How often each rung had the last word.
struct LadderCounts {
  std::uint64_t certified = 0;
  std::uint64_t settled = 0;
  std::uint64_t settled_big = 0;
  std::uint64_t orders_certified = 0;
  std::uint64_t orders_settled = 0;
  std::uint64_t rounded_exactly = 0;
};

/// A hit that is decided, with what is known of its place in the order.
struct DecidedHit {
  TriangleD triangle;
  Filtered filtered;
  Interval t;              // holds the true t
  std::uint8_t zeros = 0;  // weights known to be exactly zero (kZeroU ...), from the exact rung
};

/// Whether the ray hits the triangle within its range; fills `hit` if so.
bool decide_hit(const RayD& ray, const TriangleD& triangle, DecidedHit& hit, LadderCounts& counts);

/// Compares the t of two hits of one ray.
std::strong_ordering decide_order(const RayD& ray, const DecidedHit& first,
                                  const DecidedHit& second, LadderCounts& counts);

/// t, u, v, w and facing of a hit, correctly rounded to Real. The triangle is surely hit; `zeros`:
/// weights known to be exactly zero.
template <class Real>
Hit<Real> round_hit(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                    LadderCounts& counts);

extern template Hit<float> round_hit<float>(const RayD&, const TriangleD&, std::uint8_t,
                                            LadderCounts&);
extern template Hit<double> round_hit<double>(const RayD&, const TriangleD&, std::uint8_t,
                                              LadderCounts&);

}  // namespace pierce::predicate
