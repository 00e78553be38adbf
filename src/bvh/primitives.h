// SPDX-License-Identifier: Apache-2.0
//
// What the builder knows of the scene: numbered triangles with corners in filter space.
#pragma once

#include <cstdint>

#include "pierce/types.h"

namespace pierce::bvh {

/// Axes as bits: 1, 2, 4.
using Axes = std::uint32_t;

/// Corners of one triangle in filter space, in double: each component within 2^-53 of the exact
/// mapped value, and of magnitude at most 1.
struct Corners {
  Vec3<double> a, b, c;
};

/// The triangles of all geometries, counted through. Corners are cheap to ask for (two index
/// look-ups and a few multiplications) and safe to ask for from many threads.
class Primitives {
 public:
  virtual ~Primitives() = default;
  [[nodiscard]] virtual std::uint32_t size() const = 0;
  [[nodiscard]] virtual Corners corners(std::uint32_t primitive) const = 0;
  /// The same for several at once.
  virtual void gather(const std::uint32_t* numbers, std::uint32_t n, Corners* out) const {
    for (std::uint32_t i = 0; i < n; ++i) out[i] = corners(numbers[i]);
  }
  /// Of axes across which the triangle stands by its corners here, those across which it stands as
  /// the scene has it: there, too, the three coordinates are the same. May leave out some.
  [[nodiscard]] virtual Axes across(std::uint32_t /*primitive*/, Axes /*axes*/) const { return 0; }
};

}  // namespace pierce::bvh
