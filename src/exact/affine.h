// SPDX-License-Identifier: Apache-2.0
//
// One coordinate of an affine map: m0 x + m1 y + m2 z + m3, rounded once.
#pragma once

#include <array>
#include <optional>

namespace pierce::exact {

/// The exact value rounded to the nearest Real, ties to even; too large is +-inf as in IEEE 754;
/// zero is +0. All numbers are finite. `Real` is float or double. Some nanoseconds, half a
/// microsecond where only integers can tell.
template <class Real>
Real round_affine(const std::array<Real, 4>& m, Real x, Real y, Real z);

/// Its two rungs: double arithmetic that knows when it cannot tell, and integers of any size.
template <class Real>
std::optional<Real> certify_affine(const std::array<Real, 4>& m, Real x, Real y, Real z);
template <class Real>
Real round_affine_exactly(const std::array<Real, 4>& m, Real x, Real y, Real z);

extern template float round_affine(const std::array<float, 4>&, float, float, float);
extern template double round_affine(const std::array<double, 4>&, double, double, double);
extern template std::optional<float> certify_affine(const std::array<float, 4>&, float, float,
                                                    float);
extern template std::optional<double> certify_affine(const std::array<double, 4>&, double, double,
                                                     double);
extern template float round_affine_exactly(const std::array<float, 4>&, float, float, float);
extern template double round_affine_exactly(const std::array<double, 4>&, double, double, double);

}  // namespace pierce::exact
