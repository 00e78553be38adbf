// SPDX-License-Identifier: Apache-2.0
//
// The wide part of what is asked along a coordinate axis: where a point lies, how far columns of a
// grid are inside. Up to sixteen points that look the same way traverse the tree together;
// candidates that float cannot decide go to a callback, the exact resolver. As in kernel.h, only
// discarding too much or being certain too soon could make an answer wrong; the bounds that rule
// this out are in predicate/bounds.h.
#pragma once

#include <cstdint>

#include "bvh/tree.h"
#include "kernels/candidate.h"

namespace pierce::kernels {

/// How many points go together at most.
inline constexpr std::uint32_t kAxisPoints = 16;

struct AxisPacket {
  std::uint32_t count = 0;
  std::uint32_t axis = 2;  ///< 0, 1, 2: x, y, z
  bool forward = true;     ///< the points look towards larger coordinates
  float reach = 1;         ///< a power of two, at least the points' coordinates off the axis
  bool exact = false;      ///< nothing was rounded: neither here nor in the leaves' copies
  bool repeats = false;    ///< a triangle may stand in several leaves
  alignas(64) float point[3][kAxisPoints] = {};  ///< nearest floats
  /// Along the axis: a corner's copy above `above`, or below `below`, is on that side for sure.
  alignas(64) float above[kAxisPoints] = {};
  alignas(64) float below[kAxisPoints] = {};
  float lower[3], upper[3];  ///< hold all points for sure
  /// Out: a count of passages, 1 for leaving and -1 for entering.
  alignas(64) std::int32_t winding[kAxisPoints];
};

/// Decides the passages that float cannot.
class AxisResolver {
 public:
  virtual ~AxisResolver() = default;
  /// 1, -1 or 0: what the triangle adds to the winding of the point.
  virtual int passage(std::uint32_t point, const Candidate& candidate) = 0;
};

/// Fills `winding`. Every triangle on which a point lies is asked about.
using AxisTraversal = void (*)(const bvh::Tree&, AxisPacket&, AxisResolver&, KernelCounts*);

/// The traversal without SIMD and without cull, to compare.
void traverse_axis_plain(const bvh::Tree&, AxisPacket&, AxisResolver&, KernelCounts*);

}  // namespace pierce::kernels
