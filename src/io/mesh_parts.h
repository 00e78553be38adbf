// SPDX-License-Identifier: Apache-2.0
//
// What the mesh readers share: limits, and attributes to their ranges.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "io/mesh.h"

namespace pierce::io {

/// The most vertices that a mesh can have: indices are 32 bits and the last one means "none".
inline constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();

/// Colours given as 0 to 255 become 0 to 1: that is, if any part of any colour exceeds 1.
void scale_colors(std::vector<Vec3<float>>& colors);

/// Whether each coordinate is a float; NaN is none.
[[nodiscard]] bool all_floats(std::span<const Vec3<double>> vertices);

/// The nearest float; infinity beyond the floats. For attributes only.
[[nodiscard]] inline float nearest_float(double value) { return static_cast<float>(value); }

}  // namespace pierce::io
