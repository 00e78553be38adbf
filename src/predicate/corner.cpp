// SPDX-License-Identifier: Apache-2.0
#include "predicate/corner.h"

#include <cmath>

#include "predicate/fine.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

int largest_axis(const Vec3<double>& p) {
  const double x = std::fabs(p.x), y = std::fabs(p.y), z = std::fabs(p.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

bool is_crossed(const Filtered& f) { return f.normal_usable && std::fabs(f.value.den) > f.den_err; }

}  // namespace

std::optional<Quotient> place_on_line(const RayD& ray, const Vec3<double>& p) {
  const Vec3<double>& d = ray.direction;
  const int axis = largest_axis(d), next = (axis + 1) % 3, last = (axis + 2) % 3;
  const auto distance = exact_difference(p, ray.origin);
  const Vec3<double> away{distance.x.high, distance.y.high, distance.z.high};
  const double along = component(away, axis), speed = component(d, axis);
  const auto goes_with = [&](int other) {
    return order_of_products(component(away, other), speed, along, component(d, other)) == 0;
  };
  if (!goes_with(next) || !goes_with(last)) return {};
  if (distance.x.low != 0 || distance.y.low != 0 || distance.z.low != 0) return {};
  return Quotient{along, speed};
}

std::optional<CornerHit> meet_corner(const RayD& ray, const TriangleD& triangle,
                                     const Filtered& f) {
  if (!is_crossed(f)) return {};
  const bool u = std::fabs(f.value.u) <= f.uv_err, v = std::fabs(f.value.v) <= f.uv_err,
             w = std::fabs(f.value.w) <= f.w_err;
  for (const unsigned zeros : {kZeroU | kZeroV, kZeroV | kZeroW, kZeroU | kZeroW}) {
    const bool possible = (u || (zeros & kZeroU) == 0) && (v || (zeros & kZeroV) == 0) &&
                          (w || (zeros & kZeroW) == 0);
    if (!possible) continue;
    const auto t = place_on_line(ray, triangle.corner(kSupports[zeros].first));
    if (!t) continue;
    const auto hit = t->in_range(ray);
    const Interval interval = t->interval();
    if (!hit || is_infinite(interval.low)) return {};
    return CornerHit{*hit, static_cast<std::uint8_t>(zeros), interval,
                     f.value.den < 0 ? Facing::Front : Facing::Back};
  }
  return {};
}

template <class Real>
std::optional<Hit<Real>> round_at_corner(const RayD& ray, const TriangleD& triangle,
                                         std::uint8_t zeros, const Filtered& f) {
  const auto [corners, first, last] = kSupports[zeros];
  if (corners != 1 || !is_crossed(f)) return {};
  const auto place = place_on_line(ray, triangle.corner(first));
  if (!place) return {};
  const auto t = place->rounded<Real>();
  if (!t) return {};
  Hit<Real> hit;
  hit.t = *t;
  hit.w = first == 0 ? Real{1} : Real{0};
  hit.u = first == 1 ? Real{1} : Real{0};
  hit.v = first == 2 ? Real{1} : Real{0};
  hit.facing = f.value.den < 0 ? Facing::Front : Facing::Back;
  return hit;
}

template std::optional<Hit<float>> round_at_corner<float>(const RayD&, const TriangleD&,
                                                          std::uint8_t, const Filtered&);
template std::optional<Hit<double>> round_at_corner<double>(const RayD&, const TriangleD&,
                                                            std::uint8_t, const Filtered&);

}  // namespace pierce::predicate
