// SPDX-License-Identifier: Apache-2.0
//
// Is a number finite? As std::isfinite and its like, but always inline: of an inline function that
// is called the linker keeps one copy for the whole program, and that may be the one of a caller
// who is compiled with -ffast-math, where every number is finite.
#pragma once

#include "pierce/types.h"

namespace pierce {

template <class Real>
[[gnu::always_inline]] inline bool is_finite_number(Real x) {
  return x - x == 0;
}

template <class Real>
[[gnu::always_inline]] inline bool is_nan(Real x) {
  return x != x;
}

template <class Real>
[[gnu::always_inline]] inline bool is_infinite(Real x) {
  return x == kInfinity<Real> || x == -kInfinity<Real>;
}

}  // namespace pierce
