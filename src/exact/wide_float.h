// SPDX-License-Identifier: Apache-2.0
//
// Floating-point numbers of many bits, for what has roots in it.
#pragma once

#include "exact/big_int.h"
#include "exact/binary_parts.h"
#include "exact/round_ratio.h"
// After that, which quietens g++ about what both include:
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace pierce::exact {

/// Sums, products, quotients and roots are correctly rounded to so many bits; exponents never end.
template <unsigned Bits>
using WideFloat = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<Bits, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

// To double and back by integers alone. What Boost has for it computes with double, in functions of
// which a caller's program may have a copy that was compiled with -ffast-math.

template <unsigned Bits>
WideFloat<Bits> widen(double x) {
  const BinaryParts parts = binary_parts(x);
  return ldexp(WideFloat<Bits>(parts.significand), parts.exponent);
}

/// Rounded to nearest.
template <unsigned Bits>
double narrow(const WideFloat<Bits>& x) {
  if (x.is_zero()) return 0;
  const auto& parts = x.backend();
  const BigInt significand(parts.bits());
  return round_ratio<double>(parts.sign() ? BigInt(-significand) : significand, 1,
                             static_cast<int>(parts.exponent()) - static_cast<int>(Bits) + 1);
}

}  // namespace pierce::exact
