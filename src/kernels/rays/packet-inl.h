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

#include "kernels/rays/packet_raw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Makes group g of the block's rays from number `base` on; false if they are not coherent.
HWY_INLINE bool make_group(const RayBlock& block, std::uint32_t base, std::uint32_t count,
                           std::uint32_t g, Packet& p) {
  Extent& extent = p.extent[g];
  const std::uint32_t first = g * kGroupSize;
  RawRows raw = RawRows::Unlike;
  if (block.raw != nullptr) {
    raw = fill_raw(block.scale, block.raw + base, count, g, p);
  } else if (block.raw_doubles != nullptr) {
    raw = fill_raw(*block.map, block.raw_doubles + base, count, g, p);
  }
  if (raw == RawRows::Incoherent) return false;
  if (raw == RawRows::Unlike) {
    if (is_raw(block)) transform_raw(block, base, count);
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
  if (is_raw(block)) transform_raw(block, base, count);
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
