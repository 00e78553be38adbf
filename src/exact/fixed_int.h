// SPDX-License-Identifier: Apache-2.0
//
// FixedInt<N>: signed integers of N digits to the base 2^62, on the stack.
//
// The fast exact rung: coordinates that share a common power of two become integers, and every
// determinant of them is an integer too. Products are as wide as their factors together, so they
// are always exact; sums keep the width, and whoever adds sees to it that there is room (see
// scaled_integers.h, which leaves spare bits at the top for exactly the sums in determinants.h).
//
// Digits have signs of their own, so that a product of two is one signed multiplication, and are
// two bits shorter than a word, so that a sum of some thirty products fits in 128 bits: whole cross
// products and scalar products are summed digit by digit, and carried once at the end.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace pierce::exact {

__extension__ using Uint128 = unsigned __int128;
__extension__ using Int128 = __int128;

inline constexpr int kDigitBits = 62;

/// All digits but the last are in [-2^61, 2^61), so that there is one way to write a number.
template <std::size_t N>
struct FixedInt {
  std::array<std::int64_t, N> digit{};  // least significant first
};

/// The nearest digit to what its last 62 bits say; the rest is a multiple of 2^62.
inline std::int64_t low_digit(std::uint64_t x) { return static_cast<std::int64_t>(x << 2) >> 2; }

/// -1, 0 or 1: the sign of the highest digit that is not 0, for those below are less than one of
/// it.
template <std::size_t N>
int sign_of(const FixedInt<N>& a) {
  for (std::size_t i = N; i-- > 0;) {
    if (a.digit[i] != 0) return a.digit[i] < 0 ? -1 : 1;
  }
  return 0;
}

/// Adds what was carried to a digit, and carries what is more than a digit.
template <class Sum>
void carry_on(Sum sum, std::int64_t& digit, Sum& carry) {
  sum += carry;
  digit = low_digit(static_cast<std::uint64_t>(sum));
  carry = (sum - digit) >> kDigitBits;
}

/// The same number, its digits within 2^62 before.
template <std::size_t N>
FixedInt<N> carried(const FixedInt<N>& a) {
  FixedInt<N> result;
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < N; ++i) carry_on(a.digit[i], result.digit[i], carry);
  result.digit[N - 1] = a.digit[N - 1] + carry;
  return result;
}

template <std::size_t N>
FixedInt<N> operator+(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> sum;
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < N; ++i) carry_on(a.digit[i] + b.digit[i], sum.digit[i], carry);
  sum.digit[N - 1] = a.digit[N - 1] + b.digit[N - 1] + carry;
  return sum;
}

template <std::size_t N>
FixedInt<N> operator-(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> sum;
  std::int64_t carry = 0;
  for (std::size_t i = 0; i + 1 < N; ++i) carry_on(a.digit[i] - b.digit[i], sum.digit[i], carry);
  sum.digit[N - 1] = a.digit[N - 1] - b.digit[N - 1] + carry;
  return sum;
}

template <std::size_t N>
FixedInt<N> operator-(const FixedInt<N>& a) {
  return FixedInt<N>{} - a;
}

/// Sums of products, not carried yet: that of the digits i and j is part of column i + j.
template <std::size_t A, std::size_t B>
struct ProductSum {
  std::array<Int128, A + B - 1> column{};

  // A column has min(A, B) digits' products of each two numbers, of 2^122 at most; but where one or
  // both are a last digit, which may be 2^62, twice or four times that. So it has room for `count`
  // products of two numbers, with what is carried.
  static constexpr bool has_room(std::size_t count) { return count * (std::min(A, B) + 2) < 32; }

  void add(const FixedInt<A>& a, const FixedInt<B>& b) {
    for (std::size_t i = 0; i < A; ++i) {
      for (std::size_t j = 0; j < B; ++j) column[i + j] += Int128{a.digit[i]} * b.digit[j];
    }
  }
  void take_off(const FixedInt<A>& a, const FixedInt<B>& b) {
    for (std::size_t i = 0; i < A; ++i) {
      for (std::size_t j = 0; j < B; ++j) column[i + j] -= Int128{a.digit[i]} * b.digit[j];
    }
  }
  [[nodiscard]] FixedInt<A + B> carried() const {
    FixedInt<A + B> result;
    Int128 carry = 0;
    for (std::size_t k = 0; k + 1 < A + B; ++k) carry_on(column[k], result.digit[k], carry);
    result.digit[A + B - 1] = static_cast<std::int64_t>(carry);
    return result;
  }
};

