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

#include <cmath>

#include "kernels/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// How many rays go together.
inline constexpr std::uint32_t kPacketSize = 16;

using DP = hn::CappedTag<float, kPacketSize>;
using VP = hn::Vec<DP>;
inline constexpr std::uint32_t kPacketLanes = static_cast<std::uint32_t>(hn::MaxLanes(DP{}));

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
  float least_tau_min, greatest_tau_max;
  std::uint32_t lanes;  // bit i: there is a ray i
  bool exact;

  [[nodiscard]] HWY_INLINE FilterRay ray(std::uint32_t i) const {
    return {{origin[0][i], origin[1][i], origin[2][i], 0},
            {direction[0][i], direction[1][i], direction[2][i], 1},
            tau_min[i],
            tau_max[i],
            tau_first[i],
            tau_last[i],
            exact,
            0};
  }
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
  const auto r0 = hn::LoadU(d, first[0]), r1 = hn::LoadU(d, first[1]);
  const auto r2 = hn::LoadU(d, first[2]), r3 = hn::LoadU(d, first[3]);
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
    const auto terms =
        box_terms(d, hn::Load(d, p.origin[axis] + i), hn::Load(d, p.direction[axis] + i));
    hn::Store(terms.inverse, d, p.inverse[axis] + i);
    hn::Store(terms.entry, d, p.entry[axis] + i);
    hn::Store(terms.exit, d, p.exit[axis] + i);
  }
  const Interval inverse = interval_of(p.inverse[axis]);
  p.inverse_low[axis] = inverse.low;
  p.inverse_high[axis] = inverse.high;
  p.pad[axis] = kBoxPad * std::max(std::fabs(inverse.low), std::fabs(inverse.high));
  return true;
}

// What is left to do when the rows of `count` rays are filled. False if the rays do not run alike:
// directions in several octants, or origins or directions far apart.
HWY_INLINE bool finish_packet(std::uint32_t count, Packet& p) {
  if (!make_axis(0, p) || !make_axis(1, p) || !make_axis(2, p)) return false;
  p.lanes = (1U << count) - 1;
  for (std::uint32_t i = count; i < kPacketSize; ++i) p.tau_max[i] = -bvh::kEmptyPlane;
  p.least_tau_min = interval_of(p.tau_min).low;
  p.greatest_tau_max = interval_of(p.tau_max).high;
  return true;
}

HWY_INLINE bool make_packet(const FilterRay* rays, std::uint32_t count, Packet& p) {
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
  return finish_packet(count, p);
}

// The same for rays as they come, by the quick road (road-inl.h), which serves them all.
HWY_INLINE bool make_packet(const Ray<float>* rays, float scale, std::uint32_t count, Packet& p) {
  const DP d;
  const hn::RebindToUnsigned<DP> du;
  alignas(64) float grow[kPacketSize];
  for (std::uint32_t i = 0; i < kPacketSize; i += 4) {
    const float* ray[4];
    for (std::uint32_t k = 0; k < 4; ++k) ray[k] = &rays[i + k < count ? i + k : 0].origin.x;
    transpose({ray[0], ray[1], ray[2], ray[3]},
              {p.origin[0] + i, p.origin[1] + i, p.origin[2] + i, p.direction[0] + i});
    transpose({ray[0] + 4, ray[1] + 4, ray[2] + 4, ray[3] + 4},
              {p.direction[1] + i, p.direction[2] + i, p.tau_min + i, p.tau_max + i});
  }
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    const V3<VP> direction = load_rows(d, p.direction[0] + i, kPacketSize);
    const auto biased = hn::ShiftRight<23>(hn::BitCast(du, max_norm(direction)));
    const VP shrink = hn::BitCast(d, hn::ShiftLeft<23>(hn::Sub(hn::Set(du, 254), biased)));
    hn::Store(hn::BitCast(d, hn::ShiftLeft<23>(biased)), d, grow + i);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      hn::Store(hn::Mul(hn::Load(d, p.origin[axis] + i), hn::Set(d, scale)), d, p.origin[axis] + i);
      hn::Store(hn::Mul(hn::Load(d, p.direction[axis] + i), shrink), d, p.direction[axis] + i);
    }
  }
  const hn::CappedTag<double, 8> dd;
  const hn::Rebind<float, decltype(dd)> half;
  const auto limit = hn::Set(dd, static_cast<double>(bvh::kTauLimit));
  const auto pad = hn::Set(dd, kTauPad);
  for (std::uint32_t i = 0; i < kPacketSize; i += static_cast<std::uint32_t>(hn::Lanes(dd))) {
    const auto tau_scale = hn::Mul(hn::PromoteTo(dd, hn::Load(half, grow + i)),
                                   hn::Set(dd, static_cast<double>(scale)));
    const auto end = [&](const float* t) {
      const auto tau = hn::Mul(hn::PromoteTo(dd, hn::Load(half, t + i)), tau_scale);
      return hn::Min(hn::Max(tau, hn::Neg(limit)), limit);
    };
    const auto first = end(p.tau_min), last = end(p.tau_max);
    hn::Store(hn::DemoteTo(half, hn::Sub(first, pad)), half, p.tau_min + i);
    hn::Store(hn::DemoteTo(half, hn::Add(last, pad)), half, p.tau_max + i);
    hn::Store(hn::DemoteTo(half, hn::Add(first, pad)), half, p.tau_first + i);
    hn::Store(hn::DemoteTo(half, hn::Sub(last, pad)), half, p.tau_last + i);
  }
  p.exact = true;
  return finish_packet(count, p);
}

// What some ray of the packet may reach of eight boxes (or as many as there are lanes), by the
// planes that it enters and leaves by. The products of the distance to a plane and all inverses lie
// between those with the least and the greatest; each is within 13 ulp / |direction| of what the
// box test bounds by 16 (docs/algorithm.md, "Packets").
// `near`: where the first ray may enter.
template <class PlanesOf>
HWY_INLINE hn::Mask<D> in_reach(const Packet& p, const PlanesOf& planes, V& near) {
  const D d;
  near = hn::Set(d, p.least_tau_min);
  V far = hn::Set(d, p.greatest_tau_max);
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

// Bit i: some ray may enter child i, none before entry[i].
HWY_INLINE std::uint32_t children_in_reach(const bvh::Node& node, const Packet& p,
                                           float* HWY_RESTRICT entry) {
  const D d;
  const float* rows = &node.lower[0][0];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < bvh::kWidth; i += kLanes) {
    const auto planes = [&](std::size_t axis) {
      return Planes{hn::Load(d, rows + p.near_plane[axis] + i),
                    hn::Load(d, rows + p.far_plane[axis] + i)};
    };
    V near;
    bits |= bits_of(d, in_reach(p, planes, near)) << i;
    hn::Store(near, d, entry + i);
  }
  return bits;
}

// Bit i: some ray may meet triangle i of the leaf: its box, from the float copies.
HWY_INLINE std::uint32_t triangles_in_reach(const Leaf& leaf, const Packet& p) {
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
    V near;
    bits |= bits_of(d, in_reach(p, planes, near)) << i;
  }
  return bits & ((1U << leaf.count) - 1);
}

// Bit i: ray i may enter the child.
HWY_INLINE std::uint32_t rays_entering(const bvh::Node& node, std::uint32_t child,
                                       const Packet& p) {
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
    bits |= bits_of(d, hn::Le(near, far)) << i;
  }
  return bits;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
