// SPDX-License-Identifier: Apache-2.0
//
// One point against eight boxes, or eight triangles, at a time: the traversal to the nearest
// triangle.
#if defined(PIERCE_KERNELS_NEAREST_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_NEAREST_INL_H_
#undef PIERCE_KERNELS_NEAREST_INL_H_
#else
#define PIERCE_KERNELS_NEAREST_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "bvh/leaf_access.h"
#include "bvh/node.h"
#include "exact/round_outward.h"
#include "kernels/points/nearest.h"
#include "kernels/points/nearest_best.h"
#include "kernels/vectors-inl.h"
#include "predicate/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

using DN = hn::CappedTag<float, bvh::kWidth>;
using VN = hn::Vec<DN>;
inline constexpr int kNearLanes = static_cast<int>(hn::MaxLanes(DN{}));

// The point, and what may be concluded in floats about it.
struct NearPoint {
  float position[3];         // rounded to nearest
  float above[3], below[3];  // surely not below the true point, not above it
  double size;               // max-norm
};

// Of the bounds on distances to the triangles of a leaf.
struct NearPads {
  float low, high;

  NearPads(const NearPoint& point, float reach)
      : low(exact::round_up(bounds::kNearestLow * (static_cast<double>(reach) + point.size))),
        high(exact::round_up(bounds::kNearestHigh * (static_cast<double>(reach) + point.size))) {}
};

inline NearPoint near_point(const Vec3<double>& p) {
  NearPoint point;
  point.size = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  const double reach = 1 + point.size;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    point.position[axis] = static_cast<float>(x);
    point.above[axis] = exact::round_up(x + 0x1p-50 * reach);
    point.below[axis] = exact::round_down(x - 0x1p-50 * reach);
  }
  return point;
}

// What squared distances and products are compared with, for a limit on the distance itself: so
// much more that no rounding on either side matters. Never infinite, so that nothing is as near as
// an empty box.
HWY_INLINE float square_limit(float limit, float pad) {
  const float padded = (limit + pad) * bounds::kNearestRoom;
  return std::min(padded * padded, std::numeric_limits<float>::max());
}

// The squared distances to the boxes of the children; bit i: child i may be within the limit.
HWY_INLINE std::uint32_t near_children(const bvh::Node& node, const NearPoint& point, float limit,
                                       float* HWY_RESTRICT distance) {
  const DN d;
  std::uint32_t bits = 0;
  for (int i = 0; i < bvh::kWidth; i += kNearLanes) {
    const auto outside = [&](int axis) {
      const VN before = hn::Sub(hn::Load(d, node.lower[axis] + i), hn::Set(d, point.above[axis]));
      const VN behind = hn::Sub(hn::Set(d, point.below[axis]), hn::Load(d, node.upper[axis] + i));
      return hn::Max(hn::Max(before, behind), hn::Zero(d));
    };
    const V3<VN> away{outside(0), outside(1), outside(2)};
    const VN squared = dot(away, away);
    hn::Store(squared, d, distance + i);
    bits |= bits_of(d, hn::Le(squared, hn::Set(d, limit))) << i;
  }
  return bits;
}

// part / all within [0, 1], and 0 where all is not positive.
HWY_INLINE VN near_share(VN part, VN all) {
  const DN d;
  const VN one = hn::Set(d, 1.0F);
  const auto some = hn::Gt(all, hn::Zero(d));
  const VN share = hn::Div(part, hn::IfThenElse(some, all, one));
  return hn::IfThenElseZero(some, hn::Min(hn::Max(share, hn::Zero(d)), one));
}

// a + v e1 + w e2.
HWY_INLINE V3<VN> near_at(const V3<VN>& a, const V3<VN>& e1, const V3<VN>& e2, VN v, VN w) {
  return {hn::MulAdd(w, e2.x, hn::MulAdd(v, e1.x, a.x)),
          hn::MulAdd(w, e2.y, hn::MulAdd(v, e1.y, a.y)),
          hn::MulAdd(w, e2.z, hn::MulAdd(v, e1.z, a.z))};
}

