// SPDX-License-Identifier: Apache-2.0
//
// Packets: coherent rays in rows, in groups of sixteen. Up to four groups traverse the tree
// together, as one bundle; in a leaf each group is its own bundle, and what is left is held
// against its sixteen rays.
#if defined(PIERCE_KERNELS_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_INL_H_
#undef PIERCE_KERNELS_PACKET_INL_H_
#else
#define PIERCE_KERNELS_PACKET_INL_H_
#endif

#include <bit>

#include "kernels/rays/bundle-inl.h"
#include "kernels/rays/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

inline constexpr std::uint32_t kGroupSize = 16;
inline constexpr std::uint32_t kGroups = 4;
inline constexpr std::uint32_t kPacketSize = kGroups * kGroupSize;

using DP = hn::CappedTag<float, kGroupSize>;
using VP = hn::Vec<DP>;
inline constexpr std::uint32_t kGroupLanes = static_cast<std::uint32_t>(hn::MaxLanes(DP{}));

// The rays of a packet in rows; those of group g from kGroupSize g on.
struct Packet {
  alignas(64) float origin[3][kPacketSize];
  alignas(64) float direction[3][kPacketSize];
  alignas(64) float tau_min[kPacketSize];
  alignas(64) float tau_max[kPacketSize];  // nothing beyond matters any more
  alignas(64) float tau_first[kPacketSize];
  alignas(64) float tau_last[kPacketSize];
  alignas(64) float inverse[3][kPacketSize];  // as in BoxRay, once `boxed`
  alignas(64) float entry[3][kPacketSize];
  alignas(64) float exit[3][kPacketSize];
  std::uint32_t boxed;          // bit g: those of group g are made
  std::uint32_t rays[kGroups];  // bit i: there is a ray i in the group
  double tau_scale[kGroups];    // tau = t * tau_scale for all rays of the group; 0 if nobody knows
  Extent extent[kGroups];
  Bundles<kGroups> groups;
  Bundle all;              // of the groups that go together,
  std::uint32_t together;  // which are these
  std::uint32_t steps;     // of its traversal
  float reach;             // the largest of all groups
  bool exact;
  Sides sides;
  bool masked;

  [[nodiscard]] HWY_INLINE FilterRay ray(std::uint32_t i) const {
    return {{origin[0][i], origin[1][i], origin[2][i], 0},
            {direction[0][i], direction[1][i], direction[2][i], 1},
            tau_min[i],
            tau_max[i],
            tau_first[i],
            tau_last[i],
            exact,
            sides,
            masked,
            reach,
            0};
  }
};

struct Interval {
  float low, high;
};

