// SPDX-License-Identifier: Apache-2.0
//
// One point against eight clusters, or eight triangles, at a time. Nothing is fused: every kernel
// gives the same bits (winding_plain.cpp is the same, lane by lane).
#if defined(PIERCE_KERNELS_WINDING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_WINDING_INL_H_
#undef PIERCE_KERNELS_WINDING_INL_H_
#else
#define PIERCE_KERNELS_WINDING_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstdint>
#include <numbers>

#include "bvh/tree.h"
#include "kernels/points/winding.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

using DW = hn::CappedTag<double, kWindingLanes>;
using VW = hn::Vec<DW>;
inline constexpr int kWindingStep = static_cast<int>(hn::MaxLanes(DW{}));
inline constexpr std::uint32_t kStepBits = (1U << kWindingStep) - 1;

HWY_INLINE VW plain_dot(const V3<VW>& p, const V3<VW>& q) {
  return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
}

// The homogeneous polynomials of the degrees kWindingOrder down to 1, each divided by the square
// once more than the next.
HWY_INLINE VW expansion(const double* term, const V3<VW>& d, VW inverse_square) {
  const DW real;
  VW powers[kWindingOrder + 1];
  powers[1] = d.z;
  for (int i = 2; i <= kWindingOrder; ++i) powers[i] = hn::Mul(powers[i - 1], d.z);
  VW sum = hn::Zero(real);
  int next = kWindingTerms;
  for (int degree = kWindingOrder; degree > 0; --degree) {
    const double* t = term + (next -= (degree + 1) * (degree + 2) / 2) * kWindingLanes;
    VW in_x = hn::Zero(real);
    for (int left = 0; left <= degree; ++left) {  // what a leaves to y and z
      VW in_y = hn::Load(real, t);
      t += kWindingLanes;
      for (int c = 1; c <= left; ++c, t += kWindingLanes) {
        in_y = hn::Add(hn::Mul(in_y, d.y), hn::Mul(hn::Load(real, t), powers[c]));
      }
      in_x = left == 0 ? in_y : hn::Add(hn::Mul(in_x, d.x), in_y);
    }
    sum = degree == kWindingOrder ? in_x : hn::Add(hn::Mul(sum, inverse_square), in_x);
  }
  return sum;
}

// Adds the children that are far enough; returns the others.
HWY_INLINE std::uint32_t add_clusters(const WindingNode& node, const double* point, double share,
                                      winding::Lanes& lanes) {
  const DW real;
  std::uint32_t open = 0;
  for (int i = 0; i < kWindingLanes; i += kWindingStep) {
    const V3<VW> d = broadcast(real, point) - load_rows(real, node.centre[0] + i, kWindingLanes);
    const VW square = plain_dot(d, d);
    const VW inverse = hn::Div(hn::Set(real, 1.0), square);
    const VW inverse_length = hn::Mul(hn::Sqrt(square), inverse);
    const VW ratio = hn::Mul(hn::Load(real, node.radius + i), inverse_length);
    VW power = inverse;
    for (int l = 0; l < kWindingOrder; l += 2) power = hn::Mul(power, inverse);
    const VW factor = hn::Add(hn::Set(real, winding::kLeastLeft),
                              hn::Mul(hn::Set(real, winding::kMoreLeft), ratio));
    const VW truncated = hn::Mul(hn::Mul(hn::Load(real, node.bound + i), power), factor);
    const VW rounded =
        hn::Mul(hn::Mul(hn::Load(real, node.area + i), inverse), hn::Set(real, winding::kRounding));
    const VW bound = hn::Add(truncated, rounded);
    const auto fits =
        hn::And(hn::And(hn::Le(ratio, hn::Set(real, 0.5)), hn::Le(bound, hn::Set(real, share))),
                hn::Ge(square, hn::Set(real, winding::kNearestSquare)));
    const std::uint32_t far = bits_of(real, fits);
    open |= (~far & kStepBits) << i;
    if ((far & kStepBits) == 0) continue;
    const VW sum =
        hn::Mul(expansion(node.term[0] + i, d, inverse), hn::Mul(inverse_length, inverse));
    const auto add = [&](double* to, VW value) {
      hn::Store(hn::Add(hn::Load(real, to), hn::IfThenElseZero(fits, value)), real, to);
    };
    add(lanes.far + i, sum);
    add(lanes.far_error + i, bound);
  }
  return open;
}

