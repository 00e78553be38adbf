// SPDX-License-Identifier: Apache-2.0
#include "predicate/certify.h"

#include <cmath>

#include "predicate/bounds.h"

namespace pierce::predicate {
Interval t_interval(const Filtered& f) {
  const double den = std::fabs(f.value.den);
  if (!f.usable || den <= 2 * f.den_err) return {};
  const double t = f.value.t / f.value.den;
  // |T/den - true| <= (T_err + |t| den_err) / (|den| - den_err), and the roundings.
  const double error = (f.t_err + std::fabs(t) * f.den_err) / (den - f.den_err) +
                       bounds::kIntervalFactor * std::fabs(t);
  return {t - error, t + error};
}

}  // namespace pierce::predicate
