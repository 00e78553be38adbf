// SPDX-License-Identifier: Apache-2.0
#include "exact/round_ratio.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "exact/round_places.h"

namespace pierce::exact {
namespace {

// floor(n 2^shift / d), and whether that is all; n and d are positive.
struct Quotient {
  BigInt floor;
  bool more;
};

Quotient divided(const BigInt& n, const BigInt& d, int shift) {
  if (shift < -bit_length(n)) return {0, true};  // far below 1, and n << 0 over a giant
  BigInt quotient;
  BigInt rest;
  if (shift >= 0) {
    divide_qr(BigInt(n << shift), d, quotient, rest);
  } else {
    divide_qr(n, BigInt(d << -shift), quotient, rest);
  }
  return {quotient, !rest.is_zero()};
}

}  // namespace

template <class Real>
Real round_ratio(const BigInt& numerator, const BigInt& denominator, int exponent) {
  const int sign = numerator.sign() * denominator.sign();
  if (sign == 0) return 0;
  const BigInt n = abs(numerator);
  const BigInt d = abs(denominator);

  // The ratio lies in (2^(size - 1), 2^(size + 1)). Take an integer quotient at a place at least
  // two below the last one kept, so that two bits and the remainder say how to round.
  const int size = bit_length(n) - bit_length(d) + exponent;
  const int place =
      std::max(size - std::numeric_limits<Real>::digits - 2, lowest_place<Real>() - 2);
  const Quotient quotient = divided(n, d, exponent - place);
  const Real result =
      round_places<Real>(static_cast<std::uint64_t>(quotient.floor), quotient.more, place);
  return sign < 0 && result != 0 ? -result : result;  // zero is +0
}

template <class Real>
Real round_root(const BigInt& numerator, const BigInt& denominator, int exponent) {
  if (numerator.is_zero()) return 0;
  // The ratio's root lies in (2^((size - 1) / 2), 2^((size + 1) / 2)); `half` is the floor of
  // size / 2. The root of the floor of a number has the same floor as the number's own root.
  const int size = bit_length(numerator) - bit_length(denominator) + 2 * exponent;
  const int half = (size - (size < 0 ? 1 : 0)) / 2;
  const int place =
      std::max(half - std::numeric_limits<Real>::digits - 3, lowest_place<Real>() - 2);
  const Quotient square = divided(numerator, denominator, 2 * (exponent - place));
  BigInt rest;
  const BigInt root = sqrt(square.floor, rest);
  return round_places<Real>(static_cast<std::uint64_t>(root), square.more || !rest.is_zero(),
                            place);
}

template float round_ratio<float>(const BigInt&, const BigInt&, int);
template double round_ratio<double>(const BigInt&, const BigInt&, int);
template float round_root<float>(const BigInt&, const BigInt&, int);
template double round_root<double>(const BigInt&, const BigInt&, int);

}  // namespace pierce::exact
