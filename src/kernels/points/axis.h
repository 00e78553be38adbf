// SPDX-License-Identifier: Apache-2.0
//
// The wide part of what is asked along a coordinate axis: where a point lies, how far columns of a
// grid are inside. Up to sixteen points that look the same way traverse the tree together;
// candidates that float cannot decide go to a callback, the exact resolver. As in kernel.h, only
// discarding too much or being certain too soon could make an answer wrong; the bounds that rule
// this out are in predicate/bounds.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

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
  /// Surely not above the point, not below it; wrong way round where there is none. A corner's copy
  /// above `high`, or below `low`, is on that side for sure.
  alignas(64) float low[3][kAxisPoints] = {};
  alignas(64) float high[3][kAxisPoints] = {};
  float lower[3], upper[3];  ///< hold all points for sure
  /// Out: a count of passages, 1 for leaving and -1 for entering.
  alignas(64) std::int32_t winding[kAxisPoints];
};

/// Which triangles a packet has met, where one may stand in several leaves: a hash table with
/// linear probing, at most half full.
class MetTriangles {
 public:
  /// Whether this is the first meeting.
  bool add(std::uint32_t primitive) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    std::uint32_t& slot = slots_[place_of(primitive)];
    if (slot == primitive) return false;
    slot = primitive;
    ++size_;
    return true;
  }

 private:
  /// Where it is, or belongs.
  [[nodiscard]] std::size_t place_of(std::uint32_t primitive) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t place = (std::uint64_t{primitive} * 0x9e3779b97f4a7c15U >> 32) & mask;
    while (slots_[place] != kNone && slots_[place] != primitive) place = (place + 1) & mask;
    return place;
  }
  void grow() {
    std::vector<std::uint32_t> old(slots_.empty() ? 64 : 2 * slots_.size(), kNone);
    old.swap(slots_);
    for (const std::uint32_t primitive : old) {
      if (primitive != kNone) slots_[place_of(primitive)] = primitive;
    }
  }

  std::vector<std::uint32_t> slots_;
  std::size_t size_ = 0;
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
