// SPDX-License-Identifier: Apache-2.0
//
// What the rays of a packet hit: first, or at all.
#if defined(PIERCE_KERNELS_PACKET_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_HITS_INL_H_
#undef PIERCE_KERNELS_PACKET_HITS_INL_H_
#else
#define PIERCE_KERNELS_PACKET_HITS_INL_H_
#endif

#include "kernels/rays/packet_finish-inl.h"
#include "kernels/rays/packet_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// One triangle for the rays of the bits. Where float tells everything, all at once; returns the
// rays for which it does not, with their intervals in `low` and `high`, and of these the certain.
struct Open {
  std::uint32_t rays = 0, certain = 0;
  alignas(64) float low[kGroupSize];
  alignas(64) float high[kGroupSize];
};

HWY_INLINE void take_certain(const PacketJob& job, const Candidate& candidate,
                             const LeafBounds& bounds, std::uint32_t group, std::uint32_t active,
                             PacketHits& hits, Open& open) {
  const DP d;
  const hn::RebindToUnsigned<DP> du;
  Packet& p = *job.packet;
  open.rays = 0;
  open.certain = 0;
  for (std::uint32_t lane = 0; lane < kGroupSize; lane += kGroupLanes) {
    const std::uint32_t i = group * kGroupSize + lane;
    Cull<DP> cull = cull_triangle(candidate, bounds, p, i);
    std::uint32_t left = bits_of(d, cull.open()) & (active >> lane);
    if (left == 0) continue;
    cull.compute_tau();
    const VP tau_max = hn::Load(d, p.tau_max + i);
    left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), tau_max));
    if (left == 0) continue;
    left &= ~job.skip_mask(candidate.primitive, i);
    if (job.counts != nullptr) job.counts->candidates += count_of(left);
    const auto certain = cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
    const auto nearer = hn::And(certain, hn::Lt(cull.high(), hn::Load(d, hits.low + i)));
    const auto take_bits = bits_of(d, nearer) & left;
    const auto take = mask_of(d, take_bits);
    hn::BlendedStore(cull.low(), take, d, hits.low + i);
    hn::BlendedStore(cull.high(), take, d, hits.high + i);
    hn::BlendedStore(hn::Min(tau_max, cull.high()), take, d, p.tau_max + i);
    const auto take_u = hn::RebindMask(du, take);
    hn::BlendedStore(hn::Set(du, candidate.primitive), take_u, du, hits.primitive + i);
    hn::BlendedStore(hn::Set(du, candidate.stride), take_u, du, hits.stride + i);
    hn::BlendedStore(hn::Set(du, hits.offset_of(candidate)), take_u, du, hits.copy + i);
    if (hits.finishing) {
      for (std::size_t k = 0; k < 9; ++k) {
        const auto number = hn::Set(d, candidate.copy[k * candidate.stride]);
        hn::BlendedStore(number, take, d, hits.corner[k] + i);
      }
    }
    left &= ~take_bits;
    open.rays |= left << lane;
    open.certain |= (bits_of(d, certain) & left) << lane;
    hn::Store(cull.low(), d, open.low + lane);
    hn::Store(cull.high(), d, open.high + lane);
  }
}

// Takes the rays of a packet to their first hits.
inline void closest_packet(const PacketJob& job, Candidate* out) {
  Packet& p = *job.packet;
  PacketHits hits(*job.tree, job.block->finished != nullptr);
  const auto group_visit = [&](const Leaf& leaf, const LeafBounds& bounds, std::uint32_t g,
                               std::uint32_t triangles, const GroupVisit& plan) {
    const std::uint32_t first_ray = g * kGroupSize;
    if (plan.singly) {
      for (std::uint32_t rays = plan.rays; rays != 0; rays &= rays - 1) {
        const std::uint32_t ray = first_ray + static_cast<std::uint32_t>(std::countr_zero(rays));
        FirstHit first = hits.first(p, ray);
        const LeafAnswer answer = cull_leaf<true>(leaf, p.ray(ray), first.tau_max, job.skip(ray));
        if (job.counts != nullptr) job.counts->candidates += count_of(answer.open);
        offer_all(leaf, answer, job.resolver_of(ray), first);
        hits.set(ray, first, p);
      }
      return;
    }
    Open open;
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
      take_certain(job, candidate, bounds, g, plan.rays, hits, open);
      for (; open.rays != 0; open.rays &= open.rays - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(open.rays));
        const std::uint32_t ray = first_ray + lane;
        TauInterval tau{open.low[lane], open.high[lane]};
        const bool certain = ((open.certain >> lane) & 1U) != 0;
        if (!certain && !job.resolver_of(ray).is_hit(candidate, tau)) continue;
        FirstHit first = hits.first(p, ray);
        first.offer(candidate, tau, job.resolver_of(ray));
        hits.set(ray, first, p);
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    FirstHit first = hits.first(p, ray);
    search(*job.tree, p.ray(ray), ref, job.skip(ray), job.resolver_of(ray), first, job.counts);
    hits.set(ray, first, p);
  };
  traverse_packet<true>(job, group_visit, single_visit);
  for (std::uint32_t rest = p.together; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    const std::uint32_t finished = hits.finishing ? finish_group(job, g, hits) : 0;
    for (std::uint32_t rays = p.rays[g] & ~finished; rays != 0; rays &= rays - 1) {
      const std::uint32_t ray = g * kGroupSize + static_cast<std::uint32_t>(std::countr_zero(rays));
      out[job.base + ray] = hits.candidate(ray);
    }
  }
}

