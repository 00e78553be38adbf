// SPDX-License-Identifier: Apache-2.0
//
// Sixteen rays at a time, for rays that run nearly alike: a node's eight boxes are first held
// against all rays at once in interval arithmetic, then each box that is left against the sixteen
// rays; a leaf's triangles one by one against the sixteen rays. Where few rays are left together
// they go on singly.
#if defined(PIERCE_KERNELS_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_INL_H_
#undef PIERCE_KERNELS_PACKET_INL_H_
#else
#define PIERCE_KERNELS_PACKET_INL_H_
#endif

#include <array>
#include <iterator>
#include <utility>

#include "kernels/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// How many rays go together.
inline constexpr std::uint32_t kPacketSize = 16;

using DP = hn::CappedTag<float, kPacketSize>;
using VP = hn::Vec<DP>;
inline constexpr std::uint32_t kPacketLanes = static_cast<std::uint32_t>(hn::MaxLanes(DP{}));

// With no more than this many rays together, each goes on by itself.
inline constexpr int kFewRays = 2;

// The rays of a packet in rows, and the intervals that hold them all.
struct Packet {
  alignas(64) float origin[3][kPacketSize];
  alignas(64) float direction[3][kPacketSize];
  alignas(64) float inverse[3][kPacketSize];
  alignas(64) float entry[3][kPacketSize];  // as in BoxRay
  alignas(64) float exit[3][kPacketSize];
  alignas(64) float tau_min[kPacketSize];
  alignas(64) float tau_max[kPacketSize];  // nothing beyond matters any more
  alignas(64) float tau_first[kPacketSize];
  alignas(64) float tau_last[kPacketSize];
  float near_origin[3], far_origin[3];  // the one that makes entries earliest, exits latest
  float inverse_low[3], inverse_high[3], pad[3];
  std::size_t near_plane[3], far_plane[3];
  float least_tau_min;
  std::uint32_t lanes;  // bit i: there is a ray i
  bool exact;
};

// Fills the rows; false if the rays do not run alike: directions in several octants, or origins or
// directions far apart.
HWY_INLINE bool make_packet(const FilterRay* rays, std::uint32_t count, Packet& p) {
  // How far apart origins (in a scene of size 2) and directions (of size 1 to 2) may be.
  constexpr float kOriginSpread = 0.25F;
  constexpr float kDirectionSpread = 0.25F;
  p.lanes = (1U << count) - 1;
  p.exact = true;
  p.least_tau_min = bvh::kTauLimit;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low_o = bvh::kEmptyPlane, high_o = -bvh::kEmptyPlane;
    float low_d = bvh::kEmptyPlane, high_d = -bvh::kEmptyPlane;
    std::uint32_t signs = 0;
    for (std::uint32_t i = 0; i < kPacketSize; ++i) {
      const FilterRay& ray = rays[i < count ? i : 0];
      const float o = ray.origin[axis];
      const float d = ray.direction[axis];
      p.origin[axis][i] = o;
      p.direction[axis][i] = d;
      low_o = std::min(low_o, o);
      high_o = std::max(high_o, o);
      low_d = std::min(low_d, d);
      high_d = std::max(high_d, d);
      signs |= 1U << (std::bit_cast<std::uint32_t>(d) >> 31);
    }
    const bool backward = signs == 2;
    if (signs == 3 || high_o - low_o > kOriginSpread || high_d - low_d > kDirectionSpread) {
      return false;
    }
    const std::size_t lower = axis * bvh::kWidth;
    p.near_origin[axis] = backward ? low_o : high_o;
    p.far_origin[axis] = backward ? high_o : low_o;
    p.near_plane[axis] = backward ? lower + kUpperPlanes : lower;
    p.far_plane[axis] = backward ? lower : lower + kUpperPlanes;
  }
  const DP d;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = bvh::kEmptyPlane, high = -bvh::kEmptyPlane;
    for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
      const VP direction = hn::Load(d, p.direction[axis] + i);
      const VP slope = hn::Or(hn::Max(hn::Abs(direction), hn::Set(d, kSmallestSlope)),
                              hn::And(direction, hn::Set(d, -0.0F)));
      const VP inverse = hn::Div(hn::Set(d, 1.0F), slope);
      const VP middle = hn::Neg(hn::Mul(hn::Load(d, p.origin[axis] + i), inverse));
      const VP pad = hn::Mul(hn::Set(d, kBoxPad), hn::Abs(inverse));
      hn::Store(inverse, d, p.inverse[axis] + i);
      hn::Store(hn::Sub(middle, pad), d, p.entry[axis] + i);
      hn::Store(hn::Add(middle, pad), d, p.exit[axis] + i);
    }
    for (const float inverse : p.inverse[axis]) {
      low = std::min(low, inverse);
      high = std::max(high, inverse);
    }
    p.inverse_low[axis] = low;
    p.inverse_high[axis] = high;
    p.pad[axis] = kBoxPad * std::max(std::fabs(low), std::fabs(high));
  }
  for (std::uint32_t i = 0; i < kPacketSize; ++i) {
    const FilterRay& ray = rays[i < count ? i : 0];
    p.tau_min[i] = ray.tau_min;
    p.tau_max[i] = i < count ? ray.tau_max : -bvh::kEmptyPlane;
    p.tau_first[i] = ray.tau_first;
    p.tau_last[i] = ray.tau_last;
    p.least_tau_min = std::min(p.least_tau_min, ray.tau_min);
    p.exact &= ray.exact;
  }
  return true;
}

