// SPDX-License-Identifier: Apache-2.0
//
// BigInt: integers of any size, the last rung. The same vocabulary as FixedInt, so that one text
// serves both: sign_of, bit_length, compare_scaled.
#pragma once

// g++ 12 at -O3 follows the unused half of the library's small-buffer union and warns about it.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Warray-bounds"
#endif
#include <boost/multiprecision/cpp_int.hpp>
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif
#include <cstddef>

#include "exact/fixed_int.h"

namespace pierce::exact {

/// Up to so many bits a BigInt asks for no memory: enough for the determinants of numbers of 600
/// bits. (It moves only what it uses of them.)
inline constexpr unsigned kBitsInPlace = 2048;

/// Expression templates off: `auto` must hold values.
using BigInt = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<kBitsInPlace>,
                                             boost::multiprecision::et_off>;

inline int sign_of(const BigInt& a) { return a.sign(); }

inline int bit_length(const BigInt& a) {
  return a.is_zero() ? 0 : static_cast<int>(boost::multiprecision::msb(abs(a))) + 1;
}

inline int compare_scaled(const BigInt& a, int shift, const BigInt& b) {
  const int a_sign = a.sign();
  const int b_sign = b.sign();
  if (a_sign != b_sign) return a_sign < b_sign ? -1 : 1;
  if (a_sign == 0) return 0;
  const int longer = bit_length(a) + shift - bit_length(b);
  if (longer != 0) return longer > 0 ? a_sign : -a_sign;
  const BigInt difference = shift >= 0 ? BigInt((a << shift) - b) : BigInt(a - (b << -shift));
  return difference.sign();
}

inline const BigInt& to_big(const BigInt& a) { return a; }

template <std::size_t N>
BigInt to_big(const FixedInt<N>& a) {
  BigInt result = 0;
  const auto words = magnitude(a);
  for (std::size_t i = N; i-- > 0;) result = (result << 64) | words[i];
  return sign_of(a) < 0 ? BigInt(-result) : result;
}

}  // namespace pierce::exact
