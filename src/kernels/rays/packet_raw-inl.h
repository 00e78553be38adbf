// SPDX-License-Identifier: Apache-2.0
//
// Rays as they come, brought to filter space and into a packet's rows at once: those of a group
// whose directions shrink by the same power of two. The numbers are those of transform-inl.h.
#if defined(PIERCE_KERNELS_PACKET_RAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_RAW_INL_H_
#undef PIERCE_KERNELS_PACKET_RAW_INL_H_
#else
#define PIERCE_KERNELS_PACKET_RAW_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/rays/packet_rows-inl.h"
#include "kernels/rays/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The range of a ray for all of a group.
template <class Real>
HWY_INLINE void fill_range(const Ray<Real>& ray, double tau_scale, std::uint32_t first, Packet& p) {
  FilterRay range;
  set_range_in_lanes(ray, tau_scale, range);
  const DP d;
  for (std::uint32_t i = first; i < first + kGroupSize; i += kGroupLanes) {
    hn::Store(hn::Set(d, range.tau_min), d, p.tau_min + i);
    hn::Store(hn::Set(d, range.tau_max), d, p.tau_max + i);
    hn::Store(hn::Set(d, range.tau_first), d, p.tau_first + i);
    hn::Store(hn::Set(d, range.tau_last), d, p.tau_last + i);
  }
}

// Rays that are transformed by scaling, with these factors for all of them.
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
  if (one_range) return fill_range(rays[0], tau_scale, first, p);
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

// How far the origins of an extent are from the middle.
HWY_INLINE float distance_of(const Extent& e) {
  const D4 d;
  const V4 size = hn::Max(hn::Abs(e.origin_low), hn::Abs(e.origin_high));
  return hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(hn::FirstN(d, 3), size)));
}

// As many rays as a loop of known length takes.
inline constexpr std::integral_constant<std::size_t, kGroupSize> kFullGroup;

// What became of raw rays: they are in the group's rows; or they have nothing in common; or they
// have, perhaps, but must be transformed one by one.
enum class RawRows { Filled, Incoherent, Unlike };

HWY_INLINE RawRows fill_raw(float scale, const Ray<float>* rays, std::uint32_t count,
                            std::uint32_t g, Packet& p) {
  const D4 d;
  const float* const numbers = &rays->origin.x;
  Extent& extent = p.extent[g];
  extent = extent_of<3>(count == kGroupSize ? extremes_of_sixteen(numbers)
                                            : extremes_of<8>(numbers, count));
  if (extent.mixed != 0) return RawRows::Incoherent;
  const float shrink = common_shrink(extent);
  if (shrink == 0) return RawRows::Unlike;
  const V4 scales = hn::Set(d, scale), shrinks = hn::Set(d, shrink);
  extent.origin_low = hn::Mul(extent.origin_low, scales);
  extent.origin_high = hn::Mul(extent.origin_high, scales);
  extent.direction_low = hn::Mul(extent.direction_low, shrinks);
  extent.direction_high = hn::Mul(extent.direction_high, shrinks);
  if (!extent.coherent()) return RawRows::Incoherent;
  fill_rows(rays, count, scale, shrink, extent.one_range, g * kGroupSize, p);
  p.reach = std::max(p.reach, space::reach_of_origin(distance_of(extent)));
  return RawRows::Filled;
}

// Four doubles, in as few vectors as there are.
template <class Part>
struct DoublesOfFour {
  static constexpr std::size_t kParts = 4 / hn::MaxLanes(Part());
  hn::Vec<Part> parts[kParts];

  // As floats.
  [[nodiscard]] HWY_INLINE V4 floats() const {
    const hn::Rebind<float, Part> df;
    if constexpr (kParts == 1) {
      return hn::DemoteTo(df, parts[0]);
    } else {
      return hn::Combine(D4(), hn::DemoteTo(df, parts[1]), hn::DemoteTo(df, parts[0]));
    }
  }
  // Bit i: number i is a float.
  [[nodiscard]] HWY_INLINE std::uint32_t exact() const {
    const Part d;
    const hn::Rebind<float, Part> df;
    std::uint32_t same = 0;
    for (std::size_t i = 0; i < kParts; ++i) {
      const auto again = hn::PromoteTo(d, hn::DemoteTo(df, parts[i]));
      same |= bits_of(d, hn::Eq(parts[i], again)) << (i * hn::Lanes(d));
    }
    return same;
  }
};

// Brings doubles to filter space: origins and an x of a direction, or four of a direction's axes.
template <class Part>
struct DoubleMap {
  using Four = DoublesOfFour<Part>;
  Four center, factors;  // scale three times, shrink
  hn::Vec<Part> shrink;

