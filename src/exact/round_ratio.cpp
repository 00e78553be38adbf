// SPDX-License-Identifier: Apache-2.0
#include "exact/round_ratio.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pierce::exact {

template <class Real>
Real round_ratio(const BigInt& numerator, const BigInt& denominator, int exponent) {
  using Limits = std::numeric_limits<Real>;
  constexpr int kDigits = Limits::digits;
  constexpr int kLowestPlace = Limits::min_exponent - kDigits;  // exponent of the least subnormal
  const int sign = numerator.sign() * denominator.sign();
  if (sign == 0) return 0;
  const BigInt n = abs(numerator);
  const BigInt d = abs(denominator);

  // The ratio lies in (2^(size - 1), 2^(size + 1)). Take an integer quotient at a place at least
  // two below the last one kept, so that two bits and the remainder say how to round.
  const int size = bit_length(n) - bit_length(d) + exponent;
  const int place = std::max(size - kDigits - 2, kLowestPlace - 2);
  const int shift = exponent - place;
  BigInt quotient_big;
  BigInt remainder;
  if (shift >= 0) {
    divide_qr(BigInt(n << shift), d, quotient_big, remainder);
  } else if (-shift > bit_length(n)) {
    remainder = 1;  // a ratio far below the least subnormal: quotient 0, something left over
  } else {
    divide_qr(n, BigInt(d << -shift), quotient_big, remainder);
  }
  const auto quotient = static_cast<std::uint64_t>(quotient_big);

  const int last =
      std::max(place + static_cast<int>(std::bit_width(quotient)) - kDigits, kLowestPlace);
  const int drop = last - place;  // at least 1; the quotient has at most kDigits + 3 bits
  const std::uint64_t half = std::uint64_t{1} << (drop - 1);
  const std::uint64_t kept = quotient >> drop;
  const std::uint64_t rest = quotient & (2 * half - 1);
  const bool up = rest > half || (rest == half && (!remainder.is_zero() || (kept & 1U) != 0));
  const double magnitude = std::ldexp(static_cast<double>(kept + (up ? 1 : 0)), last);
  // For float, ldexp is exact in double and the cast is exact or overflows to inf as it should:
  // the value has at most 24 bits, so it is either at most FLT_MAX or at least 2^128.
  const Real result = magnitude > static_cast<double>(Limits::max()) ? Limits::infinity()
                                                                     : static_cast<Real>(magnitude);
  return sign < 0 && result != 0 ? -result : result;  // zero is +0
}

template float round_ratio<float>(const BigInt&, const BigInt&, int);
template double round_ratio<double>(const BigInt&, const BigInt&, int);

}  // namespace pierce::exact
