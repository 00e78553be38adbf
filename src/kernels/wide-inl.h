// SPDX-License-Identifier: Apache-2.0
//
// The wide kernel, one text for every instruction set: this file is compiled once per target by
// Highway's foreach_target. Eight boxes, or eight triangles, at a time.
//
// Key: S = a - o, E1 = b - a, E2 = c - a, R = d x S, N = E1 x E2;
//      den = N.d, U = -(R.E2), V = R.E1, T = N.S; hit iff U, V, den - U - V >= 0 (signs by den)
//      and T / den = tau in range. The bounds are those of bounds.h.
#if defined(PIERCE_KERNELS_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_WIDE_INL_H_
#undef PIERCE_KERNELS_WIDE_INL_H_
#else
#define PIERCE_KERNELS_WIDE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "bvh/node.h"
#include "kernels/bounds.h"
#include "kernels/filter_ray.h"
#include "kernels/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, bvh::kWidth>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
inline constexpr int kLanes = static_cast<int>(hn::MaxLanes(D{}));
static_assert(bvh::kWidth % kLanes == 0, "eight boxes are a whole number of vectors");

HWY_INLINE std::uint32_t bits_of(M mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D{}, mask, bytes);
  return bytes[0];
}

// What the box test needs of a ray, spread over all lanes: a plane is met at
// plane * inverse - origin * inverse, a pad earlier (entry) or later (exit).
struct BoxRay {
  V inverse_x, inverse_y, inverse_z;
  V entry_x, entry_y, entry_z;         // -(origin * inverse) - pad
  V exit_x, exit_y, exit_z;            // -(origin * inverse) + pad
  std::size_t near_x, near_y, near_z;  // where in a node the planes are that the ray enters by, ...
  std::size_t far_x, far_y, far_z;     // ... and leaves by, in floats
};

inline constexpr std::size_t kUpperPlanes = 3 * bvh::kWidth;

HWY_INLINE BoxRay box_ray(const FilterRay& ray) {
  const hn::CappedTag<float, 4> d4;
  const D d;
  const auto direction = hn::Load(d4, ray.direction);
  const auto slope = hn::Or(hn::Max(hn::Abs(direction), hn::Set(d4, kSmallestSlope)),
                            hn::And(direction, hn::Set(d4, -0.0F)));
  const auto inverse = hn::Div(hn::Set(d4, 1.0F), slope);
  const auto middle = hn::Neg(hn::Mul(hn::Load(d4, ray.origin), inverse));
  const auto pad = hn::Mul(hn::Set(d4, kBoxPad), hn::Abs(inverse));
  alignas(16) float inverses[4];
  alignas(16) float entries[4];
  alignas(16) float exits[4];
  hn::Store(inverse, d4, inverses);
  hn::Store(hn::Sub(middle, pad), d4, entries);
  hn::Store(hn::Add(middle, pad), d4, exits);
  const auto upper_if_backward = [&ray](int axis) {
    return (std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31) * kUpperPlanes;
  };
  const std::size_t x = upper_if_backward(0);
  const std::size_t y = upper_if_backward(1);
  const std::size_t z = upper_if_backward(2);
  constexpr std::size_t kAxis = bvh::kWidth;
  return {hn::Set(d, inverses[0]),
          hn::Set(d, inverses[1]),
          hn::Set(d, inverses[2]),
          hn::Set(d, entries[0]),
          hn::Set(d, entries[1]),
          hn::Set(d, entries[2]),
          hn::Set(d, exits[0]),
          hn::Set(d, exits[1]),
          hn::Set(d, exits[2]),
          x,
          y + kAxis,
          z + 2 * kAxis,
          kUpperPlanes - x,
          kUpperPlanes - y + kAxis,
          kUpperPlanes - z + 2 * kAxis};
}

