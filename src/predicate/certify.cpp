// SPDX-License-Identifier: Apache-2.0
#include "predicate/certify.h"

#include <algorithm>
#include <cmath>

#include "predicate/bounds.h"

namespace pierce::predicate {
namespace {

constexpr double kUlp = bounds::kDoubleUlp;

// Sign of T / den - bound, in the direction that den's sign gives: Yes if surely t > bound (or >=
// when they are surely equal, which double arithmetic never claims), No if surely t < bound.
Certified certify_above(const Filtered& f, double den_magnitude, double t_signed, double bound) {
  if (std::isinf(bound)) return certified(bound < 0);
  const double product = bound * den_magnitude;
  const double difference = t_signed - product;
  // One rounding in the product, one in the difference, both relative; 2^-1000 covers a product
  // that underflows.
  const double error = f.t_err + std::fabs(bound) * f.den_err * (1 + 4 * kUlp) +
                       4 * kUlp * (std::fabs(product) + std::fabs(difference)) + 0x1p-1000;
  if (difference > error) return Certified::Yes;
  if (difference < -error) return Certified::No;
  return Certified::Unsure;  // also when something overflowed to NaN or inf
}

}  // namespace

Certified certify_hit(const Filtered& f, const RayD& ray) {
  if (!f.usable) return Certified::Unsure;
  const double sign = f.value.den < 0 ? -1 : 1;
  const double den = sign * f.value.den;
  const double u = sign * f.value.u;
  const double v = sign * f.value.v;
  const double w = sign * f.value.w;
  if (den <= f.den_err) return Certified::Unsure;
  if (u < -f.uv_err || v < -f.uv_err || w < -f.w_err) return Certified::No;
  const Certified after_start = certify_above(f, den, sign * f.value.t, ray.t_min);
  if (after_start == Certified::No) return Certified::No;
  const Certified after_end = certify_above(f, den, sign * f.value.t, ray.t_max);
  if (after_end == Certified::Yes) return Certified::No;
  const bool inside = u > f.uv_err && v > f.uv_err && w > f.w_err;
  return inside && after_start == Certified::Yes && after_end == Certified::No ? Certified::Yes
                                                                               : Certified::Unsure;
}

Interval t_interval(const Filtered& f) {
  const double den = std::fabs(f.value.den);
  if (!f.usable || den <= 2 * f.den_err) return {};
  const double t = f.value.t / f.value.den;
  // |T/den - true| <= (T_err + |t| den_err) / (|den| - den_err), then the roundings of this line.
  const double error = (f.t_err + std::fabs(t) * f.den_err) / (den - f.den_err) * (1 + 16 * kUlp) +
                       4 * kUlp * std::fabs(t);
  return {t - error, t + error};
}

}  // namespace pierce::predicate
