// SPDX-License-Identifier: Apache-2.0
//
// The error bounds of the float rung. Every constant here is derived in docs/algorithm.md and
// machine-checked in proofs/. `ulp` is 2^-24, the largest relative error of one float rounding; E
// is a leaf's largest edge component, at most 2.
//
// What is rounded before a kernel starts: the ray's origin (within 2, so by at most 1 ulp), its
// direction (max-norm in [1, 2), 1 ulp), the leaf's corners (within 1, 1/2 ulp each).
#pragma once

namespace pierce::kernels {

/// The box test's bound for everything that is rounded on the way: box, origin, direction,
/// reciprocal, and the test itself come to 14 ulp / |direction| (docs/algorithm.md, "The box
/// test").
inline constexpr float kBoxPad = 0x1p-20F;  // 16 ulp

/// Direction components smaller than this in magnitude count as this in the box test: no division
/// by zero, no NaN. Over |tau| <= 4 this moves a point by 2^-58.
inline constexpr float kSmallestSlope = 0x1p-60F;

/// U, V and den of a triangle that is hit, or that is found certain, are within
///   e(E) = E (kEdgeLinear + kEdgeSquare E) + kEdgeFloor
/// of the true ones, and W within kSumFactor e(E) (docs/algorithm.md, "The leaf cull").
inline constexpr float kEdgeLinear = 128 * 0x1p-24F;
inline constexpr float kEdgeSquare = 128 * 0x1p-24F;
inline constexpr float kEdgeFloor = 0x1p-36F;
inline constexpr float kSumFactor = 4;

/// With |den| > kSumFactor e(E), tau = T / den of a triangle that passes U, V and W is within
///   (|N| (kTauReach |S| + kTauInput) + kTauCube E^3 + kTauSquare E^2) / |den|
/// of the true one, |N| and |S| in max-norm. kTauInput and kTauSquare stand for the rounding of the
/// inputs and fall away when the ray and the leaf's copies are exact (docs/algorithm.md, "The place
/// in the order").
inline constexpr float kTauReach = 64 * 0x1p-24F;
inline constexpr float kTauInput = 8 * 0x1p-24F;
inline constexpr float kTauCube = 512 * 0x1p-24F;
inline constexpr float kTauSquare = 128 * 0x1p-24F;

/// The ends of the range are rounded to float from double; this much outward (or inward) covers
/// that for |tau| <= 4.
inline constexpr double kTauPad = 0x1p-21;

}  // namespace pierce::kernels