// The vectors from the point to about the nearest points of the triangles whose corners it sees at
// a, b, c: always a + v e1 + w e2 with v, w >= 0 and v + w <= 1 up to rounding, the best of the
// edges' nearest points, and the foot of the perpendicular where that is inside.
HWY_INLINE V3<VN> towards_triangles(const V3<VN>& a, const V3<VN>& b, const V3<VN>& c) {
  const DN d;
  const VN one = hn::Set(d, 1.0F);
  const V3<VN> e1 = b - a;
  const V3<VN> e2 = c - a;
  const VN a_e1 = hn::Neg(dot(a, e1));
  const VN a_e2 = hn::Neg(dot(a, e2));
  const VN e11 = dot(e1, e1);
  const VN e12 = dot(e1, e2);
  const VN e22 = dot(e2, e2);
  const VN area = hn::Sub(hn::Mul(e11, e22), hn::Mul(e12, e12));
  const VN foot_v = hn::Sub(hn::Mul(e22, a_e1), hn::Mul(e12, a_e2));
  const VN foot_w = hn::Sub(hn::Mul(e11, a_e2), hn::Mul(e12, a_e1));
  const auto inside = hn::And(hn::And(hn::Gt(foot_v, hn::Zero(d)), hn::Gt(foot_w, hn::Zero(d))),
                              hn::Lt(hn::Add(foot_v, foot_w), area));

  const VN ab = near_share(a_e1, e11);
  const VN ac = near_share(a_e2, e22);
  const VN bc = near_share(hn::Add(hn::Sub(a_e2, a_e1), hn::Sub(e11, e12)),
                           hn::Add(hn::Sub(e11, e12), hn::Sub(e22, e12)));
  const VN cb = hn::Sub(one, bc);
  const V3<VN> on_ab = near_at(a, e1, e2, ab, hn::Zero(d));
  const V3<VN> on_ac = near_at(a, e1, e2, hn::Zero(d), ac);
  const V3<VN> on_bc = near_at(a, e1, e2, cb, bc);
  const VN to_ab = dot(on_ab, on_ab);
  const VN to_ac = dot(on_ac, on_ac);
  const VN to_bc = dot(on_bc, on_bc);
  const auto ac_first = hn::And(hn::Lt(to_ac, to_ab), hn::Le(to_ac, to_bc));
  const auto bc_first = hn::And(hn::Lt(to_bc, to_ab), hn::Lt(to_bc, to_ac));
  const VN inside_area = hn::IfThenElse(inside, area, one);
  const auto choose = [&](VN of_ab, VN of_ac, VN of_bc, VN foot) {
    const VN edge = hn::IfThenElse(bc_first, of_bc, hn::IfThenElse(ac_first, of_ac, of_ab));
    const VN within = hn::Min(hn::Div(foot, inside_area), one);
    return hn::IfThenElse(inside, within, edge);
  };
  const VN v = choose(ab, hn::Zero(d), cb, foot_v);
  const VN w = hn::Min(choose(hn::Zero(d), ac, bc, foot_w), hn::Sub(one, v));
  return near_at(a, e1, e2, v, w);
}

// What the bounds say about the triangles of a block: bit i of `open`, that number i may be within
// the limit, and between what its distance then lies.
struct NearLeaf {
  std::uint32_t open = 0;
  alignas(32) float low[bvh::kWidth];
  alignas(32) float high[bvh::kWidth];
};