template <std::size_t A, std::size_t B>
FixedInt<A + B> operator*(const FixedInt<A>& a, const FixedInt<B>& b) {
  ProductSum<A, B> product;
  static_assert(ProductSum<A, B>::has_room(1));
  product.add(a, b);
  return product.carried();
}

/// a b - c d.
template <std::size_t A, std::size_t B>
FixedInt<A + B> difference_of_products(const FixedInt<A>& a, const FixedInt<B>& b,
                                       const FixedInt<A>& c, const FixedInt<B>& d) {
  ProductSum<A, B> sum;
  static_assert(ProductSum<A, B>::has_room(2));
  sum.add(a, b);
  sum.take_off(c, d);
  return sum.carried();
}

/// a b + c d + e f.
template <std::size_t A, std::size_t B>
FixedInt<A + B> sum_of_products(const FixedInt<A>& a, const FixedInt<B>& b, const FixedInt<A>& c,
                                const FixedInt<B>& d, const FixedInt<A>& e, const FixedInt<B>& f) {
  ProductSum<A, B> sum;
  static_assert(ProductSum<A, B>::has_room(3));
  sum.add(a, b);
  sum.add(c, d);
  sum.add(e, f);
  return sum.carried();
}

/// The same number in at least as many digits.
template <std::size_t M, std::size_t N>
FixedInt<M> widened(const FixedInt<N>& a) {
  static_assert(M >= N);
  FixedInt<M> wide;
  for (std::size_t i = 0; i < N; ++i) wide.digit[i] = a.digit[i];
  return carried(wide);
}

/// |a| in words of 64 bits, the least significant first.
template <std::size_t N>
std::array<std::uint64_t, N> magnitude(const FixedInt<N>& a) {
  const bool negative = sign_of(a) < 0;
  std::array<std::uint64_t, N> words{};
  Int128 rest = 0;  // what the words so far do not hold, and its place in the next one
  unsigned filled = 0;
  std::size_t word = 0;
  for (std::size_t i = 0; i < N; ++i) {
    rest += Int128{negative ? -a.digit[i] : a.digit[i]} * (Int128{1} << filled);
    words[word] = static_cast<std::uint64_t>(rest);
    filled += kDigitBits;
    if (filled >= 64) {
      rest >>= 64;
      filled -= 64;
      ++word;
    }
  }
  if (word < N) words[word] = static_cast<std::uint64_t>(rest);
  return words;
}

template <std::size_t N>
int bit_length(const std::array<std::uint64_t, N>& words) {
  for (std::size_t i = N; i-- > 0;) {
    if (words[i] != 0) {
      return static_cast<int>(64 * i) + static_cast<int>(std::bit_width(words[i]));
    }
  }
  return 0;
}

/// Number of bits of |a|; 0 for 0.
template <std::size_t N>
int bit_length(const FixedInt<N>& a) {
  return bit_length(magnitude(a));
}

/// The 64 bits of a number that end at bit `end`; bits beyond the first one are 0.
template <std::size_t N>
std::uint64_t bits_before(const std::array<std::uint64_t, N>& words, int end) {
  if (end <= 0) return 0;
  const auto last = static_cast<std::size_t>(end - 1) / 64;
  const auto unused = static_cast<unsigned>(63 - (end - 1) % 64);
  std::uint64_t bits = words[last] << unused;
  if (unused > 0 && last > 0) bits |= words[last - 1] >> (64 - unused);
  return bits;
}

/// Sign of a * 2^shift - b, for any shift: equal signs are told apart by length, and equal lengths
/// from their first bits on.
template <std::size_t A, std::size_t B>
int compare_scaled(const FixedInt<A>& a, int shift, const FixedInt<B>& b) {
  const int a_sign = sign_of(a);
  const int b_sign = sign_of(b);
  if (a_sign != b_sign) return a_sign < b_sign ? -1 : 1;
  if (a_sign == 0) return 0;
  const auto a_words = magnitude(a);
  const auto b_words = magnitude(b);
  int a_end = bit_length(a_words), b_end = bit_length(b_words);
  const int longer = a_end + shift - b_end;
  if (longer != 0) return longer > 0 ? a_sign : -a_sign;
  for (; a_end > 0 || b_end > 0; a_end -= 64, b_end -= 64) {
    const std::uint64_t a_bits = bits_before(a_words, a_end), b_bits = bits_before(b_words, b_end);
    if (a_bits != b_bits) return a_bits > b_bits ? a_sign : -a_sign;
  }
  return 0;
}

}  // namespace pierce::exact
