// SPDX-License-Identifier: Apache-2.0
//
// Floating-point numbers of many bits, for what has roots in it.
#pragma once

#include "exact/big_int.h"
// After that, which quietens g++ about what both include:
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace pierce::exact {

/// Sums, products, quotients and roots are correctly rounded to so many bits; exponents never end.
template <unsigned Bits>
using WideFloat = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<Bits, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

}  // namespace pierce::exact
