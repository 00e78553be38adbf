// SPDX-License-Identifier: Apache-2.0
#include "predicate/certify.h"

#include <algorithm>
#include <cmath>

#include "predicate/bounds.h"

namespace pierce::predicate {
namespace {

using bounds::kDenFactor;
using bounds::kTFactor;
using bounds::kUvFactor;
constexpr double kUlp = bounds::kDoubleUlp;

double largest(const Triple<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

Triple<double> triple(const Vec3<double>& p) { return {p.x, p.y, p.z}; }

bool in_range(double magnitude) {
  return magnitude >= bounds::kSmallestMagnitude && magnitude <= bounds::kLargestMagnitude;
}

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

Filtered filter_determinants(const RayD& ray, const TriangleD& triangle) {
  const Triple<double> a = triple(triangle.a);
  const Triple<double> s = a - triple(ray.origin);
  const Triple<double> e1 = triple(triangle.b) - a;
  const Triple<double> e2 = triple(triangle.c) - a;
  const Triple<double> d = triple(ray.direction);
  const double s_max = largest(s);
  const double e1_max = largest(e1);
  const double e2_max = largest(e2);
  const double d_max = largest(d);

  Filtered f;
  f.value = determinants_of(s, e1, e2, d);
  f.usable = in_range(s_max) && in_range(e1_max) && in_range(e2_max) && in_range(d_max);
  const double e12 = e1_max * e2_max;
  f.den_err = kDenFactor * (e12 * d_max);
  f.uv_err = kUvFactor * (d_max * s_max * std::max(e1_max, e2_max));
  f.t_err = kTFactor * (e12 * s_max);
  // W = (den - U) - V: the errors of its parts, and two roundings of at most |den| + |U| + |V|
  // each.
  const double parts = std::fabs(f.value.den) + std::fabs(f.value.u) + std::fabs(f.value.v);
  f.w_err = (f.den_err + 2 * f.uv_err + 2 * kUlp * parts) * (1 + 8 * kUlp);
  return f;
}

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
