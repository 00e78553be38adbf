// SPDX-License-Identifier: Apache-2.0
//
// The box test and the leaf cull themselves, as every instruction set of this machine runs them:
// eight boxes of a node, or the triangles of a leaf, against one ray, with all that they say.
#pragma once

#include <cstdint>
#include <span>

#include "bvh/tree.h"
#include "kernels/kernel.h"

namespace pierce::siege {

/// What the cull says of a leaf, a bit a triangle (kernels/rays/leaf-inl.h).
struct LeafSays {
  std::uint32_t open = 0, certain = 0;
  float tau_low[bvh::kWidth], tau_high[bvh::kWidth];
};

struct Target {
  const char* name;
  /// Bit i: the ray may enter child i, at entry[i] or later.
  std::uint32_t (*entered)(const bvh::Node&, const space::FilterRay&, float* entry);
  LeafSays (*cull)(const bvh::Tree&, std::uint32_t leaf, const space::FilterRay&);
};

std::span<const Target> targets();

}  // namespace pierce::siege
