// SPDX-License-Identifier: Apache-2.0
//
// Floats of every kind that arithmetic finds hard, each kind by name.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <type_traits>

#include "pierce/types.h"
#include "support/rng.h"

namespace pierce::hard {

/// What the numbers of a case look like.
enum class Style : std::uint8_t {
  Unit,           // [-1, 1), all bits used
  SmallInteger,   // -8 .. 8: many ties, many exact results
  Integer,        // up to 2^20
  Lattice,        // multiples of 1/8 in [-4, 4]
  Cad,            // decimal millimetres: k * 0.1, k * 0.001, with rounding
  Georeferenced,  // some 500 km plus small details
  Halfway,        // integers one bit too long for the type beside powers of two: rounding ties
  Huge,           // near 1e300 (1e30 for float)
  Tiny,           // near 1e-300 (1e-30)
  NearOverflow,   // within a factor 8 of the largest number
  Denormal,       // subnormal or just above
  Critical,       // products of 2 to 6 of them lie at the edge of underflow or overflow
  AnyFinite,      // random bits
  Mixed,          // each number of another style
};
inline constexpr std::array<Style, 14> kAllStyles = {
    Style::Unit,      Style::SmallInteger,  Style::Integer,  Style::Lattice,
    Style::Cad,       Style::Georeferenced, Style::Halfway,  Style::Huge,
    Style::Tiny,      Style::NearOverflow,  Style::Denormal, Style::Critical,
    Style::AnyFinite, Style::Mixed};
/// Those that ordinary data are made of, whatever the type: no overflow or underflow far and wide.
inline constexpr std::array<Style, 7> kTameStyles = {
    Style::Unit, Style::SmallInteger,  Style::Integer, Style::Lattice,
    Style::Cad,  Style::Georeferenced, Style::Halfway};

template <class Real>
Real any_finite(Rng& rng) {
  using Bits = std::conditional_t<std::is_same_v<Real, float>, std::uint32_t, std::uint64_t>;
  for (;;) {
    const auto bits = static_cast<Bits>(rng.bits());
    const Real value = std::bit_cast<Real>(bits);
    if (std::isfinite(value)) return value;
  }
}

template <class Real>
Real number(Rng& rng, Style style) {
  using Limits = std::numeric_limits<Real>;
  constexpr bool kFloat = std::is_same_v<Real, float>;
  const auto scaled = [&](int exponent) {
    return std::ldexp(static_cast<Real>(rng.symmetric()), exponent);
  };
  switch (style) {
    case Style::Unit:
      return scaled(0);
    case Style::SmallInteger:
      return static_cast<Real>(rng.between(-8, 8));
    case Style::Integer:
      return static_cast<Real>(rng.between(-(1 << 20), 1 << 20));
    case Style::Lattice:
      return static_cast<Real>(rng.between(-32, 32)) / 8;
    case Style::Cad: {
      const double step = rng.coin() ? 0.1 : 0.001;
      return static_cast<Real>(rng.between(-100, 100) * step + (rng.coin() ? 0 : 12.7));
    }
    case Style::Georeferenced:
      return static_cast<Real>(500000.0 + rng.between(-100, 100) * 0.01);
    case Style::Halfway: {
      const int bits = Limits::digits - rng.between(0, 1);
      const auto odd = static_cast<std::int64_t>(rng.below(std::uint64_t{1} << bits)) | 1;
      const Real value = rng.one_in(3) ? Real(1) : static_cast<Real>(odd);
      return std::ldexp(rng.coin() ? value : -value, -rng.between(0, 3));
    }
    case Style::Huge:
      return scaled(kFloat ? 100 : 997);
    case Style::Tiny:
      return scaled(kFloat ? -100 : -997);
    case Style::NearOverflow:
      return std::ldexp(static_cast<Real>(rng.symmetric()),
                        Limits::max_exponent - rng.between(0, 3));
    case Style::Denormal:
      return rng.coin() ? static_cast<Real>(rng.between(-9, 9)) * Limits::denorm_min()
                        : scaled(Limits::min_exponent + rng.between(-20, 3));
    case Style::Critical: {
      const int factors = rng.between(2, 6);
      const int edge = rng.coin() ? Limits::max_exponent : Limits::min_exponent - Limits::digits;
      return scaled(edge / factors + rng.between(-3, 3));
    }
    case Style::AnyFinite:
      return any_finite<Real>(rng);
    case Style::Mixed:
      return number<Real>(rng, kAllStyles[rng.below(kAllStyles.size() - 1)]);
  }
  return 0;
}

template <class Real>
Vec3<Real> vec(Rng& rng, Style style) {
  const Real x = number<Real>(rng, style), y = number<Real>(rng, style);
  return {x, y, number<Real>(rng, style)};
}

/// The number moved by `steps` units in the last place, at once, as they may be a million; finite,
/// whatever it was.
template <class Real>
Real nudged(Real x, int steps) {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::int32_t, std::int64_t>;
  x = std::clamp(x, std::numeric_limits<Real>::lowest(), std::numeric_limits<Real>::max());
  if (steps == 0) return x;
  constexpr Bits kSign = std::numeric_limits<Bits>::min();
  constexpr auto kMost = std::bit_cast<Bits>(std::numeric_limits<Real>::max());
  const auto bits = std::bit_cast<Bits>(x);
  const Bits size = bits & ~kSign;  // floats of one sign are in the order of their bits
  const std::int64_t step = std::int64_t{bits < 0 ? -size : size} + steps;
  const auto found = static_cast<Bits>(std::min<std::int64_t>(std::abs(step), kMost));
  return std::bit_cast<Real>(step < 0 ? static_cast<Bits>(found | kSign) : found);
}

/// Each coordinate by up to `most` units in the last place.
template <class Real>
Vec3<Real> nudged(Rng& rng, const Vec3<Real>& p, int most) {
  const Real x = nudged(p.x, rng.between(-most, most)), y = nudged(p.y, rng.between(-most, most));
  return {x, y, nudged(p.z, rng.between(-most, most))};
}

/// A double as a finite Real; NaN as 0.
template <class Real>
Real finite(double x) {
  constexpr double kMost = std::numeric_limits<Real>::max();
  return std::isnan(x) ? Real(0) : static_cast<Real>(std::clamp(x, -kMost, kMost));
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
  return finite<Real>(std::ldexp(rng.symmetric(), e));
}

template <class Real>
Vec3<Real> in_cube(Rng& rng, double size) {
  const double x = rng.within(size), y = rng.within(size), z = rng.within(size);
  return finite<Real>(x, y, z);
}

template <class Real>
Real& component(Vec3<Real>& v, std::size_t axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

template <class Real>
bool is_finite(const Vec3<Real>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Real>
bool is_valid(const Ray<Real>& ray) {
  const Vec3<Real>& d = ray.direction;
  return is_finite(ray.origin) && is_finite(d) && (d.x != 0 || d.y != 0 || d.z != 0);
}

}  // namespace pierce::hard