// The interval of a group's row.
HWY_INLINE Interval interval_of(const float* row) {
  const DP d;
  VP low = hn::Load(d, row);
  VP high = low;
  for (std::uint32_t i = kGroupLanes; i < kGroupSize; i += kGroupLanes) {
    low = hn::Min(low, hn::Load(d, row + i));
    high = hn::Max(high, hn::Load(d, row + i));
  }
  return {hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
}

// Four numbers of each of four rays, the rays' in a vector each: number k of ray i to rows[k][i].
template <bool kAligned = true>
HWY_INLINE void transpose(const V4 (&r)[4], float* const (&rows)[4]) {
  const D4 d;
  const hn::RepartitionToWide<D4> wide;
  const auto low01 = hn::BitCast(wide, hn::InterleaveLower(d, r[0], r[1]));  // 0 0 1 1
  const auto low23 = hn::BitCast(wide, hn::InterleaveLower(d, r[2], r[3]));
  const auto high01 = hn::BitCast(wide, hn::InterleaveUpper(d, r[0], r[1]));  // 2 2 3 3
  const auto high23 = hn::BitCast(wide, hn::InterleaveUpper(d, r[2], r[3]));
  const auto put = [&](auto numbers, float* row) {
    if constexpr (kAligned) {
      hn::Store(hn::BitCast(d, numbers), d, row);
    } else {
      hn::StoreU(hn::BitCast(d, numbers), d, row);
    }
  };
  put(hn::InterleaveLower(wide, low01, low23), rows[0]);
  put(hn::InterleaveUpper(wide, low01, low23), rows[1]);
  put(hn::InterleaveLower(wide, high01, high23), rows[2]);
  put(hn::InterleaveUpper(wide, high01, high23), rows[3]);
}

// Calls `four(ray, i)` for each four offsets of a group's rows, with the rays to come there; the
// first stands in for those that are not.
template <class Rays, class Four>
HWY_INLINE void for_fours(const Rays* rays, std::uint32_t count, std::uint32_t first,
                          const Four& four) {
  for (std::uint32_t i = 0; i < kGroupSize; i += 4) {
    const Rays* ray[4];
    for (std::uint32_t k = 0; k < 4; ++k) ray[k] = rays + (i + k < count ? i + k : 0);
    four(ray, first + i);
  }
}

HWY_INLINE void fill_rows(const FilterRay* rays, std::uint32_t count, std::uint32_t first,
                          Packet& p) {
  const D4 d;
  alignas(16) float unused[4];
  for_fours(rays, count, first, [&](const FilterRay* const(&ray)[4], std::uint32_t i) {
    V4 origins[4], directions[4], ranges[4];
    for (int k = 0; k < 4; ++k) {
      p.exact &= ray[k]->exact;
      p.reach = std::max(p.reach, ray[k]->reach);
      origins[k] = hn::Load(d, ray[k]->origin);
      directions[k] = hn::Load(d, ray[k]->direction);
      ranges[k] = hn::Load(d, &ray[k]->tau_min);
    }
    transpose(origins, {p.origin[0] + i, p.origin[1] + i, p.origin[2] + i, unused});
    transpose(directions, {p.direction[0] + i, p.direction[1] + i, p.direction[2] + i, unused});
    transpose(ranges, {p.tau_min + i, p.tau_max + i, p.tau_first + i, p.tau_last + i});
  });
}

// The same for rays as they come, transformed by scaling (transform-inl.h) with these factors for
// all of them.
HWY_INLINE void fill_rows(const Ray<float>* rays, std::uint32_t count, float scale, float shrink,
                          bool one_range, std::uint32_t first, Packet& p) {
  const D4 d;
  const V4 shrinks = hn::Set(d, shrink);
  const V4 first_factors = hn::IfThenElse(hn::FirstN(d, 3), hn::Set(d, scale), shrinks);
  const V4 other_factors = hn::IfThenElse(hn::FirstN(d, 2), shrinks, hn::Set(d, 1.0F));
  for_fours(rays, count, first, [&](const Ray<float>* const(&ray)[4], std::uint32_t i) {
    V4 firsts[4], others[4];
    for (int k = 0; k < 4; ++k) {
      firsts[k] = hn::Mul(hn::LoadU(d, &ray[k]->origin.x), first_factors);
      others[k] = hn::Mul(hn::LoadU(d, &ray[k]->direction.y), other_factors);
    }
    transpose(firsts, {p.origin[0] + i, p.origin[1] + i, p.origin[2] + i, p.direction[0] + i});
    transpose(others, {p.direction[1] + i, p.direction[2] + i, p.tau_min + i, p.tau_max + i});
  });
  const double tau_scale = static_cast<double>(scale) / static_cast<double>(shrink);
  p.tau_scale[first / kGroupSize] = tau_scale;
  if (one_range) {
    FilterRay ray;
    set_range_in_lanes(rays[0], tau_scale, ray);
    const DP dp;
    for (std::uint32_t i = first; i < first + kGroupSize; i += kGroupLanes) {
      hn::Store(hn::Set(dp, ray.tau_min), dp, p.tau_min + i);
      hn::Store(hn::Set(dp, ray.tau_max), dp, p.tau_max + i);
      hn::Store(hn::Set(dp, ray.tau_first), dp, p.tau_first + i);
      hn::Store(hn::Set(dp, ray.tau_last), dp, p.tau_last + i);
    }
    return;
  }
  const hn::CappedTag<double, 8> dd;
  const hn::Rebind<float, decltype(dd)> half;
  const auto limit = hn::Set(dd, static_cast<double>(space::kTauLimit));
  const auto pad_of = [&](auto tau) {
    return hn::MulAdd(hn::Abs(tau), hn::Set(dd, kTauPad), hn::Set(dd, kTauFloorKept));
  };
  for (std::uint32_t i = first; i < first + kGroupSize;
       i += static_cast<std::uint32_t>(hn::MaxLanes(dd))) {
    const auto end = [&](const float* t) {
      const auto tau = hn::Mul(hn::PromoteTo(dd, hn::Load(half, t + i)), hn::Set(dd, tau_scale));
      return hn::Min(hn::Max(tau, hn::Neg(limit)), limit);
    };
    const auto first_tau = end(p.tau_min), last_tau = end(p.tau_max);
    const auto first_pad = pad_of(first_tau), last_pad = pad_of(last_tau);
    hn::Store(hn::DemoteTo(half, hn::Sub(first_tau, first_pad)), half, p.tau_min + i);
    hn::Store(hn::DemoteTo(half, hn::Add(last_tau, last_pad)), half, p.tau_max + i);
    hn::Store(hn::DemoteTo(half, hn::Add(first_tau, first_pad)), half, p.tau_first + i);
    hn::Store(hn::DemoteTo(half, hn::Sub(last_tau, last_pad)), half, p.tau_last + i);
  }
}

// The power of two by which scaling shrinks the directions of an extent that is not mixed: 0
// if it is not the same for all.
HWY_INLINE float common_shrink(const Extent& e) {
  const D4 d;
  const V4 low = hn::Abs(e.direction_low), high = hn::Abs(e.direction_high);
  const auto greatest_of_three = [&](V4 x) {
    return hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(hn::FirstN(d, 3), x)));
  };
  // Each ray's size lies between these.
  const float smallest = greatest_of_three(hn::Min(low, high));
  const float largest = greatest_of_three(hn::Max(low, high));
  const std::uint32_t biased = std::bit_cast<std::uint32_t>(largest) >> 23;
  if (std::bit_cast<std::uint32_t>(smallest) >> 23 != biased) return 0;
  return std::bit_cast<float>((254 - biased) << 23);
}

