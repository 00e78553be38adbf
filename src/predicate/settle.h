// SPDX-License-Identifier: Apache-2.0
//
// The exact rung: never unsure, for every finite input. Coordinates become integers over a common
// power of two: one limb each if they fit in 60 bits (most float scenes), two if in 124 (most
// double scenes), else integers of any size.
#pragma once

#include <compare>
#include <cstdint>

#include "predicate/types.h"

namespace pierce::predicate {

/// Which corners have weight zero: bits of Settled::zeros. One bit: the point lies on the edge that
/// does not touch that corner; two bits: on a vertex.
inline constexpr std::uint8_t kZeroU = 1;
inline constexpr std::uint8_t kZeroV = 2;
inline constexpr std::uint8_t kZeroW = 4;

/// How wide the integers had to be.
enum class Width : std::uint8_t { One, Two, Any };

struct Settled {
  bool hit;
  Facing facing;       // meaningful only for a hit
  std::uint8_t zeros;  // meaningful only for a hit
  Width width;
};

/// Whether the ray hits the triangle within its range, exactly.
Settled settle_hit(const RayD& ray, const TriangleD& triangle);

/// Whether the triangle has area, exactly.
bool settle_has_area(const TriangleD& triangle);

/// Compares the t of two hits of one ray, exactly.
std::strong_ordering settle_order(const RayD& ray, const TriangleD& first, const TriangleD& second);

/// t, u, v, w of a hit, each correctly rounded to Real, all from exact arithmetic. Only those of
/// t, u, v, w and facing are set.
template <class Real>
Hit<Real> settle_numbers(const RayD& ray, const TriangleD& triangle);

extern template Hit<float> settle_numbers<float>(const RayD&, const TriangleD&);
extern template Hit<double> settle_numbers<double>(const RayD&, const TriangleD&);

}  // namespace pierce::predicate
