// SPDX-License-Identifier: Apache-2.0
//
// One number of a file as a float or double: fractions are rounded to nearest, integers are taken
// exactly or refused.
#pragma once

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>

#include "io/bad_file.h"

namespace pierce::io {

/// An IEEE half, as it stands in the file.
struct Half {
  std::uint16_t bits;
};

/// Exactly.
inline float to_float(Half half) {
  const std::uint32_t sign = (half.bits & 0x8000u) << 16;
  const std::uint32_t exponent = (half.bits >> 10) & 31u, mantissa = half.bits & 0x3ffu;
  if (exponent == 31) return std::bit_cast<float>(sign | 0x7f800000u | mantissa << 13);
  if (exponent > 0) return std::bit_cast<float>(sign | (exponent + 112) << 23 | mantissa << 13);
  const float magnitude = static_cast<float>(mantissa) * 0x1p-24f;
  return std::bit_cast<float>(sign | std::bit_cast<std::uint32_t>(magnitude));
}

/// False if the number cannot be had: finite and beyond the floats, or an integer that is no Real.
template <class Number, class Real>
inline bool convert_number(Number number, Real& out) {
  if constexpr (std::is_same_v<Number, Half>) {
    out = static_cast<Real>(to_float(number));
    return true;
  } else {
    out = static_cast<Real>(number);
    if constexpr (std::is_integral_v<Number>) {
      if constexpr (std::numeric_limits<Number>::digits <= std::numeric_limits<Real>::digits) {
        return true;
      } else {
        // Both ends are powers of two, or the least integer itself: exact as Reals.
        constexpr Real kEnd =
            Real(std::uint64_t{1} << (std::numeric_limits<Number>::digits - 1)) * 2;
        return out < kEnd && static_cast<Number>(out) == number;
      }
    } else if constexpr (sizeof(Number) > sizeof(Real)) {
      return std::isfinite(out) || !std::isfinite(number);
    } else {
      return true;
    }
  }
}

/// Throws the Error (BadFile) for a number that convert_number refused.
template <class Real, class Number>
[[noreturn]] void fail_number(std::string_view name, std::uint64_t row, Number number) {
  if constexpr (std::is_same_v<Number, Half>) {
    bad_file(name, "a half that is no float");  // there is none
  } else {
    const char* trouble = " does not fit the range of float: use double precision";
    if constexpr (std::is_integral_v<Number>) {
      trouble = std::is_same_v<Real, float>
                    ? " is an integer that float cannot hold exactly: use double precision, or "
                      "round it with astype"
                    : " is an integer that double cannot hold exactly: round it with astype('f8')";
    }
    bad_file(name, fmt::format("row {}: {}{}", row, number, trouble), row);
  }
}

}  // namespace pierce::io