// Multiplies the complex numbers of a leaf's triangles in; returns those that are too near.
HWY_INLINE std::uint32_t add_leaf(const WindingLeaf& leaf, const double* point,
                                  winding::Lanes& lanes) {
  const DW real;
  std::uint32_t near = 0;
  const VW zero = hn::Zero(real), one = hn::Set(real, 1.0);
  const V3<VW> p = broadcast(real, point);
  for (int i = 0; i < kWindingLanes; i += kWindingStep) {
    const V3<VW> a = load_rows(real, leaf.corner[0] + i, kWindingLanes) - p;
    const V3<VW> b = load_rows(real, leaf.corner[3] + i, kWindingLanes) - p;
    const V3<VW> c = load_rows(real, leaf.corner[6] + i, kWindingLanes) - p;
    const VW aa = plain_dot(a, a), bb = plain_dot(b, b), cc = plain_dot(c, c);
    const VW la = hn::Sqrt(aa), lb = hn::Sqrt(bb), lc = hn::Sqrt(cc);
    const V3<VW> n{hn::Sub(hn::Mul(b.y, c.z), hn::Mul(b.z, c.y)),
                   hn::Sub(hn::Mul(b.z, c.x), hn::Mul(b.x, c.z)),
                   hn::Sub(hn::Mul(b.x, c.y), hn::Mul(b.y, c.x))};
    const VW up = plain_dot(a, n);
    const VW size = hn::Mul(hn::Mul(la, lb), lc);
    const VW across = hn::Add(hn::Add(size, hn::Mul(plain_dot(a, b), lc)),
                              hn::Add(hn::Mul(plain_dot(b, c), la), hn::Mul(plain_dot(c, a), lb)));
    const VW larger = hn::Max(across, hn::Abs(up));
    const auto fits =
        hn::And(hn::And(hn::Ge(larger, hn::Mul(size, hn::Set(real, winding::kSmallest))),
                        hn::Gt(across, zero)),
                hn::Ge(hn::Min(aa, hn::Min(bb, cc)), hn::Set(real, winding::kNearestCorner)));
    near |= (~bits_of(real, fits) & kStepBits) << i;
    const VW inverse = hn::Div(one, larger);
    const VW x = hn::IfThenElse(fits, hn::Mul(across, inverse), one);
    const VW y = hn::IfThenElseZero(fits, hn::Mul(up, inverse));
    const VW re = hn::Load(real, lanes.real + i), im = hn::Load(real, lanes.imaginary + i);
    const VW new_re = hn::Sub(hn::Mul(re, x), hn::Mul(im, y));
    const VW new_im = hn::Add(hn::Mul(re, y), hn::Mul(im, x));
    const auto forth = hn::And(hn::And(hn::Ge(im, zero), hn::Ge(y, zero)), hn::Lt(new_im, zero));
    const auto back = hn::And(hn::And(hn::Lt(im, zero), hn::Lt(y, zero)),
                              hn::And(hn::Lt(new_re, zero), hn::Ge(new_im, zero)));
    const VW turns = hn::Load(real, lanes.turns + i);
    hn::Store(
        hn::Sub(hn::Add(turns, hn::IfThenElseZero(forth, one)), hn::IfThenElseZero(back, one)),
        real, lanes.turns + i);
    hn::Store(new_re, real, lanes.real + i);
    hn::Store(new_im, real, lanes.imaginary + i);
    hn::Store(
        hn::Add(hn::Load(real, lanes.error + i), hn::IfThenElseZero(fits, hn::Mul(size, inverse))),
        real, lanes.error + i);
  }
  return near & ((1U << leaf.count) - 1);
}