// Bit i: some ray may enter child i. The products of the distance to a plane and all inverses lie
// between those with the least and the greatest; each is within 13 ulp / |direction| of what the
// box test bounds by 16 (docs/algorithm.md, "Packets").
HWY_INLINE std::uint32_t children_in_reach(const bvh::Node& node, const Packet& p,
                                           float greatest_tau_max) {
  const D d;
  const float* planes = &node.lower[0][0];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < bvh::kWidth; i += kLanes) {
    V near = hn::Set(d, p.least_tau_min);
    V far = hn::Set(d, greatest_tau_max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const V low = hn::Set(d, p.inverse_low[axis]);
      const V high = hn::Set(d, p.inverse_high[axis]);
      const V pad = hn::Set(d, p.pad[axis]);
      const V to_near =
          hn::Sub(hn::Load(d, planes + p.near_plane[axis] + i), hn::Set(d, p.near_origin[axis]));
      const V to_far =
          hn::Sub(hn::Load(d, planes + p.far_plane[axis] + i), hn::Set(d, p.far_origin[axis]));
      near = hn::Max(near, hn::Sub(hn::Min(hn::Mul(to_near, low), hn::Mul(to_near, high)), pad));
      far = hn::Min(far, hn::Add(hn::Max(hn::Mul(to_far, low), hn::Mul(to_far, high)), pad));
    }
    bits |= bits_of(d, hn::Le(near, far)) << i;
  }
  return bits;
}

// Bit i: ray i may enter the child; near[i] is where.
HWY_INLINE std::uint32_t rays_entering(const bvh::Node& node, std::uint32_t child, const Packet& p,
                                       float* HWY_RESTRICT near_out) {
  const DP d;
  const float* planes = &node.lower[0][child];
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    const auto row = [&](const float* r) { return hn::Load(d, r + i); };
    VP near = row(p.tau_min);
    VP far = row(p.tau_max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VP inverse = row(p.inverse[axis]);
      near = hn::Max(
          near, hn::MulAdd(hn::Set(d, planes[p.near_plane[axis]]), inverse, row(p.entry[axis])));
      far = hn::Min(far,
                    hn::MulAdd(hn::Set(d, planes[p.far_plane[axis]]), inverse, row(p.exit[axis])));
    }
    hn::Store(near, d, near_out + i);
    bits |= bits_of(d, hn::Le(near, far)) << i;
  }
  return bits;
}

// One triangle against the rays: bits of those still open, and of those certain.
struct PacketAnswer {
  std::uint32_t open = 0;
  std::uint32_t certain = 0;
  alignas(64) float tau_low[kPacketSize];
  alignas(64) float tau_high[kPacketSize];
};

HWY_INLINE void cull_triangle(const Candidate& t, const LeafBounds& bounds, const Packet& p,
                              PacketAnswer& answer) {
  const DP d;
  const auto corner = [&](std::uint32_t row) {
    const float* copy = t.copy + row * t.stride;
    return V3<VP>{hn::Set(d, copy[0]), hn::Set(d, copy[t.stride]), hn::Set(d, copy[2 * t.stride])};
  };
  answer.open = 0;
  answer.certain = 0;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    Cull<DP> cull(corner(0), corner(3), corner(6), load_rows(d, p.origin[0] + i, kPacketSize),
                  load_rows(d, p.direction[0] + i, kPacketSize), bounds);
    std::uint32_t open = bits_of(d, cull.open());
    if (open == 0) continue;
    cull.find_place();
    open &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), hn::Load(d, p.tau_max + i)));
    if (open == 0) continue;
    const auto certain = cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
    answer.open |= open << i;
    answer.certain |= (bits_of(d, certain) & open) << i;
    hn::Store(cull.low(), d, answer.tau_low + i);
    hn::Store(cull.high(), d, answer.tau_high + i);
  }
}

struct alignas(64) PacketEntry {
  float near[kPacketSize];
  std::uint32_t ref;
  float first_near;  // where the first of the rays enters
};

// Bit i: ray i enters before its tau_max, and so still matters.
HWY_INLINE std::uint32_t rays_left(const float* near, const Packet& p) {
  const DP d;
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    bits |= bits_of(d, hn::Le(hn::Load(d, near + i), hn::Load(d, p.tau_max + i))) << i;
  }
  return bits;
}

