// SPDX-License-Identifier: Apache-2.0
//
// An exact fraction, or the root of one, rounded once to float or double.
#pragma once

#include "exact/big_int.h"

namespace pierce::exact {

/// numerator / denominator * 2^exponent rounded to the nearest Real, ties to even; subnormal
/// results are rounded once, at their own last place; too large is +-inf as in IEEE 754; zero is
/// +0. The denominator must not be zero; either may be negative. `Real` is float or double.
template <class Real>
Real round_ratio(const BigInt& numerator, const BigInt& denominator, int exponent);

/// The square root of numerator / denominator, times 2^exponent, rounded likewise. The numerator is
/// not negative, the denominator positive.
template <class Real>
Real round_root(const BigInt& numerator, const BigInt& denominator, int exponent);

extern template float round_ratio<float>(const BigInt&, const BigInt&, int);
extern template double round_ratio<double>(const BigInt&, const BigInt&, int);
extern template float round_root<float>(const BigInt&, const BigInt&, int);
extern template double round_root<double>(const BigInt&, const BigInt&, int);

}  // namespace pierce::exact
