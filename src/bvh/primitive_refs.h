// SPDX-License-Identifier: Apache-2.0
//
// The builder's raw material: one box per primitive, made once and moved about from then on.
#pragma once

#include <bit>
#include <cstdint>

#include "bvh/box.h"
#include "bvh/primitives.h"
#include "support/build_control.h"
#include "support/huge_buffer.h"

namespace pierce::bvh {

/// Box of a primitive with the primitive's number in the spare lane of `lower` (32 bytes).
struct PrimitiveRef {
  Box box;

  PrimitiveRef() = default;
  PrimitiveRef(const Box& around, std::uint32_t primitive) : box(around) {
    box.lower[3] = std::bit_cast<float>(primitive);
    box.upper[3] = 0.0F;
  }
  [[nodiscard]] std::uint32_t primitive() const {
    return std::bit_cast<std::uint32_t>(static_cast<float>(box.lower[3]));
  }
  /// Twice the centre of the box; the spare lane is 0.
  [[nodiscard]] Float4 centre2() const {
    Float4 sum = box.lower + box.upper;
    sum[3] = 0.0F;
    return sum;
  }
};
static_assert(sizeof(PrimitiveRef) == 32);

/// The boxes of all primitives, in their order, and room for as many as `capacity`.
HugeBuffer<PrimitiveRef> make_primitive_refs(const Primitives& primitives, std::uint32_t capacity,
                                             BuildControl& control);

}  // namespace pierce::bvh