// Bit i: the ray may enter child i within [tau_min, tau_max]; entry[i] is where.
HWY_INLINE std::uint32_t entered_children(const bvh::Node& node, const BoxRay& ray, float tau_min,
                                          float tau_max, float* HWY_RESTRICT entry) {
  const D d;
  const float* planes = &node.lower[0][0];
  std::uint32_t bits = 0;
  for (int i = 0; i < bvh::kWidth; i += kLanes) {
    const auto plane = [&](std::size_t at) { return hn::Load(d, planes + at + i); };
    const V near_x = hn::MulAdd(plane(ray.near_x), ray.inverse_x, ray.entry_x);
    const V near_y = hn::MulAdd(plane(ray.near_y), ray.inverse_y, ray.entry_y);
    const V near_z = hn::MulAdd(plane(ray.near_z), ray.inverse_z, ray.entry_z);
    const V far_x = hn::MulAdd(plane(ray.far_x), ray.inverse_x, ray.exit_x);
    const V far_y = hn::MulAdd(plane(ray.far_y), ray.inverse_y, ray.exit_y);
    const V far_z = hn::MulAdd(plane(ray.far_z), ray.inverse_z, ray.exit_z);
    const V near = hn::Max(hn::Max(near_x, near_y), hn::Max(near_z, hn::Set(d, tau_min)));
    const V far = hn::Min(hn::Min(far_x, far_y), hn::Min(far_z, hn::Set(d, tau_max)));
    hn::Store(near, d, entry + i);
    bits |= bits_of(hn::Le(near, far)) << i;
  }
  return bits;
}

// What the leaf cull says about the triangles of a block, a bit each.
struct LeafAnswer {
  std::uint32_t open = 0;     // not discarded
  std::uint32_t certain = 0;  // surely hit, with tau within the interval below
  alignas(32) float tau_low[bvh::kWidth];
  alignas(32) float tau_high[bvh::kWidth];
};

struct V3 {
  V x, y, z;
};
HWY_INLINE V3 operator-(const V3& p, const V3& q) {
  return {hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
}
HWY_INLINE V3 cross(const V3& p, const V3& q) {
  return {hn::MulSub(p.y, q.z, hn::Mul(p.z, q.y)), hn::MulSub(p.z, q.x, hn::Mul(p.x, q.z)),
          hn::MulSub(p.x, q.y, hn::Mul(p.y, q.x))};
}
HWY_INLINE V dot(const V3& p, const V3& q) {
  return hn::MulAdd(p.x, q.x, hn::MulAdd(p.y, q.y, hn::Mul(p.z, q.z)));
}
HWY_INLINE V max_norm(const V3& p) {
  return hn::Max(hn::Max(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z));
}
HWY_INLINE V3 broadcast(const float* p) {
  const D d;
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2])};
}
HWY_INLINE V3 load_rows(const float* row, std::uint32_t stride) {
  const D d;
  return {hn::LoadU(d, row), hn::LoadU(d, row + stride), hn::LoadU(d, row + 2 * stride)};
}