HWY_INLINE void scale_lanes(winding::Lanes& lanes) {
  const DW real;
  for (int i = 0; i < kWindingLanes; i += kWindingStep) {
    const VW re = hn::Load(real, lanes.real + i), im = hn::Load(real, lanes.imaginary + i);
    const VW inverse = hn::Div(hn::Set(real, 1.0), hn::Add(hn::Abs(re), hn::Abs(im)));
    hn::Store(hn::Mul(re, inverse), real, lanes.real + i);
    hn::Store(hn::Mul(im, inverse), real, lanes.imaginary + i);
  }
}

HWY_INLINE void start_lanes(winding::Lanes& lanes) {
  const DW real;
  const VW zero = hn::Zero(real), one = hn::Set(real, 1.0);
  for (int i = 0; i < kWindingLanes; i += kWindingStep) {
    hn::Store(zero, real, lanes.far + i);
    hn::Store(zero, real, lanes.far_error + i);
    hn::Store(one, real, lanes.real + i);
    hn::Store(zero, real, lanes.imaginary + i);
    hn::Store(zero, real, lanes.turns + i);
    hn::Store(zero, real, lanes.error + i);
  }
}

// The operations of predicate::angle_of.
HWY_INLINE void angles_of(const winding::Lanes& lanes, double* angle) {
  const DW real;
  const VW zero = hn::Zero(real), one = hn::Set(real, 1.0);
  for (int i = 0; i < kWindingLanes; i += kWindingStep) {
    const VW x = hn::Load(real, lanes.real + i), y = hn::Load(real, lanes.imaginary + i);
    const VW across = hn::Abs(x), up = hn::Abs(y);
    const auto steep = hn::Gt(up, across);
    VW t = hn::Div(hn::IfThenElse(steep, across, up), hn::IfThenElse(steep, up, across));
    for (int half = 0; half < 3; ++half) {
      t = hn::Div(t, hn::Add(one, hn::Sqrt(hn::Add(one, hn::Mul(t, t)))));
    }
    const VW square = hn::Mul(t, t);
    VW sum = hn::Set(real, 1.0 / 15);
    for (int k = 13; k > 0; k -= 2) sum = hn::Sub(hn::Set(real, 1.0 / k), hn::Mul(square, sum));
    VW found = hn::Mul(hn::Set(real, 8.0), hn::Mul(t, sum));
    found = hn::IfThenElse(steep, hn::Sub(hn::Set(real, std::numbers::pi / 2), found), found);
    found = hn::IfThenElse(hn::Lt(x, zero), hn::Sub(hn::Set(real, std::numbers::pi), found), found);
    hn::Store(hn::IfThenElse(hn::Lt(y, zero), hn::Neg(found), found), real, angle + i);
  }
}

inline WindingSum sum_winding(const WindingTree& tree, const double* point, double share,
                              WindingResolver& resolver) {
  winding::Lanes lanes;
  start_lanes(lanes);
  std::uint32_t stack[kWindingLanes * bvh::kMaxDepth];
  std::uint32_t* top = stack;
  std::uint32_t leaves = 0;
  if (tree.root != bvh::kNoChild) *top++ = tree.root;
  while (top != stack) {
    const std::uint32_t ref = *--top;
    if (bvh::is_leaf(ref)) {
      const WindingLeaf& leaf = tree.leaves[ref & ~bvh::kLeafBit];
      std::uint32_t near = add_leaf(leaf, point, lanes);
      for (; near != 0; near &= near - 1) resolver.near(leaf.triangle[std::countr_zero(near)]);
      if (++leaves % winding::kLeavesPerScaling == 0) scale_lanes(lanes);
      continue;
    }
    const WindingNode& node = tree.nodes[ref];
    for (std::uint32_t open = add_clusters(node, point, share, lanes); open != 0;
         open &= open - 1) {
      const std::uint32_t child = node.child[std::countr_zero(open)];
      if (child != bvh::kNoChild) *top++ = child;
    }
  }
  if (leaves == 0) return winding::sum_of(lanes, nullptr);
  alignas(64) double angle[kWindingLanes];
  angles_of(lanes, angle);
  return winding::sum_of(lanes, angle);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PIERCE_KERNELS_WINDING_INL_H_
