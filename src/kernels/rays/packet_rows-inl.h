// SPDX-License-Identifier: Apache-2.0
//
// A packet's rays, in rows.
#if defined(PIERCE_KERNELS_PACKET_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_ROWS_INL_H_
#undef PIERCE_KERNELS_PACKET_ROWS_INL_H_
#else
#define PIERCE_KERNELS_PACKET_ROWS_INL_H_
#endif

#include "kernels/rays/bundle-inl.h"

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
  std::uint32_t asked;     // questions to the resolver on the way
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

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