// Brings raw rays of a block to filter space.
HWY_INLINE void transform_raw(const RayBlock& block, std::uint32_t base, std::uint32_t count) {
  transform_scaled(block.scale, block.raw + base, count, block.rays + base);
  if (block.sides == Sides::Both && block.masks == nullptr) return;
  for (std::uint32_t i = base; i < base + count; ++i) {
    block.rays[i].sides = block.sides;
    block.rays[i].masked = block.masks != nullptr;
  }
}

// Makes group g of the block's rays from number `base` on; false if they are not coherent.
HWY_INLINE bool make_group(const RayBlock& block, std::uint32_t base, std::uint32_t count,
                           std::uint32_t g, Packet& p) {
  const D4 d;
  Extent& extent = p.extent[g];
  float shrink = 0;
  if (block.raw != nullptr) {
    const float* const numbers = &block.raw[base].origin.x;
    extent = extent_of<3>(count == kGroupSize ? extremes_of_sixteen(numbers)
                                              : extremes_of<8>(numbers, count));
    if (extent.mixed != 0) return false;
    shrink = common_shrink(extent);
    const V4 scale = hn::Set(d, block.scale), shrinks = hn::Set(d, shrink);
    extent.origin_low = hn::Mul(extent.origin_low, scale);
    extent.origin_high = hn::Mul(extent.origin_high, scale);
    extent.direction_low = hn::Mul(extent.direction_low, shrinks);
    extent.direction_high = hn::Mul(extent.direction_high, shrinks);
  }
  const std::uint32_t first = g * kGroupSize;
  if (shrink != 0) {
    if (!extent.coherent()) return false;
    fill_rows(block.raw + base, count, block.scale, shrink, extent.one_range, first, p);
    const V4 size = hn::Max(hn::Abs(extent.origin_low), hn::Abs(extent.origin_high));
    p.reach = std::max(p.reach, space::reach_of_origin(hn::GetLane(hn::MaxOfLanes(
                                    d, hn::IfThenElseZero(hn::FirstN(d, 3), size)))));
  } else {
    if (block.raw != nullptr) transform_raw(block, base, count);
    static_assert(sizeof(FilterRay) % sizeof(float) == 0 && offsetof(FilterRay, direction) == 16);
    constexpr std::size_t kStride = sizeof(FilterRay) / sizeof(float);
    extent = extent_of<4>(extremes_of<kStride>(block.rays[base].origin, count));
    if (!extent.coherent()) return false;
    fill_rows(block.rays + base, count, first, p);
    p.tau_scale[g] = 0;
  }
  p.rays[g] = (1U << count) - 1;
  set_bundle(extent, g, p.groups);
  if (extent.one_range) {
    p.groups.least_tau_min[g] = p.tau_min[first];
    p.groups.greatest_tau_max[g] = p.tau_max[first];
  } else {
    p.groups.least_tau_min[g] = interval_of(p.tau_min + first).low;
    p.groups.greatest_tau_max[g] = interval_of(p.tau_max + first).high;
  }
  for (std::uint32_t i = count; i < kGroupSize; ++i) p.tau_max[first + i] = -bvh::kEmptyPlane;
  return true;
}

