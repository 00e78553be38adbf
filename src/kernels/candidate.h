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
  std::uint16_t stride = 0;
  std::uint8_t zeros = 0;  ///< weights of its hit that are known to be 0 (predicate::kZeroU ...)
  const float* copy = nullptr;

  Candidate() = default;
  Candidate(std::uint32_t number, std::uint32_t between, const float* first,
            std::uint8_t known_zeros = 0)
      : primitive(number),
        stride(static_cast<std::uint16_t>(between)),
        zeros(known_zeros),
        copy(first) {}
  /// Of the copy: a, b and c are 0, 1 and 2.
  [[nodiscard]] Vec3<float> corner(int k) const {
    const float* const at = copy + 3 * k * stride;
    return {at[0], at[stride], at[2 * stride]};
  }
};

/// Counts of one query or batch, added to.
struct KernelCounts {
  std::uint64_t nodes = 0;
  std::uint64_t leaves = 0;
  std::uint64_t candidates = 0;
};

}  // namespace pierce::kernels
