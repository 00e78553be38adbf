// SPDX-License-Identifier: Apache-2.0
#include "space/filter_space.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "exact/double_double.h"
#include "exact/round_ratio.h"
#include "exact/scaled_integers.h"
#include "support/finite.h"

namespace pierce::space {
namespace {

// Beyond this, what is left after the shift (at most 2^48) is beyond kTauLimit for sure.
constexpr double kBeyond = 0x1p60;

double clamp_tau(double tau) {
  return std::clamp(tau, static_cast<double>(-kTauLimit), static_cast<double>(kTauLimit));
}

double max_norm(const Vec3<double>& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

// 2^exponent as a double, clamped to the normal range.
double power_of_two(int exponent) { return exact::power_of_two(std::clamp(exponent, -1022, 1023)); }

// x * 2^exponent, rounded at most once.
double scaled(double x, int exponent) {
  if (exponent >= -1022 && exponent <= 1023) return x * power_of_two(exponent);
  return std::ldexp(x, exponent);
}

// The e with 2^(e-1) <= x < 2^e.
int exponent_above(double x) {
  const auto biased = static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52);
  if (biased != 0) return biased - 1022;
  int exponent = 0;  // subnormal
  std::frexp(x, &exponent);
  return exponent;
}

// origin + tau * direction for one component, rounded about once: the product is split exactly, and
// what the sum loses is put back. `origin_low` is what the origin's own rounding lost.
double moved(double origin, double origin_low, double tau, double direction) {
  const exact::DoubleDouble product = exact::two_product(tau, direction);
  const exact::DoubleDouble sum = exact::two_sum(origin, product.high);
  return sum.high + (sum.low + (product.low + origin_low));
}

}  // namespace

// The product is exact (a power of two) unless it under- or overflows, and where the result is not
// clamped the difference is rounded once, at most 2^-51 for |tau| <= 4; an exactly transformed
// ray's shift is itself rounded, but those rays' ends are found exactly (transform_exactly).
double TransformedRay::tau(double t) const {
  const double product = tau_scale == 0 ? scaled(t, tau_exponent) : t * tau_scale;
  return clamp_tau(std::clamp(product, -kBeyond, kBeyond) - tau_shift);
}

FilterSpace::FilterSpace(const Vec3<double>& lower, const Vec3<double>& upper) {
  if (!(lower.x <= upper.x)) return;  // no vertex at all
  // Halves, so that a box from -1e308 to 1e308 does not overflow.
  const auto half_extent = [](double low, double high) { return high * 0.5 - low * 0.5; };
  const double extent = std::max({half_extent(lower.x, upper.x), half_extent(lower.y, upper.y),
                                  half_extent(lower.z, upper.z)});
  // A scene that lies about the origin stays centred there: float vertices then keep all bits.
  const auto center = [extent](double low, double high) {
    const bool about_origin = std::max(std::fabs(low), std::fabs(high)) * 0.25 <= extent;
    return about_origin ? 0.0 : low * 0.5 + high * 0.5;
  };
  center_ = {center(lower.x, upper.x), center(lower.y, upper.y), center(lower.z, upper.z)};
  const double reach = std::max({std::fabs(lower.x - center_.x), std::fabs(upper.x - center_.x),
                                 std::fabs(lower.y - center_.y), std::fabs(upper.y - center_.y),
                                 std::fabs(lower.z - center_.z), std::fabs(upper.z - center_.z)});
  int exponent = 0;
  if (reach > 0) std::frexp(reach, &exponent);  // reach < 2^exponent
  exponent_ = -exponent;
  scale_ = power_of_two(exponent_);
  scale_rest_ = std::ldexp(1.0, exponent_ - std::clamp(exponent_, -1022, 1023));
  unscale_ = power_of_two(-exponent_);
  const bool only_scaled = center_ == Vec3<double>{0, 0, 0} && std::abs(exponent_) <= 100;
  float_scale_ = only_scaled ? static_cast<float>(scale_) : std::numeric_limits<float>::quiet_NaN();
}

bool FilterSpace::maps_floats_exactly(double smallest) const {
  return center_ == Vec3<double>{0, 0, 0} && std::abs(exponent_) < 1000 &&
         smallest * scale_ >= static_cast<double>(std::numeric_limits<float>::min());
}

void FilterSpace::transform_direction(const Vec3<double>& direction,
                                      TransformedRay& transformed) const {
  const int direction_exponent = 1 - exponent_above(max_norm(direction));
  transformed.direction = {scaled(direction.x, direction_exponent),
                           scaled(direction.y, direction_exponent),
                           scaled(direction.z, direction_exponent)};
  transformed.tau_exponent = exponent_ - direction_exponent;
  const bool normal = transformed.tau_exponent >= -1022 && transformed.tau_exponent <= 1023;
  transformed.tau_scale = normal ? power_of_two(transformed.tau_exponent) : 0;
}

TransformedRay FilterSpace::transform(const predicate::RayD& ray) const {
  TransformedRay transformed;
  transform_direction(ray.direction, transformed);
  transformed.origin = map(ray.origin);
  transformed.tau_shift = 0;
  transformed.reach = 0;
  transformed.exactly = false;
  transformed.misses = false;
  const double distance = max_norm(transformed.origin);
  transformed.origin_kept = distance <= static_cast<double>(kKeptOrigin);
  if (!transformed.origin_kept) [[unlikely]] {
    if (!(distance <= bounds::kFarthestOrigin) || !move_origin(ray, transformed)) {
      transform_exactly(ray, transformed);
      return transformed;
    }
  }
  transformed.tau_min = transformed.tau(ray.t_min);
  transformed.tau_max = transformed.tau(ray.t_max);
  return transformed;
}

// To the nearest point to the centre. False if that fails: next to the largest double the inner
// steps of two_sum may overflow although the sum does not.
bool FilterSpace::move_origin(const predicate::RayD& ray, TransformedRay& transformed) const {
  const Vec3<double> o = transformed.origin;
  const Vec3<double>& d = transformed.direction;
  const double tau = -(o.x * d.x + o.y * d.y + o.z * d.z) / (d.x * d.x + d.y * d.y + d.z * d.z);
  const auto lost = [this](double p, double c) {
    return exact::two_sum(p, -c).low * scale_ * scale_rest_;
  };
  transformed.origin = {moved(o.x, lost(ray.origin.x, center_.x), tau, d.x),
                        moved(o.y, lost(ray.origin.y, center_.y), tau, d.y),
                        moved(o.z, lost(ray.origin.z, center_.z), tau, d.z)};
  if (!is_finite_number(transformed.origin.x + transformed.origin.y + transformed.origin.z))
    return false;
  transformed.tau_shift = tau;
  // Off by kMoveError times the distance, which may be 2^-49 of the reach.
  transformed.reach = static_cast<float>(max_norm(o) * (bounds::kMoveError * 0x1p49));
  // The nearest point of a line that meets the box is within sqrt(3) of its centre, and the new
  // origin within 0.44 of that point (docs/algorithm.md, "Filter space"): within 1.8 in all.
  transformed.misses = !(max_norm(transformed.origin) <= static_cast<double>(kNearOrigin));
  return true;
}

// The nearest point to the centre, in integers of any size, rounded once.
void FilterSpace::transform_exactly(const predicate::RayD& ray, TransformedRay& transformed) const {
  using exact::BigInt;
  transformed.exactly = true;
  exact::BitSpan points;
  exact::BitSpan directions;
  const Vec3<double>& o = ray.origin;
  const Vec3<double>& d = ray.direction;
  for (const double x : {o.x, o.y, o.z, center_.x, center_.y, center_.z}) points.include(x);
  for (const double x : {d.x, d.y, d.z}) directions.include(x);
  const auto offset = [&](double p, double c) {
    return BigInt(exact::scaled_integer<BigInt>(p, points.low) -
                  exact::scaled_integer<BigInt>(c, points.low));
  };
  const auto along = [&](double x) { return exact::scaled_integer<BigInt>(x, directions.low); };
  const BigInt ox = offset(o.x, center_.x);
  const BigInt oy = offset(o.y, center_.y);
  const BigInt oz = offset(o.z, center_.z);
  const BigInt dx = along(d.x);
  const BigInt dy = along(d.y);
  const BigInt dz = along(d.z);
  const BigInt dd = dx * dx + dy * dy + dz * dz;
  const BigInt od = ox * dx + oy * dy + oz * dz;

  // o + t0 d with t0 = -od / dd: (o dd - od d) / dd.
  const auto nearest = [&](const BigInt& p, const BigInt& q) {
    return exact::round_ratio<double>(p * dd - od * q, dd, points.low + exponent_);
  };
  transformed.origin = {nearest(ox, dx), nearest(oy, dy), nearest(oz, dz)};
  transformed.misses = !(max_norm(transformed.origin) <= static_cast<double>(kNearOrigin));

  // tau = (t - t0) 2^tau_exponent, t0 = -od / dd 2^(points - directions).
  const int t_exponent = points.low - directions.low;
  transformed.tau_shift =
      exact::round_ratio<double>(-od, dd, t_exponent + transformed.tau_exponent);
  const auto tau_of = [&](double t) {
    if (is_infinite(t)) return t;
    const exact::BinaryParts parts = exact::binary_parts(t);
    const int exponent = std::min(parts.exponent, t_exponent);
    const BigInt n = (BigInt(parts.significand) << (parts.exponent - exponent)) * dd +
                     (od << (t_exponent - exponent));
    return exact::round_ratio<double>(n, dd, exponent + transformed.tau_exponent);
  };
  transformed.tau_min = clamp_tau(tau_of(ray.t_min));
  transformed.tau_max = clamp_tau(tau_of(ray.t_max));
}

double kept_tau_scale(const AffineMap& map, const Ray<double>& ray) {
  const auto is_kept = [&map](double x, double center) {
    return std::fabs((x - center) * map.scale) <= static_cast<double>(kKeptOrigin);
  };
  const Vec3<double>&o = ray.origin, &d = ray.direction;
  const double size = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
  const bool is_mild = size >= 0x1p-400 && size <= 0x1p400;
  if (!map.usable || !is_mild || !is_kept(o.x, map.center[0]) || !is_kept(o.y, map.center[1]) ||
      !is_kept(o.z, map.center[2]))
    return 0;
  constexpr std::uint64_t kExponent = std::uint64_t{0x7ff} << 52;
  return map.scale * std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) & kExponent);
}

}  // namespace pierce::space