// Walks the leaves that some ray of the packet may enter, the nearest first if kOrdered.
// `leaf(leaf, rays)` looks at a leaf for the rays of the bits; `single(ref, ray)` takes one ray on
// from there. Both may lower p.tau_max.
template <bool kOrdered, class LeafVisit, class SingleVisit>
HWY_INLINE void walk_packet(const bvh::Tree& tree, Packet& p, KernelCounts* counts,
                            const LeafVisit& leaf, const SingleVisit& single) {
  PacketEntry stack[kStackSize];
  PacketEntry* top = stack;
  std::copy(std::begin(p.tau_min), std::end(p.tau_min), top->near);
  top->ref = tree.root;
  ++top;
  while (top != stack) {
    const PacketEntry& next = *--top;
    const std::uint32_t ref = next.ref;
    std::uint32_t rays = rays_left(next.near, p) & p.lanes;
    if (std::popcount(rays) <= kFewRays) {
      for (; rays != 0; rays &= rays - 1) {
        single(ref, static_cast<std::uint32_t>(std::countr_zero(rays)));
      }
      continue;
    }
    if (bvh::is_leaf(ref)) {
      if (counts != nullptr) ++counts->leaves;
      leaf(Leaf(tree, ref), rays);
      continue;
    }
    if (counts != nullptr) ++counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    const float greatest_tau_max = *std::max_element(std::begin(p.tau_max), std::end(p.tau_max));
    std::uint32_t children = children_in_reach(node, p, greatest_tau_max);
    PacketEntry* const first = top;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      const std::uint32_t entering = rays_entering(node, child, p, top->near) & rays;
      if (entering == 0) continue;
      top->ref = node.child[child];
      top->first_near = top->near[std::countr_zero(entering)];
      ++top;
    }
    if constexpr (!kOrdered) continue;
    // The nearest on top.
    for (PacketEntry* sorted = first + 1; sorted < top; ++sorted) {
      for (PacketEntry* at = sorted; at > first && at[-1].first_near < at->first_near; --at) {
        std::swap(at[-1], *at);
      }
    }
  }
}

// Takes the rays of a packet to their first hits. `base`: the first one's place in the block.
inline void closest_packet(const bvh::Tree& tree, const RayBlock& block, std::uint32_t base,
                           Packet& p, Referees& referees, Candidate* out, KernelCounts* counts) {
  std::array<FirstHit, kPacketSize> first;
  for (std::uint32_t i = 0; i < kPacketSize; ++i) first[i].tau_max = p.tau_max[i];
  const auto leaf_visit = [&](const Leaf& leaf, std::uint32_t active) {
    const LeafBounds bounds = leaf_bounds(leaf.edge, p.exact);
    PacketAnswer answer;
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
      const Candidate candidate = leaf.candidate(k);
      cull_triangle(candidate, bounds, p, answer);
      for (std::uint32_t open = answer.open & active; open != 0; open &= open - 1) {
        const auto ray = static_cast<std::uint32_t>(std::countr_zero(open));
        if (candidate.primitive == block.skips[base + ray]) continue;
        if (counts != nullptr) ++counts->candidates;
        TauInterval tau{answer.tau_low[ray], answer.tau_high[ray]};
        const bool certain = ((answer.certain >> ray) & 1U) != 0;
        if (!certain && !referees.of(base + ray).is_hit(candidate, tau)) continue;
        first[ray].offer(candidate, tau, [&]() -> Referee& { return referees.of(base + ray); });
        p.tau_max[ray] = first[ray].tau_max;
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    search(tree, block.rays[base + ray], ref, block.skips[base + ray], referees.of(base + ray),
           first[ray], counts);
    p.tau_max[ray] = first[ray].tau_max;
  };
  walk_packet<true>(tree, p, counts, leaf_visit, single_visit);
  for (std::uint32_t rays = p.lanes; rays != 0; rays &= rays - 1) {
    const auto ray = static_cast<std::uint32_t>(std::countr_zero(rays));
    out[base + ray] = first[ray].triangle;
  }
}

inline void any_packet(const bvh::Tree& tree, const RayBlock& block, std::uint32_t base, Packet& p,
                       Referees& referees, std::uint8_t* out, KernelCounts* counts) {
  const auto found = [&](std::uint32_t ray) {
    out[base + ray] = 1;
    p.tau_max[ray] = -bvh::kEmptyPlane;  // looks no further
    p.lanes &= ~(1U << ray);
  };
  const auto leaf_visit = [&](const Leaf& leaf, std::uint32_t active) {
    const LeafBounds bounds = leaf_bounds(leaf.edge, p.exact);
    PacketAnswer answer;
    for (std::uint32_t k = 0; k < leaf.count; ++k) {
      const Candidate candidate = leaf.candidate(k);
      cull_triangle(candidate, bounds, p, answer);
      for (std::uint32_t open = answer.open & active & p.lanes; open != 0; open &= open - 1) {
        const auto ray = static_cast<std::uint32_t>(std::countr_zero(open));
        if (candidate.primitive == block.skips[base + ray]) continue;
        if (counts != nullptr) ++counts->candidates;
        TauInterval tau;
        const bool certain = ((answer.certain >> ray) & 1U) != 0;
        if (certain || referees.of(base + ray).is_hit(candidate, tau)) found(ray);
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    const std::uint32_t i = base + ray;
    if (any_below(tree, block.rays[i], ref, block.skips[i], referees.of(i), counts)) found(ray);
  };
  walk_packet<false>(tree, p, counts, leaf_visit, single_visit);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
