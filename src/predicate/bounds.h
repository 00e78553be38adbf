// SPDX-License-Identifier: Apache-2.0
//
// The error bounds of every rung, in one place. docs/algorithm.md derives each of them, the scripts
// in proofs/ take them from this file and check them with Gappa, and the tests named at each one
// attack it. A smaller constant that could be proved makes fewer candidates unsure; a constant that
// is too small is a wrong answer.
#pragma once

#include "exact/arithmetic.h"

namespace pierce::bounds {

// ---- Filter space (docs/algorithm.md, "Filter space") -------------------------------------------
// A float there is rounded by at most 2^-24 of itself, called one ulp below (eps on that page).

/// A ray's origin within this of the centre, in max-norm, is left where it is: so far away cameras
/// stand. Any other is moved to the line's nearest point to the centre.
inline constexpr float kKeptOrigin = 32.0F;

/// If a moved origin is not within this, the line misses the scene; and an origin that is has a
/// reach of 1 at most.
inline constexpr float kNearOrigin = 2.0F;

/// Double arithmetic moves origins up to this far away; farther ones take exact arithmetic.
/// Attacked by tests/unit/filter_space_test.cpp.
inline constexpr double kFarthestOrigin = 0x1p48;

/// Every point of a ray inside the scene's box has |tau| <= 1 + kKeptOrigin + 2^-40, below this.
inline constexpr float kTauLimit = 64.0F;

/// The ends of the range are rounded to float from double; kTauPad of themselves outward (or
/// inward) and a floor cover that. One floor is for subnormals, that of rays whose
/// origin was moved for what is lost when tau_shift is taken off.
inline constexpr double kTauPad = 0x1p-22;
inline constexpr double kTauFloorKept = 0x1p-100;
inline constexpr double kTauFloorMoved = 0x1p-48;

/// A moved origin is off its line by this times the distance from where it was, and by what its
/// last rounding loses.
inline constexpr double kMoveError = 0x1p-98;

// ---- Reach (docs/algorithm.md, "Reach") ---------------------------------------------------------
// The bounds of a leaf and a ray scale with a power of two: as if filter space were just so large
// that the leaf's corners are within 1 and the ray's origin within kNearOrigin.

/// No leaf's or ray's reach is less: products of three then stay far from the subnormals.
inline constexpr float kSmallestReach = 0x1p-24F;

// ---- The box test ("The box test"; proofs/box.g; tests/property/box_test_test.cpp) --------------

/// Everything that is rounded on the way, in the test and before it, comes to 5 ulp of the plane
/// and 6 ulp of the origin, over |direction|. The planes' part is built into the boxes, by this
/// much of each plane outward; the origin's is a pad, with a floor for what is not relative: what
/// moving an origin loses, small slopes, the vertices of triangles that were cut.
inline constexpr double kBoxPlane = 6 * 0x1p-24;
inline constexpr float kBoxOrigin = 7 * 0x1p-24F;
inline constexpr float kBoxFloor = 0x1p-46F;

/// The boxes of float copies, made while they are looked at: of each plane, this much outward, for
/// the copy's rounding and that of the plane, too.
inline constexpr float kBoxCopy = 8 * 0x1p-24F;

/// Direction components smaller than this in magnitude count as this in the box test: no division
/// by zero, no NaN. Over |tau| <= 4 this moves a point by 2^-58.
inline constexpr float kSmallestSlope = 0x1p-60F;

// ---- What boxes hold ("The box test"; proofs/pieces.g) ------------------------------------------

/// A triangle that is cut in two: what its edges' points on the plane are off by, 7.5 units of
/// 2^-53 at most and 11 as Gappa counts them, and the rounding of the box by this much wider.
inline constexpr double kCutSlack = 0x1p-49;

/// A point in filter space is within 2^-53 of its exact image, and so is each plane before it was
/// rounded outward: this much wider, a box holds every point that it should.
inline constexpr double kPointPad = 0x1p-50;

// ---- The leaf cull ("The leaf cull"; proofs/cull_*.g; tests/property/never_culls_a_hit_test.cpp)
// E is the largest edge component of a leaf, at most 2. At reach 1; at another, r, everything is as
// for E / r there, and determinants are r^2 times as large, tau r times.

/// U and V of a triangle that is hit, or that passes the test of certainty, are within
///   e(E) = E (kEdgeLinear + kEdgeSquare E) + kEdgeFloor
/// of the true ones even if the sign of den is taken the wrong way round, and W within
/// kSumFactor e(E). |den| > kSumFactor e(E) proves the sign of den.
inline constexpr float kEdgeLinear = 90 * 0x1p-24F;
inline constexpr float kEdgeSquare = 130 * 0x1p-24F;
inline constexpr float kEdgeFloor = 0x1p-40F;
inline constexpr float kSumFactor = 2;

/// With |den| > kSumFactor e(E), tau = T / den of a triangle that is hit is within
///   (|N| (kTauReach |S| + kTauInput) + kTauCube E^3 + kTauSquare E^2) / |den|
/// of the true one, |N| and |S| in max-norm, the rounding of tau -+ this bound included. kTauInput
/// and kTauSquare stand for the rounding of the inputs and fall away when the ray and the leaf's
/// copies are exact.
inline constexpr float kTauReach = 32 * 0x1p-24F;
inline constexpr float kTauInput = 5 * 0x1p-24F;
inline constexpr float kTauCube = 64 * 0x1p-24F;
inline constexpr float kTauSquare = 9 * 0x1p-24F;
/// What underflow may add to T - tau den.
inline constexpr float kTauFloor = 0x1p-143F;

// ---- Blur (docs/algorithm.md, "Spaces of their own"; proofs/blur.g;
// tests/property/instances_test.cpp)
// What a ray's line and the corners of the triangles are off by, together, where a tree stands in a
// space of its own and both were brought there. B is that blur, absolute, E as above.

/// e(E) grows by B (kBlurEdge E + kBlurSquare B).
inline constexpr float kBlurEdge = 60;
inline constexpr float kBlurSquare = 512;

/// The numerator of tau's bound grows by kBlurTau B E^2.
inline constexpr float kBlurTau = 36;

/// Larger blurs are for no float.
inline constexpr double kLargestBlur = 0x1p-10;

/// A point or a line that is brought to a space of its own in double: three products, three sums.
inline constexpr double kLocalRound = 0x1p-51;

// ---- The cull along an axis ("Along an axis"; proofs/axis_side.g;
// tests/property/axis_cull_test.cpp)

/// A side of a triangle's shadow as seen from a point is, at reach 1, within
///   kAxisSquare m^2 + kAxisInput (m + kAxisMore) + kAxisFloor
/// of the true one, m being the largest difference that goes into it. kAxisInput stands for the
/// rounding of the inputs and falls away when they are exact; the floor for underflow.
inline constexpr float kAxisSquare = 9 * 0x1p-24F;
inline constexpr float kAxisInput = 5 * 0x1p-24F;
inline constexpr float kAxisMore = 0x1p-24F;
inline constexpr float kAxisFloor = 0x1p-100F;

// ---- Nearest points ("Nearest points"; proofs/nearest*.g; tests/property/nearest_bounds_test.cpp)
// In filter space, for a point within R - 1 of the centre, in max-norm.

/// The float traversal's bounds on a distance are within these, times R, of true ones: below, what
/// rounding copies, point, differences, products and the quotient adds (16.5 ulp); above, what
/// finding the point of the triangle adds as well (21.7 ulp).
inline constexpr double kNearestLow = 18 * 0x1p-24;
inline constexpr double kNearestHigh = 24 * 0x1p-24;

/// A factor on a limit that is squared and compared: ten roundings on both sides together, which
/// are five of a length; this is eight.
inline constexpr float kNearestRoom = 1 + 0x1p-21F;

/// A vector whose square is no longer than this, 2^-50 itself, may have lost its direction to
/// underflow.
inline constexpr float kNearestShortest = 0x1p-100F;

/// Points farther from the centre than this are traversed in double.
inline constexpr double kNearestFloat = 32;

/// The same bounds in double: what copying corners to float adds (sqrt(3) / 2 ulp), and 32 units of
/// 2^-53 times R for the rest.
inline constexpr double kNearestPlainCopy = 0x1p-24;
inline constexpr double kNearestPlainReach = 0x1p-48;

/// Points farther than this from the centre are nearest to what reaches farthest towards them: of
/// corners copied to float, with a direction of max-norm 1, this is known to within kNearestFar
/// (1.5 ulp for copies, 3 * 2^-40 for the direction, 1.5 * 2^-40 for what is left out).
inline constexpr double kNearestFarthest = 0x1p40;
inline constexpr double kNearestFar = 0x1p-22;

// ---- The double rung ("The double rung"; proofs/double_*.g; tests/unit/certify_bounds_test.cpp) -
// The first three in units of 2^-53 times the product of the operands' largest magnitudes. They
// leave room for 16 roundings of whatever a bound becomes a part of.

inline constexpr double kDoubleUlp = 0x1p-53;

/// den and U, V: six products, at most 7 roundings each, 40 in all.
inline constexpr double kDenFactor = 41 * kDoubleUlp;
inline constexpr double kUvFactor = 41 * kDoubleUlp;
/// T: six products, at most 8 roundings each, 46 in all.
inline constexpr double kTFactor = 47 * kDoubleUlp;
/// W = (den - U) - V adds this times |den| + |U| + |V|: two roundings, and room.
inline constexpr double kWFactor = 3 * kDoubleUlp;
/// The same numbers, each in units of the sum of its six products' magnitudes, which is less where
/// coordinates are 0, or nearly: at most 8 roundings each, W too where it is computed as U and V
/// are; and nothing at all where all products are 0. The rest is room for the sum's own roundings
/// (proofs/termwise.g; tests/differential/walls_test.cpp).
inline constexpr double kTermwise = 16 * kDoubleUlp;
/// Components other than 0 are no smaller: then no product underflows, nor what is left of two.
inline constexpr double kSmallestComponent = 0x1p-100;
/// Comparing T with t_0 den adds this times |t_0 den| + |T - t_0 den|, as computed: a rounding
/// each, and room; and a floor for a product that underflows.
inline constexpr double kRangeFactor = 4 * kDoubleUlp;
inline constexpr double kRangeFloor = 0x1p-1000;
/// The interval of t adds this times |t|: the quotient's rounding and that of the ends, and room.
inline constexpr double kIntervalFactor = 4 * kDoubleUlp;

/// Within these no product of the determinants overflows, and what underflow adds is far below one
/// unit of the factors above: products of three maxima lie in [2^-450, 2^450].
inline constexpr double kSmallestMagnitude = 0x1p-150;
inline constexpr double kLargestMagnitude = 0x1p150;
/// Where S in filter space is at least so large, what a ray lost into the subnormals of float on
/// the way there (2^-150) is less than 2^-10 of what the bounds above have to spare.
inline constexpr double kSubnormalsAreNothing = 0x1p-80;

/// A side of a triangle's shadow ("Along an axis"; proofs/double_side.g;
/// tests/unit/axis_passage_test.cpp), times the larger of its two products: three roundings each
/// and one of the difference, 8 in all. Their underflow is far below the floor.
inline constexpr double kSideFactor = 9 * kDoubleUlp;
inline constexpr double kSideFloor = 0x1p-1000;

/// Of a ray along an axis, tau from weights in double is within this times the largest distance of
/// a corner along it ("The cull once more, in double"; proofs/along_axis.g): 10 roundings.
inline constexpr double kAlongAxis = 16 * kDoubleUlp;
/// And this, if its origin may have lost something into the subnormals of float: 2^-150 of a place,
/// over a direction of at least 1.
inline constexpr double kLostAlongAxis = 0x1p-148;

/// u, v and w of such a ray, from differences of two products that are within 8 * 2^-106 of
/// themselves, as quotients of double-doubles ("The exact rung"; tests/unit/axis_signs_test.cpp): 8
/// of a weight, 8 + 8 + 8 of their sum, 64 of the quotient.
inline constexpr double kAlongAxisWeights = 128 * 0x1p-106;

// ---- Rounding ("Rounding"; proofs/quotient.g, double_double.g, compensated.g;
// tests/unit/round_bounds_test.cpp)

/// Quotients to float are only asked of a den beyond kQuotientClear times its error: then
/// 1 / (den - error), with all roundings of a bound, is below kQuotientRoom / den. A product with
/// the inverse and the ends of the interval round three times: kQuotientFactor times the quotient.
inline constexpr double kQuotientClear = 0x1p20;
inline constexpr double kQuotientRoom = 1 + 0x1p-18;
inline constexpr double kQuotientFactor = 4 * kDoubleUlp;

/// The determinants in double-doubles are within 224 * 2^-106 times the product of the operands'
/// maxima; compensated ones within 348, and what W adds makes that 556. The rest is room.
inline constexpr double kDoubleDoubleFactor = 640 * 0x1p-106;
/// So the bounds of the double rung, times this, are bounds on them, that of W too (kDenFactor is
/// the least of the factors there).
inline constexpr double kFiner = kDoubleDoubleFactor / kDenFactor;
/// A quotient of either adds this times itself (28 units are counted, and 24), and each end of its
/// interval is rounded once more, by kFineEnds of the quotient's low part.
inline constexpr double kFineQuotientFactor = 64 * 0x1p-106;
inline constexpr double kFineEnds = 2 * kDoubleUlp;

}  // namespace pierce::bounds
