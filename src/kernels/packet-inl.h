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

// How far apart the origins (in a scene of size 2) and the directions (of size 1 to 2) of a packet
// may be.
inline constexpr float kOriginSpread = 0.25F;
inline constexpr float kDirectionSpread = 0.25F;

// Four numbers of each of four rays, `first` being the first ray's: number k of ray i to
// rows[k][i].
HWY_INLINE void transpose(const float* const (&first)[4], float* const (&rows)[4]) {
  const hn::CappedTag<float, 4> d;
  const hn::RepartitionToWide<decltype(d)> wide;
  const auto r0 = hn::Load(d, first[0]), r1 = hn::Load(d, first[1]);
  const auto r2 = hn::Load(d, first[2]), r3 = hn::Load(d, first[3]);
  const auto low01 = hn::BitCast(wide, hn::InterleaveLower(d, r0, r1));  // 0 0 1 1
  const auto low23 = hn::BitCast(wide, hn::InterleaveLower(d, r2, r3));
  const auto high01 = hn::BitCast(wide, hn::InterleaveUpper(d, r0, r1));  // 2 2 3 3
  const auto high23 = hn::BitCast(wide, hn::InterleaveUpper(d, r2, r3));
  hn::Store(hn::BitCast(d, hn::InterleaveLower(wide, low01, low23)), d, rows[0]);
  hn::Store(hn::BitCast(d, hn::InterleaveUpper(wide, low01, low23)), d, rows[1]);
  hn::Store(hn::BitCast(d, hn::InterleaveLower(wide, high01, high23)), d, rows[2]);
  hn::Store(hn::BitCast(d, hn::InterleaveUpper(wide, high01, high23)), d, rows[3]);
}

struct Interval {
  float low, high;
};

HWY_INLINE Interval interval_of(const float* row) {
  const DP d;
  VP low = hn::Load(d, row);
  VP high = low;
  for (std::uint32_t i = kPacketLanes; i < kPacketSize; i += kPacketLanes) {
    low = hn::Min(low, hn::Load(d, row + i));
    high = hn::Max(high, hn::Load(d, row + i));
  }
  return {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
}

// One axis of the packet: the intervals that hold all its rays, and what the box test needs. False
// if the rays do not run alike.
HWY_INLINE bool make_axis(std::size_t axis, Packet& p) {
  const DP d;
  const Interval o = interval_of(p.origin[axis]);
  const Interval slope = interval_of(p.direction[axis]);
  // The sign bits, as those of zeros count too.
  std::uint32_t backwards = 0;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    const hn::RebindToSigned<DP> di;
    const auto bits = hn::BitCast(di, hn::Load(d, p.direction[axis] + i));
    backwards |= bits_of(di, hn::Lt(bits, hn::Zero(di))) << i;
  }
  if (o.high - o.low > kOriginSpread || slope.high - slope.low > kDirectionSpread ||
      (backwards != 0 && backwards != (1U << kPacketSize) - 1)) {
    return false;
  }
  const bool backward = backwards != 0;
  const std::size_t lower = axis * bvh::kWidth;
  p.near_origin[axis] = backward ? o.low : o.high;
  p.far_origin[axis] = backward ? o.high : o.low;
  p.near_plane[axis] = backward ? lower + kUpperPlanes : lower;
  p.far_plane[axis] = backward ? lower : lower + kUpperPlanes;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    const VP direction = hn::Load(d, p.direction[axis] + i);
    const VP steep = hn::Or(hn::Max(hn::Abs(direction), hn::Set(d, kSmallestSlope)),
                            hn::And(direction, hn::Set(d, -0.0F)));
    const VP inverse = hn::Div(hn::Set(d, 1.0F), steep);
    const VP middle = hn::Neg(hn::Mul(hn::Load(d, p.origin[axis] + i), inverse));
    const VP pad = hn::Mul(hn::Set(d, kBoxPad), hn::Abs(inverse));
    hn::Store(inverse, d, p.inverse[axis] + i);
    hn::Store(hn::Sub(middle, pad), d, p.entry[axis] + i);
    hn::Store(hn::Add(middle, pad), d, p.exit[axis] + i);
  }
  const Interval inverse = interval_of(p.inverse[axis]);
  p.inverse_low[axis] = inverse.low;
  p.inverse_high[axis] = inverse.high;
  p.pad[axis] = kBoxPad * std::max(std::fabs(inverse.low), std::fabs(inverse.high));
  return true;
}