// The cull of one leaf block. `rows` is the block's ax row, `edge` its E.
HWY_INLINE LeafAnswer cull_leaf(const float* rows, std::uint32_t count, float edge,
                                const FilterRay& ray, float tau_max) {
  const D d;
  LeafAnswer answer;
  const V3 o = broadcast(ray.origin);
  const V3 dir = broadcast(ray.direction);
  const float e = edge * (kEdgeLinear + kEdgeSquare * edge) + kEdgeFloor;
  const V e_v = hn::Set(d, e);
  const V minus_e = hn::Set(d, -e);
  const V sum_e = hn::Set(d, kSumFactor * e);
  const float tau_input = ray.exact ? 0 : kTauInput;
  const float tau_rest = edge * edge * (kTauCube * edge + (ray.exact ? 0 : kTauSquare));
  const std::uint32_t lanes = (1U << count) - 1;
  for (std::uint32_t i = 0; i < count; i += kLanes) {
    const V3 a = load_rows(rows + i, count);
    const V3 e1 = load_rows(rows + 3 * count + i, count) - a;
    const V3 e2 = load_rows(rows + 6 * count + i, count) - a;
    const V3 s = a - o;
    const V3 n = cross(e1, e2);
    const V3 r = cross(dir, s);
    const V den_signed = dot(n, dir);
    const V sign = hn::And(den_signed, hn::Set(d, -0.0F));
    const V den = hn::Abs(den_signed);
    const V u = hn::Xor(hn::Neg(dot(r, e2)), sign);
    const V v = hn::Xor(dot(r, e1), sign);
    const V w = hn::Sub(hn::Sub(den, u), v);
    // Signs in the positive: a lane that fails none of these stays (NaN cannot occur).
    const M uv_open = hn::And(hn::Ge(u, minus_e), hn::Ge(v, minus_e));
    const M open = hn::And(uv_open, hn::Ge(w, hn::Neg(sum_e)));
    std::uint32_t open_bits = bits_of(open) & (lanes >> i);
    if (open_bits == 0) continue;

    // With den safely away from 0, tau is known to within a bound; else nothing is known of it.
    const M safe = hn::Gt(den, sum_e);
    const V inverse = hn::Div(hn::Set(d, 1.0F), den);
    const V tau = hn::Mul(hn::Xor(dot(n, s), sign), inverse);
    const V reach = hn::MulAdd(hn::Set(d, kTauReach), max_norm(s), hn::Set(d, tau_input));
    const V tau_err = hn::Mul(hn::MulAdd(max_norm(n), reach, hn::Set(d, tau_rest)), inverse);
    const V low = hn::Sub(tau, tau_err);
    const V high = hn::Add(tau, tau_err);
    const M in_range =
        hn::And(hn::Ge(high, hn::Set(d, ray.tau_min)), hn::Le(low, hn::Set(d, tau_max)));
    open_bits &= bits_of(hn::Or(hn::Not(safe), in_range));
    if (open_bits == 0) continue;

    const M inside = hn::And(hn::And(hn::Gt(u, e_v), hn::Gt(v, e_v)), hn::Gt(w, sum_e));
    const M surely_in_range =
        hn::And(hn::Gt(low, hn::Set(d, ray.tau_first)), hn::Lt(high, hn::Set(d, ray.tau_last)));
    const M certain = hn::And(hn::And(safe, inside), surely_in_range);
    answer.open |= open_bits << i;
    answer.certain |= (bits_of(certain) & open_bits) << i;
    hn::Store(low, d, answer.tau_low + i);
    hn::Store(high, d, answer.tau_high + i);
  }
  return answer;
}

struct StackEntry {
  float tau;
  std::uint32_t ref;
};

// Enough for any tree that the builder makes: depth times the seven siblings that wait.
inline constexpr int kStackSize = 8 * bvh::kMaxDepth;

// A leaf block in memory.
struct Leaf {
  const float* rows;
  std::uint32_t count;
  float edge;

  Leaf(const bvh::Tree& tree, std::uint32_t ref) : count(bvh::leaf_count(ref)) {
    const std::byte* block =
        tree.leaves.data() + std::size_t{bvh::leaf_place(ref)} * bvh::kLeafUnit;
    rows = reinterpret_cast<const float*>(block);
    edge = *rows++;
  }
  [[nodiscard]] HWY_INLINE Candidate candidate(std::uint32_t lane) const {
    return {std::bit_cast<std::uint32_t>(rows[9 * count + lane]), count, rows + lane};
  }
};

// Puts three or more entered children on the stack, the nearest on top.
HWY_INLINE StackEntry* push_ordered(const bvh::Node& node, std::uint32_t bits, const float* entry,
                                    StackEntry* top) {
  StackEntry* const first = top;
  do {
    const auto child = static_cast<std::uint32_t>(std::countr_zero(bits));
    bits &= bits - 1;
    const StackEntry entered{entry[child], node.child[child]};
    StackEntry* at = top++;
    for (; at > first && at[-1].tau < entered.tau; --at) *at = at[-1];
    *at = entered;
  } while (bits != 0);
  return top;
}

