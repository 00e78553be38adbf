// SPDX-License-Identifier: Apache-2.0
//
// One coordinate of an affine map: m0 x + m1 y + m2 z + m3, rounded once.
#pragma once

#include <array>
#include <cmath>
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

/// As round_affine does it, but of most floats without a call.
inline float round_affine_fast(const std::array<float, 4>& m, float x, float y, float z) {
  const auto wide = [](float a) { return static_cast<double>(a); };
  // Products of floats are doubles; three sums lose at most 3 * 2^-53 of the magnitudes.
  const double px = wide(m[0]) * wide(x), py = wide(m[1]) * wide(y), pz = wide(m[2]) * wide(z);
  const double sum = (px + py) + (pz + wide(m[3]));
  const double off =
      0x1p-51 * ((std::fabs(px) + std::fabs(py)) + (std::fabs(pz) + std::fabs(wide(m[3]))));
  const auto low = static_cast<float>(sum - off);
  return low == static_cast<float>(sum + off) ? low + 0.0F : round_affine(m, x, y, z);
}
inline double round_affine_fast(const std::array<double, 4>& m, double x, double y, double z) {
  return round_affine(m, x, y, z);
}

extern template float round_affine(const std::array<float, 4>&, float, float, float);
extern template double round_affine(const std::array<double, 4>&, double, double, double);
extern template std::optional<float> certify_affine(const std::array<float, 4>&, float, float,
                                                    float);
extern template std::optional<double> certify_affine(const std::array<double, 4>&, double, double,
                                                     double);
extern template float round_affine_exactly(const std::array<float, 4>&, float, float, float);
extern template double round_affine_exactly(const std::array<double, 4>&, double, double, double);

}  // namespace pierce::exact
