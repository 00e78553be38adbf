// SPDX-License-Identifier: Apache-2.0
#include "predicate/decide.h"

#include "predicate/settle.h"

namespace pierce::predicate {
namespace {

// The corners whose weights are not known to be zero: one or two of them, in `corner`.
int support_of(const DecidedHit& hit, const Vec3<double>* corner[3]) {
  int count = 0;
  if ((hit.zeros & kZeroW) == 0) corner[count++] = &hit.triangle.a;
  if ((hit.zeros & kZeroU) == 0) corner[count++] = &hit.triangle.b;
  if ((hit.zeros & kZeroV) == 0) corner[count++] = &hit.triangle.c;
  return count;
}

// Two hits on the same edge or vertex: the ray lies in neither plane, so it meets the edge's line
// in one point only, and both t are the t of that point.
bool meet_in_shared_feature(const DecidedHit& first, const DecidedHit& second) {
  const Vec3<double>* p[3];
  const Vec3<double>* q[3];
  const int count = support_of(first, p);
  if (count == 3 || count != support_of(second, q)) return false;
  if (count == 1) return *p[0] == *q[0];
  return (*p[0] == *q[0] && *p[1] == *q[1]) || (*p[0] == *q[1] && *p[1] == *q[0]);
}

}  // namespace

bool decide_hit(const RayD& ray, const TriangleD& triangle, DecidedHit& hit, LadderCounts& counts) {
  hit.filtered = filter_determinants(ray, triangle);
  const Certified answer = certify_hit(hit.filtered, ray);
  hit.zeros = 0;
  if (answer == Certified::Unsure) {
    const Settled settled = settle_hit(ray, triangle);
    ++(settled.width == Width::Any ? counts.settled_big : counts.settled);
    if (!settled.hit) return false;
    hit.zeros = settled.zeros;
    hit.facing = settled.facing;
  } else {
    ++counts.certified;
    if (answer == Certified::No) return false;
    hit.facing = hit.filtered.value.den < 0 ? Facing::Front : Facing::Back;
  }
  hit.triangle = triangle;
  hit.t = t_interval(hit.filtered);
  return true;
}

std::strong_ordering decide_order(const RayD& ray, const DecidedHit& first,
                                  const DecidedHit& second, LadderCounts& counts) {
  if (first.t.high < second.t.low || second.t.high < first.t.low) {
    ++counts.orders_certified;
    return first.t.high < second.t.low ? std::strong_ordering::less : std::strong_ordering::greater;
  }
  ++counts.orders_settled;
  if (same_corners(first.triangle, second.triangle) || meet_in_shared_feature(first, second))
    return std::strong_ordering::equal;
  return settle_order(ray, first.triangle, second.triangle);
}

}  // namespace pierce::predicate
