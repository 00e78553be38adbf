// SPDX-License-Identifier: Apache-2.0
//
// FixedInt<N>: signed integers of N 64-bit limbs, two's complement, on the stack.
//
// The fast exact rung: coordinates that share a common power of two become integers, and every
// determinant of them is an integer too. Products are as wide as their factors together, so they
// are always exact; sums keep the width, and whoever adds sees to it that there is room (see
// scaled_integers.h, which leaves spare bits at the top for exactly the sums in determinants.h).
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace pierce::exact {

__extension__ using Uint128 = unsigned __int128;
__extension__ using Int128 = __int128;

template <std::size_t N>
struct FixedInt {
  std::array<std::uint64_t, N> limb{};  // least significant first

  [[nodiscard]] bool negative() const { return (limb[N - 1] >> 63) != 0; }
};

/// -1, 0 or 1.
template <std::size_t N>
int sign_of(const FixedInt<N>& a) {
  if (a.negative()) return -1;
  for (const std::uint64_t word : a.limb) {
    if (word != 0) return 1;
  }
  return 0;
}

template <std::size_t N>
FixedInt<N> operator+(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> sum;
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const Uint128 s = static_cast<Uint128>(a.limb[i]) + b.limb[i] + carry;
    sum.limb[i] = static_cast<std::uint64_t>(s);
    carry = static_cast<std::uint64_t>(s >> 64);
  }
  return sum;
}

template <std::size_t N>
FixedInt<N> operator-(const FixedInt<N>& a, const FixedInt<N>& b) {
  FixedInt<N> difference;
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const Uint128 s = static_cast<Uint128>(a.limb[i]) - b.limb[i] - borrow;
    difference.limb[i] = static_cast<std::uint64_t>(s);
    borrow = static_cast<std::uint64_t>(s >> 64) & 1U;
  }
  return difference;
}

template <std::size_t N>
FixedInt<N> operator-(const FixedInt<N>& a) {
  return FixedInt<N>{} - a;
}

/// Exact product, limb by limb: all but the last one are unsigned. What is carried is within 2^63,
/// so that it fits beside a product.
template <std::size_t A>
FixedInt<A + 1> operator*(const FixedInt<A>& a, const FixedInt<1>& b) {
  const auto factor = static_cast<std::int64_t>(b.limb[0]);
  FixedInt<A + 1> product;
  Int128 sum = 0;
  for (std::size_t i = 0; i < A; ++i) {
    const Int128 limb =
        i + 1 == A ? Int128{static_cast<std::int64_t>(a.limb[i])} : static_cast<Int128>(a.limb[i]);
    sum = limb * factor + (sum >> 64);
    product.limb[i] = static_cast<std::uint64_t>(sum);
  }
  product.limb[A] = static_cast<std::uint64_t>(sum >> 64);
  return product;
}
template <std::size_t B>
requires(B > 1) FixedInt<1 + B>
operator*(const FixedInt<1>& a, const FixedInt<B>& b) { return b * a; }

/// Exact product. The unsigned product of the limbs counts a negative a as a + 2^(64 A), which
/// adds b 2^(64 A) too much; taking it off again (and the same for b) gives the signed product.
template <std::size_t A, std::size_t B>
requires(A > 1 && B > 1) FixedInt<A + B>
operator*(const FixedInt<A>& a, const FixedInt<B>& b) {
  FixedInt<A + B> product;
  for (std::size_t i = 0; i < A; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < B; ++j) {
      const Uint128 s = static_cast<Uint128>(a.limb[i]) * b.limb[j] + product.limb[i + j] + carry;
      product.limb[i + j] = static_cast<std::uint64_t>(s);
      carry = static_cast<std::uint64_t>(s >> 64);
    }
    product.limb[i + B] = carry;
  }
  const auto take_off = [&product](const auto& factor, std::size_t from) {
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; from + i < A + B; ++i) {
      const Uint128 s = static_cast<Uint128>(product.limb[from + i]) - factor.limb[i] - borrow;
      product.limb[from + i] = static_cast<std::uint64_t>(s);
      borrow = static_cast<std::uint64_t>(s >> 64) & 1U;
    }
  };
  if (a.negative()) take_off(b, A);
  if (b.negative()) take_off(a, B);
  return product;
}

/// The same number in at least as many limbs.
template <std::size_t M, std::size_t N>
FixedInt<M> widened(const FixedInt<N>& a) {
  static_assert(M >= N);
  FixedInt<M> wide;
  for (std::size_t i = 0; i < M; ++i) {
    wide.limb[i] = i < N ? a.limb[i] : (a.negative() ? ~std::uint64_t{0} : 0);
  }
  return wide;
}

/// a * 2^shift; the result must fit.
template <std::size_t N>
FixedInt<N> shifted_left(const FixedInt<N>& a, unsigned shift) {
  const std::size_t words = shift / 64;
  const unsigned bits = shift % 64;
  FixedInt<N> result;
  for (std::size_t i = N; i-- > words;) {
    const std::uint64_t low = a.limb[i - words];
    const std::uint64_t below = i > words ? a.limb[i - words - 1] : 0;
    result.limb[i] = bits == 0 ? low : (low << bits) | (below >> (64 - bits));
  }
  return result;
}

/// Number of bits of |a|; 0 for 0.
template <std::size_t N>
int bit_length(const FixedInt<N>& a) {
  const FixedInt<N> magnitude = a.negative() ? -a : a;
  for (std::size_t i = N; i-- > 0;) {
    if (magnitude.limb[i] != 0) {
      return static_cast<int>(64 * i) + static_cast<int>(std::bit_width(magnitude.limb[i]));
    }
  }
  return 0;
}

/// Sign of a * 2^shift - b, for any shift: equal signs are told apart by length, and only equal
/// lengths need the shift, which then fits in the wider of the two.
template <std::size_t A, std::size_t B>
int compare_scaled(const FixedInt<A>& a, int shift, const FixedInt<B>& b) {
  const int a_sign = sign_of(a);
  const int b_sign = sign_of(b);
  if (a_sign != b_sign) return a_sign < b_sign ? -1 : 1;
  if (a_sign == 0) return 0;
  const int longer = bit_length(a) + shift - bit_length(b);
  if (longer != 0) return longer > 0 ? a_sign : -a_sign;
  constexpr std::size_t kWide = (A > B ? A : B) + 1;  // one more for the sign
  auto a_wide = widened<kWide>(a);
  auto b_wide = widened<kWide>(b);
  if (shift > 0) a_wide = shifted_left(a_wide, static_cast<unsigned>(shift));
  if (shift < 0) b_wide = shifted_left(b_wide, static_cast<unsigned>(-shift));
  return sign_of(a_wide - b_wide);
}

}  // namespace pierce::exact
