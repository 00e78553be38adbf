// SPDX-License-Identifier: Apache-2.0
//
// Random numbers of the campaign, most of them unpleasant. The same seed gives the same case on
// every machine: nothing here depends on the standard library's distributions.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <limits>
#include <random>
#include <type_traits>

#include "pierce/types.h"

namespace pierce::campaign {

class Rng {
 public:
  explicit Rng(std::uint64_t seed) : bits_(seed) {}

  std::uint64_t below(std::uint64_t count) { return bits_() % count; }
  int between(int low, int high) {
    return low + static_cast<int>(below(static_cast<std::uint64_t>(high - low) + 1));
  }
  bool one_in(int count) { return below(static_cast<std::uint64_t>(count)) == 0; }
  double unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double within(double size) { return (2 * unit() - 1) * size; }

  template <class T>
  T one_of(std::initializer_list<T> values) {
    return values.begin()[below(values.size())];
  }
  template <class List>
  const auto& any(const List& list) {
    return list[below(list.size())];
  }

 private:
  std::mt19937_64 bits_;
};

/// x, so many places up or down, and never infinite. At once, as it may be a million places.
template <class Real>
Real nudged(Real x, int places) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
  if (places == 0) return x;
  constexpr Bits kSign = std::numeric_limits<Bits>::min();
  constexpr auto kMost = std::bit_cast<Bits>(std::numeric_limits<Real>::max());
  const auto bits = std::bit_cast<Bits>(x);
  const Bits size = bits & ~kSign;  // floats of one sign are in the order of their bits
  const std::int64_t place = std::int64_t{bits < 0 ? -size : size} + places;
  const auto found = static_cast<Bits>(std::min<std::int64_t>(std::abs(place), kMost));
  return std::bit_cast<Real>(place < 0 ? static_cast<Bits>(found | kSign) : found);
}

template <class Real>
Vec3<Real> nudged(Rng& rng, const Vec3<Real>& p, int most) {
  return {nudged(p.x, rng.between(-most, most)), nudged(p.y, rng.between(-most, most)),
          nudged(p.z, rng.between(-most, most))};
}

/// A double as a finite Real.
template <class Real>
Real finite(double x) {
  constexpr double kMost = std::numeric_limits<Real>::max();
  if (std::isnan(x)) return 0;
  return static_cast<Real>(x > kMost ? kMost : x < -kMost ? -kMost : x);
}

template <class Real>
Vec3<Real> finite(double x, double y, double z) {
  return {finite<Real>(x), finite<Real>(y), finite<Real>(z)};
}

/// A number whose exponent may be any.
template <class Real>
Real any_size(Rng& rng) {
  using Limits = std::numeric_limits<Real>;
  const int e = rng.between(Limits::min_exponent - Limits::digits, Limits::max_exponent);
  return finite<Real>(std::ldexp(rng.within(1), e));
}

template <class Real>
Vec3<Real> in_cube(Rng& rng, double size) {
  const double x = rng.within(size), y = rng.within(size), z = rng.within(size);
  return finite<Real>(x, y, z);
}

}  // namespace pierce::campaign
