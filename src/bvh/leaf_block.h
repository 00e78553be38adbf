// SPDX-License-Identifier: Apache-2.0
//
// Writing one leaf block; node.h is its data sheet.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "bvh/box.h"
#include "bvh/node.h"
#include "bvh/primitives.h"

namespace pierce::bvh {

/// Size of a block of n triangles in units of kLeafUnit.
inline std::uint32_t leaf_units(std::uint32_t n) {
  return (4 * (10 * n + 1) + kLeafUnit - 1) / kLeafUnit;
}

/// The largest |component| of the edges b - a and c - a, of the corners and of their float copies:
/// whichever the error analysis means, the block's E covers it.
inline double largest_edge(const Corners& t) {
  double largest = 0;
  const auto edge = [&](double from, double to) {
    const auto from_f = static_cast<double>(static_cast<float>(from));
    const auto to_f = static_cast<double>(static_cast<float>(to));
    largest = std::max({largest, std::abs(to - from), std::abs(to_f - from_f)});
  };
  for (const Vec3<double>& corner : {t.b, t.c}) {
    edge(t.a.x, corner.x);
    edge(t.a.y, corner.y);
    edge(t.a.z, corner.z);
  }
  return largest;
}

/// Writes the block of n triangles (1 to 8) at `place`, its padding zeroed.
inline void write_leaf_block(std::byte* place, const Primitives& primitives,
                             const std::uint32_t* numbers, std::uint32_t n) {
  constexpr std::size_t kMaxFloats = 10 * kWidth + 1 + kLeafUnit / sizeof(float);
  float block[kMaxFloats] = {};
  double edge = 0;
  float* row = block + 1;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Corners t = primitives.corners(numbers[i]);
    edge = std::max(edge, largest_edge(t));
    const double component[9] = {t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z};
    for (std::uint32_t k = 0; k < 9; ++k) row[k * n + i] = static_cast<float>(component[k]);
    std::memcpy(&row[9 * n + i], &numbers[i], sizeof numbers[i]);
  }
  block[0] = round_up(edge);
  std::memcpy(place, block, std::size_t{leaf_units(n)} * kLeafUnit);
}

}  // namespace pierce::bvh
