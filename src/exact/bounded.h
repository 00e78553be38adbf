// SPDX-License-Identifier: Apache-2.0
//
// Bounded: a rounded number that carries a bound on its own error, through +, -, *, / and the
// square root. For formulas of high degree, where a bound by the operands' largest magnitudes would
// be far too wide: here each step adds just what it lost.
//
// Every operation's error is what its operands' errors can make of it, plus its own rounding, plus
// what may underflow; kErrorRoom pays for the roundings of that sum itself. A bound that is
// inf or NaN is one of which no comparison is true, and so is a value that has overflowed: whoever
// asks is told nothing.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "exact/double_double.h"

namespace pierce::exact {

/// What an operation on T may lose: so much of its result (or, for sums of double-doubles, of its
/// operands), and so much more for underflow.
template <class T>
struct Loss;
template <>
struct Loss<double> {
  static constexpr double kRelative = 0x1p-53;
  static constexpr double kUnderflow = 0x1p-1000;
};
template <>
struct Loss<DoubleDouble> {
  static constexpr double kRelative = 8 * 0x1p-106;
  static constexpr double kUnderflow = 0x1p-1000;
};

/// The roundings of an error's own computation: at most eight, of 2^-53 each.
inline constexpr double kErrorRoom = 1 + 0x1p-49;

inline double magnitude(double a) { return std::fabs(a); }
inline double magnitude(const DoubleDouble& a) { return std::fabs(a.high) * (1 + 0x1p-52); }

template <class T>
struct Bounded {
  T value{};
  double err = 0;  // |value - true number| <= err
};

/// Whether it is 0 for sure.
template <class T>
bool is_zero(const Bounded<T>& a) {
  return magnitude(a.value) == 0 && a.err == 0;
}

inline Bounded<double> operator+(const Bounded<double>& a, const Bounded<double>& b) {
  const double sum = a.value + b.value;
  return {sum, (a.err + b.err + Loss<double>::kRelative * std::fabs(sum)) * kErrorRoom};
}

inline Bounded<DoubleDouble> operator+(const Bounded<DoubleDouble>& a,
                                       const Bounded<DoubleDouble>& b) {
  const double operands = magnitude(a.value) + magnitude(b.value);
  return {a.value + b.value,
          (a.err + b.err + Loss<DoubleDouble>::kRelative * operands) * kErrorRoom};
}

template <class T>
Bounded<T> operator-(const Bounded<T>& a) {
  return {-a.value, a.err};
}

template <class T>
Bounded<T> operator-(const Bounded<T>& a, const Bounded<T>& b) {
  return a + -b;
}

template <class T>
Bounded<T> operator*(const Bounded<T>& a, const Bounded<T>& b) {
  const T product = a.value * b.value;
  // Errors, too, may underflow; nothing does in a product with zero: exact zeros stay exact.
  if (is_zero(a) || is_zero(b)) return {};
  const double lost = Loss<T>::kRelative * magnitude(product) + Loss<T>::kUnderflow;
  const double inherited = magnitude(a.value) * b.err + (magnitude(b.value) + b.err) * a.err;
  return {product, (inherited + lost) * kErrorRoom};
}

/// Zero divided by anything is zero: the denominators here are squares that are not zero. Nothing
/// is known of a quotient whose denominator may be less than half its value: err is inf.
template <class T>
Bounded<T> operator/(const Bounded<T>& a, const Bounded<T>& b) {
  if (is_zero(a)) return {};
  const T quotient = a.value / b.value;
  const double least = magnitude(b.value) * (1 - 0x1p-51) - b.err;
  if (!(least > b.err)) return {quotient, std::numeric_limits<double>::infinity()};
  const double size = magnitude(quotient);
  // A double-double quotient is off by 28 * 2^-106, its two inner operations and its own
  // (docs/algorithm.md, "Rounding"): within four times one's loss; and what underflows in the inner
  // product is divided by b.
  const double inner = std::is_same_v<T, double> ? 0 : Loss<T>::kUnderflow / least;
  const double lost = 4 * Loss<T>::kRelative * size + Loss<T>::kUnderflow + inner;
  return {quotient, ((a.err + size * b.err) / least * (1 + 0x1p-40) + lost) * kErrorRoom};
}

inline DoubleDouble square_root(const DoubleDouble& a) {
  const double first = std::sqrt(a.high);
  const DoubleDouble rest = a - two_product(first, first);
  return quick_two_sum(first, rest.high / (2 * first));
}
inline double square_root(double a) { return std::sqrt(a); }

/// Nothing is known of the root of a number that may be less than three quarters of its value.
template <class T>
Bounded<T> square_root(const Bounded<T>& a) {
  if (is_zero(a)) return {};
  const T root = square_root(a.value);
  const double size = magnitude(root);
  const bool usable = magnitude(a.value) > 8 * a.err && size > 0x1p-400;
  if (!usable) return {root, std::numeric_limits<double>::infinity()};
  // |sqrt(x +- e) - sqrt(x)| <= 0.54 e / sqrt(x) for e <= x / 8; the root itself is off by 13 *
  // 2^-106 (docs/algorithm.md, "Nearest points").
  return {root, (0.75 * a.err / size + 4 * Loss<T>::kRelative * size) * kErrorRoom};
}

}  // namespace pierce::exact