// A byte for each of sixteen rays, but for those at the end that there are not.
HWY_INLINE void write_found(std::uint32_t found, std::uint32_t rays, std::uint8_t* out) {
  const hn::CappedTag<std::uint8_t, kGroupSize> d;
  static_assert(hn::MaxLanes(d) == kGroupSize);
  alignas(16) std::uint8_t bytes[kGroupSize];
  const auto ones = hn::IfThenElseZero(mask_of(d, found), hn::Set(d, std::uint8_t{1}));
  if (rays == (1U << kGroupSize) - 1) {
    hn::StoreU(ones, d, out);
  } else {
    hn::Store(ones, d, bytes);
    std::copy_n(bytes, std::popcount(rays), out);
  }
}

// Whether the rays of a packet hit anything.
inline void any_packet(const PacketJob& job, std::uint8_t* out) {
  const DP d;
  Packet& p = *job.packet;
  std::uint32_t wanted[kGroups];
  std::copy_n(p.rays, kGroups, wanted);
  const auto found = [&](std::uint32_t g, std::uint32_t rays) {  // they look no further
    p.rays[g] &= ~rays;
    for (std::uint32_t i = 0; i < kGroupSize; i += kGroupLanes) {
      hn::BlendedStore(hn::Set(d, -bvh::kEmptyPlane), mask_of(d, rays >> i), d,
                       p.tau_max + g * kGroupSize + i);
    }
  };
  const auto group_visit = [&](const Leaf& leaf, const LeafBounds& bounds, std::uint32_t g,
                               std::uint32_t triangles, const GroupVisit& plan) {
    if (plan.singly) {
      for (std::uint32_t rays = plan.rays; rays != 0; rays &= rays - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rays));
        const std::uint32_t ray = g * kGroupSize + lane;
        if (meets_any(leaf, p.ray(ray), job.skip(ray), job.resolver_of(ray), job.counts))
          found(g, 1U << lane);
      }
      return;
    }
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
      for (std::uint32_t lane = 0; lane < kGroupSize; lane += kGroupLanes) {
        const std::uint32_t i = g * kGroupSize + lane;
        Cull<DP> cull = cull_triangle(candidate, bounds, p, i);
        std::uint32_t left = bits_of(d, cull.open()) & ((plan.rays & p.rays[g]) >> lane);
        if (left == 0) continue;
        cull.compute_tau();
        left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), hn::Load(d, p.tau_max + i)));
        if (left == 0) continue;
        left &= ~job.skip_mask(candidate.primitive, i);
        if (job.counts != nullptr) job.counts->candidates += count_of(left);
        const auto certain =
            cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
        const std::uint32_t sure = bits_of(d, certain) & left;
        found(g, sure << lane);
        for (left &= ~sure; left != 0; left &= left - 1) {
          const std::uint32_t ray = lane + static_cast<std::uint32_t>(std::countr_zero(left));
          TauInterval tau;
          if (job.resolver_of(g * kGroupSize + ray).is_hit(candidate, tau)) found(g, 1U << ray);
        }
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    if (any_below(*job.tree, p.ray(ray), ref, job.skip(ray), job.resolver_of(ray), job.counts)) {
      found(ray / kGroupSize, 1U << (ray % kGroupSize));
    }
  };
  traverse_packet<false>(job, group_visit, single_visit);
  for (std::uint32_t rest = p.together; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    write_found(wanted[g] & ~p.rays[g], wanted[g], out + job.base + g * kGroupSize);
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