// The same of rays that need not be coherent, but for their bundle.
HWY_INLINE void make_loose_group(const RayBlock& block, std::uint32_t base, std::uint32_t count,
                                 std::uint32_t g, Packet& p) {
  const std::uint32_t first = g * kGroupSize;
  if (block.raw != nullptr) transform_raw(block, base, count);
  fill_rows(block.rays + base, count, first, p);
  p.tau_scale[g] = 0;
  p.rays[g] = (1U << count) - 1;
  for (std::uint32_t i = count; i < kGroupSize; ++i) p.tau_max[first + i] = -bvh::kEmptyPlane;
}

// Lets these groups go together, if they are coherent.
HWY_INLINE bool join_groups(std::uint32_t groups, Packet& p) {
  const auto first = static_cast<std::uint32_t>(std::countr_zero(groups));
  p.together = groups;
  Extent extent = p.extent[first];
  float least = p.groups.least_tau_min[first];
  for (std::uint32_t rest = groups & (groups - 1); rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    extent |= p.extent[g];
    least = std::min(least, p.groups.least_tau_min[g]);
  }
  if (!extent.coherent()) return false;
  set_bundle(extent, 0, p.all);
  p.all.least_tau_min[0] = least;
  return true;
}

// Where the rays of the groups end, now. (Stored and read as a whole, as a load that is wider than
// the stores before it has to wait for them.)
HWY_INLINE void shorten(V4 greatest_tau_max, Packet& p) {
  const D4 d;
  hn::StoreU(greatest_tau_max, d, p.groups.greatest_tau_max);
  const auto ends =
      hn::IfThenElse(mask_of(d, p.together), greatest_tau_max, hn::Set(d, -bvh::kEmptyPlane));
  p.all.greatest_tau_max[0] = hn::GetLane(hn::MaxOfLanes(d, ends));
}

HWY_INLINE void make_boxed(std::uint32_t g, Packet& p) {
  if (((p.boxed >> g) & 1U) != 0) return;
  p.boxed |= 1U << g;
  const DP d;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::uint32_t i = g * kGroupSize; i < (g + 1) * kGroupSize; i += kGroupLanes) {
      const auto terms =
          box_terms(d, hn::Load(d, p.origin[axis] + i), hn::Load(d, p.direction[axis] + i));
      hn::Store(terms.inverse, d, p.inverse[axis] + i);
      hn::Store(terms.entry, d, p.entry[axis] + i);
      hn::Store(terms.exit, d, p.exit[axis] + i);
    }
  }
}

// Bit i: ray i of group g may enter the child, of which the first plane is given.
HWY_INLINE std::uint32_t rays_entering(const float* child, const PlaneOffsets& offsets,
                                       std::uint32_t g, Packet& p) {
  make_boxed(g, p);
  const DP d;
  std::uint32_t bits = 0;
  for (std::uint32_t i = 0; i < kGroupSize; i += kGroupLanes) {
    const auto row = [&](const float* r) { return hn::Load(d, r + g * kGroupSize + i); };
    VP near = row(p.tau_min);
    VP far = row(p.tau_max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VP inverse = row(p.inverse[axis]);
      near = hn::Max(
          near, hn::MulAdd(hn::Set(d, child[offsets.near[axis]]), inverse, row(p.entry[axis])));
      far = hn::Min(far,
                    hn::MulAdd(hn::Set(d, child[offsets.far[axis]]), inverse, row(p.exit[axis])));
    }
    bits |= bits_of(d, hn::Le(near, far)) << i;
  }
  return bits;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
