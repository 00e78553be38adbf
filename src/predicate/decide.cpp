// SPDX-License-Identifier: Apache-2.0
#include "predicate/decide.h"

#include <cmath>

#include "predicate/settle.h"
#include "support/finite.h"

namespace pierce::predicate {
namespace {

bool meet_in_shared_feature(const DecidedHit& first, const DecidedHit& second) {
  const auto corners_of = [](const DecidedHit& hit) {
    return [&hit](int k) { return hit.triangle.corner(k); };
  };
  return predicate::meet_in_shared_feature(corners_of(first), first.zeros, corners_of(second),
                                           second.zeros);
}

// Whether the triangle stands across an axis along which the ray does not move: floors and walls
// have many such, and rays in or beside their planes would ask for exact arithmetic at each.
bool is_parallel_across_axis(const RayD& ray, const TriangleD& triangle) {
  return (axes_across(triangle) & still_axes(ray.direction)) != 0;
}

// Two corners in one place: no ray crosses it.
bool is_segment(const TriangleD& t) { return t.a == t.b || t.b == t.c || t.c == t.a; }

}  // namespace

bool decide_hit(const RayD& ray, const TriangleD& triangle, DecidedHit& hit, LadderCounts& counts) {
  hit.filtered = filter_determinants(ray, triangle);
  const Certified answer = certify_hit(hit.filtered, ray);
  hit.zeros = 0;
  hit.t = {};
  if (answer == Certified::Unsure) {
    if (is_parallel_across_axis(ray, triangle) || is_segment(triangle)) {
      ++counts.certified;
      return false;
    }
    const Settled settled = settle_hit(ray, triangle, hit.filtered);
    ++(settled.certified             ? counts.certified
       : settled.width == Width::Any ? counts.settled_big
                                     : counts.settled);
    if (!settled.hit) return false;
    hit.t = settled.t;
    hit.zeros = settled.zeros;
    hit.facing = settled.facing;
  } else {
    ++counts.certified;
    if (answer == Certified::No) return false;
    hit.facing = hit.filtered.value.den < 0 ? Facing::Front : Facing::Back;
  }
  hit.triangle = triangle;
  if (is_infinite(hit.t.low)) hit.t = t_interval(hit.filtered);
  return true;
}

bool meets_same_feature(const DecidedHit& hit, const TriangleD& other, std::uint8_t& zeros) {
  const Support support = kSupports[hit.zeros];
  if (support.count == 3) return false;
  const Vec3<double>& first = hit.triangle.corner(support.first);
  const Vec3<double>& last = hit.triangle.corner(support.last);
  const auto is_there = [&](const Vec3<double>& p) { return p == first || p == last; };
  const bool a = is_there(other.a), b = is_there(other.b), c = is_there(other.c);
  zeros = static_cast<std::uint8_t>((a ? 0 : kZeroW) | (b ? 0 : kZeroU) | (c ? 0 : kZeroV));
  return int{a} + int{b} + int{c} == support.count;
}

bool certify_same_point(const RayD& ray, const TriangleD& triangle, std::uint8_t zeros,
                        const Interval& t, DecidedHit& hit) {
  hit.filtered = filter_determinants(ray, triangle);
  const double den = hit.filtered.value.den;
  if (!hit.filtered.normal_usable || std::fabs(den) <= hit.filtered.den_err) return false;
  hit.triangle = triangle;
  hit.t = t;
  hit.facing = den < 0 ? Facing::Front : Facing::Back;
  hit.zeros = zeros;
  return true;
}

std::strong_ordering decide_order(const RayD& ray, const DecidedHit& first,
                                  const DecidedHit& second, LadderCounts& counts) {
  if (first.t.high < second.t.low || second.t.high < first.t.low) {
    ++counts.orders_certified;
    return first.t.high < second.t.low ? std::strong_ordering::less : std::strong_ordering::greater;
  }
  ++counts.orders_settled;
  if (same_corners(first.triangle, second.triangle) || meet_in_shared_feature(first, second) ||
      share_plane_across_axis(first.triangle, second.triangle))
    return std::strong_ordering::equal;
  return settle_order(ray, first.triangle, second.triangle);
}

}  // namespace pierce::predicate
