// SPDX-License-Identifier: Apache-2.0
//
// Numbers drawn by lot, the same on every machine: everything about draw `index` follows from
// (seed, index), so a failing case is named by two numbers.
#pragma once

#include <cstdint>
#include <utility>

#include "pierce/vector.h"
#include "render/sampling.h"

namespace pierce::tool {

class Lots {
 public:
  Lots(std::uint64_t seed, std::uint64_t index) : state_(mix(mix(seed) + index)) {}

  std::uint64_t bits() { return state_ = mix(state_); }

  /// 0 to n - 1.
  std::uint32_t below(std::uint64_t n) { return static_cast<std::uint32_t>(bits() % n); }

  /// low to high, both included.
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint64_t>(high - low) + 1));
  }

  double unit() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }  ///< [0, 1)
  double symmetric() { return 2 * unit() - 1; }                           ///< [-1, 1)

  /// In the cube [-1, 1)^3.
  Vec3<double> cube() {
    const double x = symmetric(), y = symmetric();
    return {x, y, symmetric()};
  }

 private:
  std::uint64_t state_;
};

/// Component 0, 1 or 2, to be written to.
template <class Real>
Real& writable_component(Vec3<Real>& v, std::uint32_t axis) {
  return const_cast<Real&>(pierce::component(std::as_const(v), static_cast<int>(axis)));
}

}  // namespace pierce::tool