  HWY_INLINE DoubleMap(const space::AffineMap& map, double shrinks)
      : shrink(hn::Set(Part(), shrinks)) {
    const Part d;
    const auto scale = hn::Set(d, map.scale);
    for (std::size_t i = 0; i < Four::kParts; ++i) {
      const std::size_t first = i * hn::Lanes(d);
      center.parts[i] = hn::LoadU(d, map.center + first);
      factors.parts[i] = hn::IfThenElse(hn::FirstN(d, 3 - first), scale, shrink);
    }
  }
  [[nodiscard]] HWY_INLINE Four origin_and_x(const double* numbers) const {
    const Part d;
    Four four;
    for (std::size_t i = 0; i < Four::kParts; ++i) {
      const auto number = hn::LoadU(d, numbers + i * hn::Lanes(d));
      four.parts[i] = hn::Mul(hn::Sub(number, center.parts[i]), factors.parts[i]);
    }
    return four;
  }
  [[nodiscard]] HWY_INLINE Four direction(const double* numbers) const {
    const Part d;
    Four four;
    for (std::size_t i = 0; i < Four::kParts; ++i)
      four.parts[i] = hn::Mul(hn::LoadU(d, numbers + i * hn::Lanes(d)), shrink);
    return four;
  }
};

HWY_INLINE RawRows fill_raw(const space::AffineMap& map, const Ray<double>* rays,
                            std::uint32_t count, std::uint32_t g, Packet& p) {
  const double* const numbers = &rays->origin.x;
  const EightExtremes<double> e =
      count == kGroupSize ? extremes_of<8>(numbers, kFullGroup) : extremes_of<8>(numbers, count);
  Extent& extent = p.extent[g];
  extent.mixed = ((e.all ^ e.any) >> 3) & 7U;
  extent.backward = (e.all >> 3) & 7U;
  extent.one_range = e.low[6] == e.high[6] && e.low[7] == e.high[7];
  if (extent.mixed != 0) return RawRows::Incoherent;
  double smallest = 0, largest = 0;  // each ray's size lies between these
  for (std::size_t i = 3; i < 6; ++i) {
    const double low = std::fabs(e.low[i]), high = std::fabs(e.high[i]);
    smallest = std::max(smallest, std::min(low, high));
    largest = std::max(largest, std::max(low, high));
  }
  const std::uint64_t biased = std::bit_cast<std::uint64_t>(largest) >> 52;
  if (!extent.one_range || std::bit_cast<std::uint64_t>(smallest) >> 52 != biased)
    return RawRows::Unlike;
  const double grow = std::bit_cast<double>(biased << 52);
  const double shrink = std::bit_cast<double>((2046 - biased) << 52);

  const DoubleMap<hn::CappedTag<double, 4>> to_filter(map, shrink);
  extent.origin_low = to_filter.origin_and_x(e.low).floats();
  extent.origin_high = to_filter.origin_and_x(e.high).floats();
  extent.direction_low = after_three(extent.origin_low, to_filter.direction(e.low + 4).floats());
  extent.direction_high = after_three(extent.origin_high, to_filter.direction(e.high + 4).floats());
  if (!extent.coherent()) return RawRows::Incoherent;

  const std::uint32_t first = g * kGroupSize;
  alignas(16) float unused[4];
  std::uint32_t exact = map.copies_exact ? 3 : 0;
  for_fours(rays, count, first, [&](const Ray<double>* const(&ray)[4], std::uint32_t i) {
    V4 firsts[4], others[4];
    for (int k = 0; k < 4; ++k) {
      const auto one = to_filter.origin_and_x(&ray[k]->origin.x);
      const auto two = to_filter.direction(&ray[k]->direction.y);
      firsts[k] = one.floats();
      others[k] = two.floats();
      if (exact != 0) exact = one.exact() == 15 ? exact & two.exact() : 0;
    }
    transpose(firsts, {p.origin[0] + i, p.origin[1] + i, p.origin[2] + i, p.direction[0] + i});
    transpose(others, {p.direction[1] + i, p.direction[2] + i, unused, unused});
  });
  p.exact &= exact == 3;
  // What was rounded down to a power of two counts as more.
  p.reach = std::max(p.reach, space::reach_of_origin(distance_of(extent) * (1 + 0x1p-23F)));
  p.tau_scale[g] = map.scale * grow;
  fill_range(rays[0], p.tau_scale[g], first, p);
  return RawRows::Filled;
}

HWY_INLINE bool is_raw(const RayBlock& block) {
  return block.raw != nullptr || block.raw_doubles != nullptr;
}

// Brings raw rays of a block to filter space, one by one.
HWY_INLINE void transform_raw(const RayBlock& block, std::uint32_t base, std::uint32_t count) {
  if (block.raw != nullptr) {
    transform_scaled(block.scale, block.raw + base, count, block.rays + base);
  } else {
    transform_affine(*block.map, block.raw_doubles + base, count, block.rays + base);
  }
  if (block.sides == Sides::Both && block.masks == nullptr) return;
  for (std::uint32_t i = base; i < base + count; ++i) {
    block.rays[i].sides = block.sides;
    block.rays[i].masked = block.masks != nullptr;
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
