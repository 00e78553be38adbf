// SPDX-License-Identifier: Apache-2.0
//
// The benchmark's own random numbers: the same on every machine and standard library, which the
// distributions of <random> are not. SplitMix64 (Steele, Lea, Flood 2014).
#pragma once

#include <cmath>
#include <cstdint>

#include "pierce/types.h"

namespace pierce::bench {

/// A well mixed function of one 64-bit number: random access to the generator below.
constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

/// Uniform in [0, 1), a multiple of 2^-53.
constexpr double to_unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

class Prng {
 public:
  explicit constexpr Prng(std::uint64_t seed) : state_(seed) {}

  constexpr std::uint64_t next() { return mix(state_ += 0x9e3779b97f4a7c15U); }
  constexpr double unit() { return to_unit(next()); }
  constexpr double between(double low, double high) { return low + (high - low) * unit(); }

  /// Uniform on the unit sphere, by rejection: sqrt is the same everywhere, sin and cos are not.
  Vec3<double> on_sphere() {
    for (;;) {
      const Vec3<double> p{between(-1, 1), between(-1, 1), between(-1, 1)};
      const double square = p.x * p.x + p.y * p.y + p.z * p.z;
      if (square > 1 || square < 1e-4) continue;
      const double scale = 1 / std::sqrt(square);
      return {p.x * scale, p.y * scale, p.z * scale};
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace pierce::bench