// The first hit so far and the search for it.
class Closest {
 public:
  Closest(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, Referee& referee,
          KernelCounts* counts)
      : tree_(tree), ray_(ray), skip_(skip), referee_(referee), counts_(counts) {}

  Candidate search() {
    StackEntry stack[kStackSize];
    StackEntry* top = stack;
    if (tree_.root == bvh::kNoChild) return best_;
    const BoxRay box = box_ray(ray_);
    float tau_max = ray_.tau_max;  // nothing beyond matters any more
    *top++ = {ray_.tau_min, tree_.root};
    while (top != stack) {
      const StackEntry next = *--top;
      if (next.tau > tau_max) continue;
      std::uint32_t ref = next.ref;
      while (!bvh::is_leaf(ref)) {
        if (counts_ != nullptr) ++counts_->nodes;
        const bvh::Node& node = tree_.nodes[ref];
        alignas(32) float entry[bvh::kWidth];
        std::uint32_t bits = entered_children(node, box, ray_.tau_min, tau_max, entry);
        if (bits == 0) {
          ref = bvh::kNoChild;
          break;
        }
        const auto first = static_cast<std::uint32_t>(std::countr_zero(bits));
        ref = node.child[first];
        bits &= bits - 1;
        if (bits == 0) continue;
        const auto second = static_cast<std::uint32_t>(std::countr_zero(bits));
        if ((bits & (bits - 1)) == 0) {
          // Two: the nearer goes on, the farther waits.
          const bool swapped = entry[second] < entry[first];
          const std::uint32_t other = node.child[second];
          *top++ = {swapped ? entry[first] : entry[second], swapped ? ref : other};
          ref = swapped ? other : ref;
          continue;
        }
        top = push_ordered(node, bits | (1U << first), entry, top);
        ref = (--top)->ref;
      }
      if (ref != bvh::kNoChild) tau_max = visit(Leaf(tree_, ref), tau_max);
    }
    return best_;
  }

 private:
  // Takes in the hits of a leaf; returns the new end of what matters.
  HWY_INLINE float visit(const Leaf& leaf, float tau_max) {
    if (counts_ != nullptr) ++counts_->leaves;
    const LeafAnswer answer = cull_leaf(leaf.rows, leaf.count, leaf.edge, ray_, tau_max);
    for (std::uint32_t open = answer.open; open != 0; open &= open - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
      const Candidate candidate = leaf.candidate(lane);
      if (candidate.primitive == skip_) continue;
      if (counts_ != nullptr) ++counts_->candidates;
      TauInterval tau{answer.tau_low[lane], answer.tau_high[lane]};
      const bool certain = ((answer.certain >> lane) & 1U) != 0;
      if (!certain && !referee_.is_hit(candidate, tau)) continue;
      offer(candidate, tau);
    }
    return best_.primitive == kNone ? tau_max : std::min(tau_max, best_tau_.high);
  }

  HWY_INLINE void offer(const Candidate& candidate, const TauInterval& tau) {
    if (best_.primitive != kNone) {
      if (tau.low > best_tau_.high) return;
      if (tau.high >= best_tau_.low && !referee_.is_before(candidate, best_)) return;
    }
    best_ = candidate;
    best_tau_ = tau;
  }

  const bvh::Tree& tree_;
  const FilterRay& ray_;
  const std::uint32_t skip_;
  Referee& referee_;
  KernelCounts* const counts_;
  Candidate best_;
  TauInterval best_tau_{};
};

