// SPDX-License-Identifier: Apache-2.0
//
// Exact fractions, as text and as the nearest float: the exact side of `pierce triangle` and
// `pierce textbook`.
#pragma once

#include <string>

#include "exact/big_int.h"

namespace pierce::tool {

/// Always in lowest terms; of BigInts.
using Fraction = boost::multiprecision::number<
    boost::multiprecision::rational_adaptor<exact::BigInt::backend_type>,
    boost::multiprecision::et_off>;

/// "1/3", "-5", "0".
[[nodiscard]] std::string as_fraction(const Fraction& x);

/// The decimal of so many significant digits that is nearest to x (ties to even), without trailing
/// zeros: "0.33333", "1.5e-12".
[[nodiscard]] std::string as_decimal(const Fraction& x, int digits);

/// Whether x is a decimal of at most so many significant digits: whether as_decimal is x itself.
[[nodiscard]] bool is_decimal(const Fraction& x, int digits);

/// The nearest float or double, ties to even.
template <class Real>
[[nodiscard]] Real nearest(const Fraction& x);

/// A fraction to twice the precision of double, for measuring how far numbers are from it:
/// (head + tail) * 2^exponent.
struct Reference {
  double head = 0, tail = 0;
  int exponent = 0;
};

[[nodiscard]] Reference reference(const Fraction& x);

/// How far `computed` is from `exact`, in units of the last place that a Real as large as `exact`
/// has. A correctly rounded number is off by at most 0.5. Infinite for a NaN or an infinity.
template <class Real>
[[nodiscard]] double error_in_ulp(Real computed, const Reference& exact);

extern template float nearest(const Fraction&);
extern template double nearest(const Fraction&);
extern template double error_in_ulp(float, const Reference&);
extern template double error_in_ulp(double, const Reference&);
extern template double error_in_ulp(long double, const Reference&);

}  // namespace pierce::tool