HWY_INLINE NearLeaf near_leaf(const float* rows, std::uint32_t count, const NearPoint& point,
                              const NearPads& pads, float limit) {
  const DN d;
  NearLeaf leaf;
  const V3<VN> p = broadcast(d, point.position);
  const std::uint32_t lanes = (1U << count) - 1;  // what stands in the lanes beyond means nothing
  for (std::uint32_t i = 0; i < count; i += kNearLanes) {
    const V3<VN> a = load_rows(d, rows + i, count) - p;
    const V3<VN> b = load_rows(d, rows + 3 * count + i, count) - p;
    const V3<VN> c = load_rows(d, rows + 6 * count + i, count) - p;
    const V3<VN> g = towards_triangles(a, b, c);
    const VN squared = dot(g, g);
    const VN least = hn::Min(hn::Min(dot(g, a), dot(g, b)), dot(g, c));
    // Too short a vector points nowhere; then nothing is said.
    const auto usable = hn::Gt(squared, hn::Set(d, bounds::kNearestShortest));
    const auto beyond = hn::And(hn::And(usable, hn::Gt(least, hn::Zero(d))),
                                hn::Gt(hn::Mul(least, least), hn::Mul(squared, hn::Set(d, limit))));
    const std::uint32_t open = ~bits_of(d, beyond) & (lanes >> i) & ((1U << kNearLanes) - 1);
    if (open == 0) continue;
    leaf.open |= open << i;
    const VN length = hn::Sqrt(squared);
    const VN low = hn::Sub(hn::Div(least, length), hn::Set(d, pads.low));
    hn::Store(hn::IfThenElseZero(usable, low), d, leaf.low + i);
    hn::Store(hn::Add(length, hn::Set(d, pads.high)), d, leaf.high + i);
  }
  return leaf;
}

// Puts the children that may be near on the stack, the nearest on top.
HWY_INLINE NearEntry<float>* push_near(const bvh::Node& node, std::uint32_t bits,
                                       const float* distance, NearEntry<float>* top) {
  NearEntry<float>* const first = top;
  for (; bits != 0; bits &= bits - 1) {
    const auto child = static_cast<std::uint32_t>(std::countr_zero(bits));
    push_nearest_on_top({distance[child], node.child[child]}, first, top);
  }
  return top;
}

template <bool kCounting>
HWY_INLINE Candidate traverse_near(const bvh::Tree& tree, const FilterPoint& filter,
                                   NearestResolver& resolver, KernelCounts* counts) {
  const NearPoint point = near_point(filter.position);
  NearestSoFar<float> best;
  // Float holds no limit beyond this, and no triangle is that far away.
  best.limit = filter.limit < 0x1p60 ? exact::round_up(filter.limit) : 0x1p60F;
  float squared_limit = square_limit(best.limit, 0);
  bvh::LeafScratch scratch;
  NearEntry<float> stack[8 * bvh::kMaxDepth];
  NearEntry<float>* top = stack;
  *top++ = {0, tree.root};
  while (top != stack) {
    const NearEntry<float> entry = *--top;
    if (entry.distance > squared_limit) continue;
    if (!bvh::is_leaf(entry.ref)) {
      if constexpr (kCounting) ++counts->nodes;
      const bvh::Node& node = tree.nodes[entry.ref];
      alignas(32) float distance[bvh::kWidth];
      const std::uint32_t bits = near_children(node, point, squared_limit, distance);
      top = push_near(node, bits, distance, top);
      continue;
    }
    if constexpr (kCounting) ++counts->leaves;
    const std::uint32_t count = bvh::leaf_count(entry.ref);
    const float* block = bvh::leaf_block(tree, entry.ref, scratch);
    const float* rows = block + bvh::kLeafHead;
    const NearPads pads(point, block[1]);
    const NearLeaf leaf = near_leaf(rows, count, point, pads, square_limit(best.limit, pads.low));
    for (std::uint32_t open = leaf.open; open != 0; open &= open - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
      if (leaf.low[lane] > best.limit) continue;
      if constexpr (kCounting) ++counts->candidates;
      const Candidate candidate{bvh::number_in(rows, count, lane), count, rows + lane};
      best.offer(candidate, DistanceBounds<float>{leaf.low[lane], leaf.high[lane]}, resolver);
    }
    squared_limit = square_limit(best.limit, 0);
  }
  return best.triangle;
}

inline Candidate nearest(const bvh::Tree& tree, const FilterPoint& point, NearestResolver& resolver,
                         KernelCounts* counts) {
  if (tree.root == bvh::kNoChild) return {};
  const Vec3<double>& p = point.position;
  const double distance = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  if (!(distance <= bounds::kNearestFloat)) return nearest_plain(tree, point, resolver, counts);
  return counts != nullptr ? traverse_near<true>(tree, point, resolver, counts)
                           : traverse_near<false>(tree, point, resolver, counts);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