// The quick road into filter space, for float scenes that are only scaled and not moved: powers of
// two all the way, so nothing is rounded (save into the subnormals: 2^-150, far below every bound's
// floor). False if the ray is not for it: its origin is far away, or its direction's size is
// extreme.
inline bool quick_road(float scale, const Ray<float>& r, FilterRay& ray) {
  const hn::CappedTag<float, 4> d4;
  const auto origin =
      hn::Mul(hn::LoadU(d4, &r.origin.x), hn::Set(d4, scale));  // and a lane too many
  const float size =
      std::max({std::fabs(r.direction.x), std::fabs(r.direction.y), std::fabs(r.direction.z)});
  const std::uint32_t biased =
      std::bit_cast<std::uint32_t>(size) >> 23;  // 2^(biased - 127) <= size
  const float reach =
      std::max({std::fabs(r.origin.x), std::fabs(r.origin.y), std::fabs(r.origin.z)}) * scale;
  if (!(reach <= bvh::kNearOrigin) || biased - 8 > 238) return false;
  const float shrink = std::bit_cast<float>((254 - biased) << 23);
  const float grow = std::bit_cast<float>(biased << 23);
  hn::Store(origin, d4, ray.origin);
  hn::Store(hn::Mul(hn::LoadU(d4, &r.direction.x), hn::Set(d4, shrink)), d4, ray.direction);
  const double tau_scale = static_cast<double>(scale) * static_cast<double>(grow);
  const auto limit = static_cast<double>(bvh::kTauLimit);
  set_range(std::clamp(static_cast<double>(r.t_min) * tau_scale, -limit, limit),
            std::clamp(static_cast<double>(r.t_max) * tau_scale, -limit, limit), ray);
  ray.exact = true;
  return true;
}

// Walks all leaves that the ray may enter, in no order; `leaf` returns true to stop.
template <class Visit>
HWY_INLINE bool walk(const bvh::Tree& tree, const FilterRay& ray, KernelCounts* counts,
                     const Visit& visit) {
  if (tree.root == bvh::kNoChild) return false;
  std::uint32_t stack[kStackSize];
  std::uint32_t* top = stack;
  const BoxRay box = box_ray(ray);
  *top++ = tree.root;
  while (top != stack) {
    const std::uint32_t ref = *--top;
    if (bvh::is_leaf(ref)) {
      if (counts != nullptr) ++counts->leaves;
      const Leaf leaf(tree, ref);
      const LeafAnswer answer = cull_leaf(leaf.rows, leaf.count, leaf.edge, ray, ray.tau_max);
      if (answer.open != 0 && visit(leaf, answer)) return true;
      continue;
    }
    if (counts != nullptr) ++counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    alignas(32) float entry[bvh::kWidth];
    std::uint32_t bits = entered_children(node, box, ray.tau_min, ray.tau_max, entry);
    for (; bits != 0; bits &= bits - 1) *top++ = node.child[std::countr_zero(bits)];
  }
  return false;
}

inline Candidate closest(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                         Referee& referee, KernelCounts* counts) {
  return Closest(tree, ray, skip, referee, counts).search();
}

inline bool any(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, Referee& referee,
                KernelCounts* counts) {
  return walk(tree, ray, counts, [&](const Leaf& leaf, const LeafAnswer& answer) {
    for (std::uint32_t open = answer.open; open != 0; open &= open - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
      const Candidate candidate = leaf.candidate(lane);
      if (candidate.primitive == skip) continue;
      if (counts != nullptr) ++counts->candidates;
      TauInterval tau;
      if (((answer.certain >> lane) & 1U) != 0 || referee.is_hit(candidate, tau)) return true;
    }
    return false;
  });
}

inline void all(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, Referee& referee,
                KernelCounts* counts) {
  walk(tree, ray, counts, [&](const Leaf& leaf, const LeafAnswer& answer) {
    for (std::uint32_t open = answer.open; open != 0; open &= open - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(open)));
      if (candidate.primitive == skip) continue;
      if (counts != nullptr) ++counts->candidates;
      TauInterval tau;
      referee.is_hit(candidate, tau);
    }
    return false;
  });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
