// SPDX-License-Identifier: Apache-2.0
//
// DoubleDouble: an unevaluated sum of two doubles, for about 100 correct bits.
//
// The error of each operation is at most 8 * 2^-106 times the product of the operands' magnitudes
// (for products) or the sum of them (for sums), as long as nothing overflows and no product of the
// high parts is below 2^-900; smaller ones add an absolute error below 2^-1070. The bounds are
// generous: see docs/algorithm.md. Sources: Dekker 1971; Joldes, Muller, Popescu 2017.
#pragma once

#include "exact/arithmetic.h"

namespace pierce::exact {

struct DoubleDouble {
  double high = 0, low = 0;  // |low| at most half an ulp of high
};

/// high + low == a + b exactly (Knuth).
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  const double a_part = sum - b_part;
  return {sum, (a - a_part) + (b - b_part)};
}

/// The same when |a| >= |b| or a == 0 (Dekker).
inline DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

/// high + low == a * b exactly unless something under- or overflows (Dekker, Veltkamp).
inline DoubleDouble two_product(double a, double b) {
  constexpr double kSplitter = 0x1p27 + 1;
  const double product = a * b;
  const double a_big = kSplitter * a;
  const double a_high = a_big - (a_big - a);
  const double a_low = a - a_high;
  const double b_big = kSplitter * b;
  const double b_high = b_big - (b_big - b);
  const double b_low = b - b_high;
  const double error =
      ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
  return {product, error};
}

inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.high, -a.low}; }

inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.high, b.high);
  return quick_two_sum(sum.high, sum.low + (a.low + b.low));
}

inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + -b; }

inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble product = two_product(a.high, b.high);
  return quick_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

inline DoubleDouble operator*(const DoubleDouble& a, double b) {
  const DoubleDouble product = two_product(a.high, b);
  return quick_two_sum(product.high, product.low + a.low * b);
}

inline DoubleDouble operator*(double a, const DoubleDouble& b) { return b * a; }

/// One Newton correction of the double quotient.
inline DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
  const double first = a.high / b.high;
  const DoubleDouble rest = a - b * first;
  return quick_two_sum(first, rest.high / b.high);
}

}  // namespace pierce::exact
