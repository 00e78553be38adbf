// SPDX-License-Identifier: Apache-2.0
//
// The exact rung: never unsure, for every finite input. Coordinates become integers over a common
// power of two: one digit each if they fit in 59 bits (most float scenes), two if in 121 (most
// double scenes), four if in 245, else integers of any size.
#pragma once

#include <compare>
#include <cstdint>

#include "predicate/certify.h"
#include "predicate/filtered.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// How wide the integers had to be.
enum class Width : std::uint8_t { One, Two, Four, Any };

struct Settled {
  bool hit;
  Facing facing;       // meaningful only for a hit
  std::uint8_t zeros;  // meaningful only for a hit
  Width width;
  bool certified = false;  // without integers, after all
  Interval t = {};         // of a hit, if that is known better than double knows it
};

/// Whether the ray hits the triangle within its range, exactly.
Settled settle_hit(const RayD& ray, const TriangleD& triangle);

/// The same; what double is sure of is not computed again. Where the integers would have more
/// than two digits, double-doubles are asked first.
Settled settle_hit(const RayD& ray, const TriangleD& triangle, const Filtered& filtered);

/// Whether the triangle has area, exactly.
bool settle_has_area(const TriangleD& triangle);

/// Compares the t of two hits of one ray, exactly.
std::strong_ordering settle_order(const RayD& ray, const TriangleD& first, const TriangleD& second);

/// Numbers of a hit, a bit each.
inline constexpr std::uint8_t kNumberT = 1;
inline constexpr std::uint8_t kNumberU = 2;
inline constexpr std::uint8_t kNumberV = 4;
inline constexpr std::uint8_t kNumberW = 8;
inline constexpr std::uint8_t kAllNumbers = 15;

/// Sets those of t, u, v, w that are `wanted`, each correctly rounded to Real from exact
/// arithmetic, and facing. The triangle must be hit: its plane is not parallel to the ray.
template <class Real>
void settle_numbers(const RayD& ray, const TriangleD& triangle, std::uint8_t wanted,
                    Hit<Real>& hit);

extern template void settle_numbers<float>(const RayD&, const TriangleD&, std::uint8_t,
                                           Hit<float>&);
extern template void settle_numbers<double>(const RayD&, const TriangleD&, std::uint8_t,
                                            Hit<double>&);

/// All of them; the rest of the hit is as it comes.
template <class Real>
Hit<Real> settle_numbers(const RayD& ray, const TriangleD& triangle) {
  Hit<Real> hit;
  settle_numbers(ray, triangle, kAllNumbers, hit);
  return hit;
}

}  // namespace pierce::predicate