// Fills the rows; false if the rays do not run alike: directions in several octants, or origins or
// directions far apart.
HWY_INLINE bool make_packet(const FilterRay* rays, std::uint32_t count, Packet& p) {
  p.lanes = (1U << count) - 1;
  p.exact = true;
  alignas(64) float unused[kPacketSize];
  for (std::uint32_t i = 0; i < kPacketSize; i += 4) {
    const FilterRay* ray[4];
    for (std::uint32_t k = 0; k < 4; ++k) {
      ray[k] = rays + (i + k < count ? i + k : 0);  // the first stands in for those that are not
      p.exact &= ray[k]->exact;
    }
    transpose({ray[0]->origin, ray[1]->origin, ray[2]->origin, ray[3]->origin},
              {p.origin[0] + i, p.origin[1] + i, p.origin[2] + i, unused + i});
    transpose({ray[0]->direction, ray[1]->direction, ray[2]->direction, ray[3]->direction},
              {p.direction[0] + i, p.direction[1] + i, p.direction[2] + i, unused + i});
    transpose({&ray[0]->tau_min, &ray[1]->tau_min, &ray[2]->tau_min, &ray[3]->tau_min},
              {p.tau_min + i, p.tau_max + i, p.tau_first + i, p.tau_last + i});
  }
  if (!make_axis(0, p) || !make_axis(1, p) || !make_axis(2, p)) return false;
  for (std::uint32_t i = count; i < kPacketSize; ++i) p.tau_max[i] = -bvh::kEmptyPlane;
  p.least_tau_min = interval_of(p.tau_min).low;
  return true;
}

// What some ray of the packet may reach of eight boxes (or as many as there are lanes), by the
// planes that it enters and leaves by. The products of the distance to a plane and all inverses lie
// between those with the least and the greatest; each is within 13 ulp / |direction| of what the
// box test bounds by 16 (docs/algorithm.md, "Packets").
template <class Planes>
HWY_INLINE hn::Mask<D> in_reach(const Packet& p, float greatest_tau_max, const Planes& planes) {
  const D d;
  V near = hn::Set(d, p.least_tau_min);
  V far = hn::Set(d, greatest_tau_max);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const V low = hn::Set(d, p.inverse_low[axis]);
    const V high = hn::Set(d, p.inverse_high[axis]);
    const V pad = hn::Set(d, p.pad[axis]);
    const auto [near_plane, far_plane] = planes(axis);
    const V to_near = hn::Sub(near_plane, hn::Set(d, p.near_origin[axis]));
    const V to_far = hn::Sub(far_plane, hn::Set(d, p.far_origin[axis]));
    near = hn::Max(near, hn::Sub(hn::Min(hn::Mul(to_near, low), hn::Mul(to_near, high)), pad));
    far = hn::Min(far, hn::Add(hn::Max(hn::Mul(to_far, low), hn::Mul(to_far, high)), pad));
  }
  return hn::Le(near, far);
}

// The planes by which rays enter and leave.
struct Planes {
  V near, far;
};

// Bit i: some ray may enter child i.
HWY_INLINE std::uint32_t children_in_reach(const bvh::Node& node, const Packet& p,
                                           float greatest_tau_max) {
  const D d;
  const float* rows = &node.lower[0][0];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < bvh::kWidth; i += kLanes) {
    const auto planes = [&](std::size_t axis) {
      return Planes{hn::Load(d, rows + p.near_plane[axis] + i),
                    hn::Load(d, rows + p.far_plane[axis] + i)};
    };
    bits |= bits_of(d, in_reach(p, greatest_tau_max, planes)) << i;
  }
  return bits;
}

// Bit i: some ray may meet triangle i of the leaf: its box, from the float copies.
HWY_INLINE std::uint32_t triangles_in_reach(const Leaf& leaf, const Packet& p,
                                            float greatest_tau_max) {
  const D d;
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < leaf.count; i += kLanes) {
    const auto planes = [&](std::size_t axis) {
      const auto corner = [&](std::size_t k) {
        return hn::LoadU(d, leaf.rows + (3 * k + axis) * leaf.count + i);
      };
      const V lower = hn::Min(hn::Min(corner(0), corner(1)), corner(2));
      const V upper = hn::Max(hn::Max(corner(0), corner(1)), corner(2));
      const bool backward = p.near_plane[axis] >= kUpperPlanes;
      return Planes{backward ? upper : lower, backward ? lower : upper};
    };
    bits |= bits_of(d, in_reach(p, greatest_tau_max, planes)) << i;
  }
  return bits & ((1U << leaf.count) - 1);
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
    std::uint32_t children = children_in_reach(node, p, interval_of(p.tau_max).high);
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
    std::uint32_t triangles = triangles_in_reach(leaf, p, interval_of(p.tau_max).high);
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
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
    std::uint32_t triangles = triangles_in_reach(leaf, p, interval_of(p.tau_max).high);
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
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
