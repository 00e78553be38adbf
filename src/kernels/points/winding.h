// SPDX-License-Identifier: Apache-2.0
//
// Winding numbers by a tree with multipole expansions: half the solid angles of all its triangles
// as seen from a point. A node has eight children; of each it holds an expansion about a centre and
// a bound on what the expansion leaves out, so that a child that is far enough is summed by itself
// and any other one is opened. The order of all operations is the same in every kernel, and none is
// fused: so are the answers, bit by bit (docs/algorithm.md, "Winding numbers").
//
// Coordinates are those of the scene times a power of two (WindingTree::scale).
#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "bvh/node.h"

namespace pierce::kernels {

inline constexpr int kWindingLanes = 8;
/// Expansions have the powers 1 to this of 1 / distance; an even number.
inline constexpr int kWindingOrder = 4;
/// Monomials x^a y^b z^c of the degrees 1 to kWindingOrder: by degree, then a and b downwards.
inline constexpr int kWindingTerms =
    (kWindingOrder + 1) * (kWindingOrder + 2) * (kWindingOrder + 3) / 6 - 1;

struct alignas(64) WindingNode {
  double centre[3][kWindingLanes];
  double radius[kWindingLanes];  ///< no corner of a child is farther from its centre
  double bound[kWindingLanes];   ///< integral of distance^order over its triangles, over 4 pi
  double area[kWindingLanes];    ///< of its triangles, over 4 pi
  double term[kWindingTerms][kWindingLanes];
  std::uint32_t child[kWindingLanes];  ///< a node; a leaf if bvh::kLeafBit is set; or kNoChild
};

struct alignas(64) WindingLeaf {
  double corner[9][kWindingLanes];  ///< ax ay az bx by bz cx cy cz; beyond `count` a point
  std::uint32_t triangle[kWindingLanes];
  std::uint32_t count = 0;
};

struct WindingTree {
  std::vector<WindingNode> nodes;
  std::vector<WindingLeaf> leaves;
  std::uint32_t root = bvh::kNoChild;
  double scale = 1;  ///< a power of two that brings all corners to magnitudes of at most 1
  double area = 0;   ///< of all triangles, not below the true one
  double share = 0;  ///< of the tolerance, for a cluster: what to try first
};

/// Is told of the triangles that are too near for the kernel: they add nothing to its sum.
class WindingResolver {
 public:
  virtual ~WindingResolver() = default;
  virtual void near(std::uint32_t triangle) = 0;
};

/// What the triangles add to the winding number: `far`, and `angle` / (2 pi).
struct WindingSum {
  double far = 0, far_error = 0;
  double angle = 0, angle_error = 0;
};

/// Children whose bound is above `share` are opened. Magnitudes of `point` are at most 2^60.
using WindingTraversal = WindingSum (*)(const WindingTree&, const double* point, double share,
                                        WindingResolver&);

/// The one without SIMD.
WindingSum winding_plain(const WindingTree& tree, const double* point, double share,
                         WindingResolver& resolver);

namespace winding {

/// What rounding adds to the error of an expansion, relative to area / (4 pi distance^2).
inline constexpr double kRounding = 0x1p-30;
/// What is left out, relative to bound / distance^(order + 2): kLeastLeft + kMoreLeft * ratio.
inline constexpr double kLeastLeft = kWindingOrder + 1, kMoreLeft = 2 * kWindingOrder + 6;
/// Nearer clusters are opened, whatever their bound says: their powers might underflow.
inline constexpr double kNearestSquare = 0x1p-200;
/// Corners nearer than this are not for the kernel (squared).
inline constexpr double kNearestCorner = 0x1p-400;
/// Nor are triangles whose complex number is this much smaller than |a| |b| |c|.
inline constexpr double kSmallest = 0x1p-6;
/// The error of an angle, relative to |a| |b| |c| over the larger part of the complex number.
inline constexpr double kAngle = 0x1p-46;
/// Leaves after which the products of complex numbers are brought back to about 1.
inline constexpr std::uint32_t kLeavesPerScaling = 256;

/// What is summed in each lane; a kernel starts with 0, but 1 in `real`.
struct Lanes {
  alignas(64) double far[kWindingLanes];
  alignas(64) double far_error[kWindingLanes];
  alignas(64) double real[kWindingLanes];
  alignas(64) double imaginary[kWindingLanes];
  alignas(64) double turns[kWindingLanes];
  alignas(64) double error[kWindingLanes];
};

/// `angle`: predicate::angle_of each lane's complex number; null if no leaf was met.
inline WindingSum sum_of(const Lanes& lanes, const double* angle) {
  WindingSum sum;
  for (int i = 0; i < kWindingLanes; ++i) {
    sum.far += lanes.far[i];
    sum.far_error += lanes.far_error[i];
  }
  if (angle == nullptr) return sum;
  for (int i = 0; i < kWindingLanes; ++i) {
    sum.angle += angle[i];
    sum.angle += 2 * std::numbers::pi * lanes.turns[i];
    sum.angle_error += lanes.error[i];
  }
  sum.angle_error = sum.angle_error * kAngle + 0x1p-44;
  return sum;
}

}  // namespace winding
}  // namespace pierce::kernels
