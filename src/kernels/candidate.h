// SPDX-License-Identifier: Apache-2.0
//
// What kernels find, and what they count on the way.
#pragma once

#include <cstdint>

#include "pierce/types.h"

namespace pierce::kernels {

/// A triangle that a kernel has met, and its float copy in the leaf: component k of the corners (ax
/// ay az bx by bz cx cy cz) is copy[k * stride]. A tree that keeps no copies (Layout::Compact) has
/// one only while its leaf is looked at: whoever keeps the candidate goes by the number.
struct Candidate {
  std::uint32_t primitive = kNone;
  std::uint32_t stride = 0;
  const float* copy = nullptr;
};

/// Counts of one query or batch, added to.
struct KernelCounts {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t candidates = 0;
};

}  // namespace pierce::kernels
