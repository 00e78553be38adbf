// SPDX-License-Identifier: Apache-2.0
//
// A block of rays: coherent neighbours are traversed as packets, the others interleaved.
#if defined(PIERCE_KERNELS_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_BLOCK_INL_H_
#undef PIERCE_KERNELS_BLOCK_INL_H_
#else
#define PIERCE_KERNELS_BLOCK_INL_H_
#endif

#include <algorithm>

#include "kernels/rays/interleaved-inl.h"
#include "kernels/rays/packet_hits-inl.h"
#include "kernels/rays/transform-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// A packet that takes more steps than this for each of its rays does not pay: rays alone take a few
// each, cheaper ones.
inline constexpr std::uint32_t kStepsThatPay = 4;
// Nor does one that asks the resolver more often than this for each: rays alone ask double first.
inline constexpr std::uint32_t kQuestionsThatPay = 2;

// Of the groups that go together.
HWY_INLINE std::uint32_t count_rays(const Packet& p) {
  std::uint32_t count = 0;
  for (std::uint32_t rest = p.together; rest != 0; rest &= rest - 1) {
    count += static_cast<std::uint32_t>(std::popcount(p.rays[std::countr_zero(rest)]));
  }
  return count;
}

// What became of a block's packets.
struct PacketTally {
  std::uint32_t rays = 0;
  std::uint32_t wasted = 0;  // of these, in packets that did not pay

  // A packet of so many rays, traversed.
  HWY_INLINE void add(std::uint32_t count, const Packet& p) {
    rays += count;
    if (p.steps > kStepsThatPay * count || p.asked > kQuestionsThatPay * count) wasted += count;
  }
  [[nodiscard]] HWY_INLINE bool pays() const { return rays > 2 * wasted; }
};

// Calls `packet(base, p, loose)` for coherent groups, as many together as can be, and, if there are
// few triangles, for all others; else, then, `interleaved(rest)`.
template <class OnPacket, class OnInterleaved>
HWY_INLINE void for_packets(const bvh::Tree& tree, const RayBlock& block, Resolver& resolver,
                            const OnPacket& packet, const OnInterleaved& interleaved) {
  const bool few = has_few_triangles(tree);
  Packet p;
  InterleavedRays<FilterRay> rest;
  rest.rays = block.rays;
  rest.skips = block.skips;
  rest.resolver = &resolver;
  std::uint32_t still[kBlockSize], still_count = 0;  // of the rest, those that may not move so
  const bool tried = block.schedule == nullptr || block.schedule->next();
  bool trying = tried;  // until the first of them do not pay
  PacketTally tally;
  for (std::uint32_t base = 0; base < block.count; base += kPacketSize) {
    std::uint32_t groups = 0, loose = 0;
    for (std::size_t i = 0; i < kPacketSize * block.ray_size; i += 64) {
      hwy::Prefetch(block.next + base * block.ray_size + i);
    }
    p.exact = true;
    p.sides = block.sides;
    p.masked = block.masks != nullptr;
    p.reach = kSmallestReach;
    p.boxed = 0;
    for (std::uint32_t g = 0; g < kGroups && base + g * kGroupSize < block.count; ++g) {
      const std::uint32_t first = base + g * kGroupSize;
      const std::uint32_t size = std::min(kGroupSize, block.count - first);
      if (trying && make_group(block, first, size, g, p)) {
        groups |= 1U << g;
        continue;
      }
      if (few) {
        make_loose_group(block, first, size, g, p);
        loose |= 1U << g;
        continue;
      }
      if (is_raw(block)) transform_raw(block, first, size);
      for (std::uint32_t i = 0; i < size; ++i) {
        const std::uint32_t number = first + i;
        const std::uint32_t moves = zero_axes(block.rays[number]) == 0 ? 1 : 0;  // without a branch
        rest.numbers[rest.count] = still[still_count] = number;
        rest.count += moves;
        still_count += 1 - moves;
      }
    }
    if (loose != 0) {
      p.together = loose;
      packet(base, p, true);
    }
    if (groups == 0) continue;
    const auto traverse_tallied = [&] {
      const std::uint32_t count = count_rays(p);  // before the traversal takes away those it found
      packet(base, p, false);
      tally.add(count, p);
      trying = tally.pays();
    };
    if (join_groups(groups, p)) {
      traverse_tallied();
      continue;
    }
    for (; groups != 0; groups &= groups - 1) {
      join_groups(groups & (~groups + 1), p);
      traverse_tallied();
    }
  }
  if (tried && block.schedule != nullptr) block.schedule->tell(tally.pays());
  std::copy(still, still + still_count, rest.numbers + rest.count);
  rest.count += still_count;
  if (rest.count != 0) interleaved(rest);
}

inline void closest_block(const bvh::Tree& tree, const RayBlock& block, Resolver& resolver,
                          Candidate* out, KernelCounts* counts) {
  if (tree.root == bvh::kNoChild) {
    std::fill(out, out + block.count, Candidate{});
    return;
  }
  for_packets(
      tree, block, resolver,
      [&](std::uint32_t base, Packet& p, bool loose) {
        closest_packet({&tree, &block, base, &p, &resolver, counts, loose}, out);
      },
      [&](const InterleavedRays<FilterRay>& rest) {
        traverse_interleaved<false>(
            tree, rest, counts,
            [&](std::uint32_t ray, const FirstHit& first) { out[ray] = first.triangle; });
      });
}

inline void any_block(const bvh::Tree& tree, const RayBlock& block, Resolver& resolver,
                      std::uint8_t* out, KernelCounts* counts) {
  std::fill(out, out + block.count, std::uint8_t{0});
  if (tree.root == bvh::kNoChild) return;
  for_packets(
      tree, block, resolver,
      [&](std::uint32_t base, Packet& p, bool loose) {
        any_packet({&tree, &block, base, &p, &resolver, counts, loose}, out);
      },
      [&](const InterleavedRays<FilterRay>& rest) {
        traverse_interleaved<true>(tree, rest, counts,
                                   [&](std::uint32_t ray, const FirstHit& first) {
                                     out[ray] = first.triangle.primitive != kNone ? 1 : 0;
                                   });
      });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
