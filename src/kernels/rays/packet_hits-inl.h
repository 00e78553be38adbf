// SPDX-License-Identifier: Apache-2.0
//
// What the rays of a packet hit: first, or at all. Closest hits lie in structure-of-arrays form;
// those of a float scene that float alone was certain of are rounded there and written out.
#if defined(PIERCE_KERNELS_PACKET_HITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_HITS_INL_H_
#undef PIERCE_KERNELS_PACKET_HITS_INL_H_
#else
#define PIERCE_KERNELS_PACKET_HITS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <limits>

#include "kernels/rays/packet_traversal-inl.h"
#include "kernels/rounding/round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The first hits of a packet's rays, as far as they are known: candidates and intervals in rows.
struct PacketHits {
  alignas(64) std::uint32_t primitive[kPacketSize];
  alignas(64) std::uint32_t stride[kPacketSize];  // and the candidate's zeros, from bit 16 on
  alignas(64) std::uint32_t copy[kPacketSize];    // in floats from `copies`
  alignas(64) float low[kPacketSize];
  alignas(64) float high[kPacketSize];
  // If finishing: the triangles' copies, ax ay az bx by bz cx cy cz.
  alignas(64) float corner[9][kPacketSize];
  const float* copies;  // the leaf memory; null if that keeps none
  bool finishing;

  HWY_INLINE PacketHits(const bvh::Tree& tree, bool finish)
      : copies(tree.layout == bvh::Layout::Full ? reinterpret_cast<const float*>(tree.leaves.data())
                                                : nullptr),
        finishing(finish) {
    std::fill_n(primitive, kPacketSize, kNone);
    std::fill_n(low, kPacketSize, std::numeric_limits<float>::infinity());
    std::fill_n(high, kPacketSize, std::numeric_limits<float>::infinity());
    if (!finishing) return;
    const DP d;
    for (float* row : corner) {
      for (std::uint32_t i = 0; i < kPacketSize; i += kGroupLanes)
        hn::Store(hn::Zero(d), d, row + i);
    }
  }
  [[nodiscard]] HWY_INLINE std::uint32_t offset_of(const Candidate& candidate) const {
    static_assert((std::uint64_t{1} << 28) * bvh::kLeafUnit / sizeof(float) <= 1ULL << 32);
    return copies == nullptr ? 0 : static_cast<std::uint32_t>(candidate.copy - copies);
  }
  [[nodiscard]] HWY_INLINE Candidate candidate(std::uint32_t ray) const {
    if (primitive[ray] == kNone) return {};
    return {primitive[ray], stride[ray] & 0xffffU, copies + copy[ray],
            static_cast<std::uint8_t>(stride[ray] >> 16)};
  }
  [[nodiscard]] HWY_INLINE FirstHit first(const Packet& p, std::uint32_t ray) const {
    FirstHit first;
    first.triangle = candidate(ray);
    first.tau = {low[ray], high[ray]};
    first.tau_max = p.tau_max[ray];
    return first;
  }
  HWY_INLINE void set(std::uint32_t ray, const FirstHit& first, Packet& p) {
    if (first.triangle.primitive == kNone) return;
    primitive[ray] = first.triangle.primitive;
    stride[ray] = first.triangle.stride | static_cast<std::uint32_t>(first.triangle.zeros) << 16;
    copy[ray] = offset_of(first.triangle);
    low[ray] = first.tau.low;
    high[ray] = first.tau.high;
    p.tau_max[ray] = first.tau_max;
    if (!finishing) return;
    for (std::size_t k = 0; k < 9; ++k) {
      corner[k][ray] = first.triangle.copy[k * first.triangle.stride];
    }
  }
};

// Rounds the hits of a group from the copies.
HWY_INLINE void round_group(const Packet& p, std::uint32_t g, const PacketHits& hits,
                            RoundedColumns<float>& out) {
  using DD = hn::CappedTag<double, kRoundStep>;
  const DD d;
  const hn::Rebind<float, DD> half;
  out.sure = 0;
  out.front = 0;
  for (std::uint32_t i = 0; i < kGroupSize; i += static_cast<std::uint32_t>(hn::MaxLanes(d))) {
    const auto point = [&](const float(*rows)[kPacketSize]) {
      const auto row = [&](std::size_t k) {
        return hn::PromoteTo(d, hn::Load(half, rows[k] + g * kGroupSize + i));
      };
      return V3<hn::Vec<DD>>{row(0), row(1), row(2)};
    };
    const HitLanes<DD> lanes{point(hits.corner), point(hits.corner + 3), point(hits.corner + 6),
                             point(p.origin), point(p.direction)};
    round_copies(lanes, 1 / p.tau_scale[g], i, out);
  }
}

// The hits of sixteen rays in rows: those of `found`, and misses.
struct HitRows {
  alignas(64) float row[7][kGroupSize];  // t u v w geometry triangle facing

  HWY_INLINE HitRows(const RoundedColumns<float>& numbers, const std::uint32_t* primitives,
                     std::uint32_t found) {
    const DP d;
    const hn::RebindToUnsigned<DP> du;
    const VP none = hn::BitCast(d, hn::Set(du, kNone));
    const VP back = hn::BitCast(d, hn::Set(du, static_cast<std::uint32_t>(Facing::Back)));
    for (std::uint32_t i = 0; i < kGroupSize; i += kGroupLanes) {
      const auto hit = mask_of(d, found >> i);
      const auto put = [&](int k, VP x) { hn::Store(x, d, row[k] + i); };
      put(0, hn::IfThenElse(hit, hn::LoadU(d, numbers.t + i),
                            hn::Set(d, std::numeric_limits<float>::infinity())));
      put(1, hn::IfThenElseZero(hit, hn::LoadU(d, numbers.u + i)));
      put(2, hn::IfThenElseZero(hit, hn::LoadU(d, numbers.v + i)));
      put(3, hn::IfThenElseZero(hit, hn::LoadU(d, numbers.w + i)));
      put(4, hn::IfThenZeroElse(hit, none));
      put(5, hn::IfThenElse(hit, hn::BitCast(d, hn::LoadU(du, primitives + i)), none));
      put(6, hn::IfThenElseZero(mask_of(d, (found & ~numbers.front) >> i), back));
    }
  }
  // Two overlapping stores a hit, four hits at a time.
  HWY_INLINE void write(Hit<float>* to) const {
    static_assert(sizeof(Hit<float>) == 28 && offsetof(Hit<float>, w) == 12 &&
                  offsetof(Hit<float>, triangle) == 20 && offsetof(Hit<float>, facing) == 24 &&
                  std::endian::native == std::endian::little);
    const D4 d;
    for (std::uint32_t i = 0; i < kGroupSize; i += 4) {
      const auto four = [&](int k, std::size_t offset) {
        const V4 rows[4] = {hn::Load(d, row[k] + i), hn::Load(d, row[k + 1] + i),
                            hn::Load(d, row[k + 2] + i), hn::Load(d, row[k + 3] + i)};
        float* hits[4];
        for (int h = 0; h < 4; ++h) {
          hits[h] = reinterpret_cast<float*>(reinterpret_cast<std::byte*>(to + i + h) + offset);
        }
        transpose<false>(rows, hits);
      };
      four(0, 0);
      four(3, offsetof(Hit<float>, w));
    }
  }
};

// Writes what the rays of a group hit, or that they miss, as far as that is certain; returns for
// which. (What it writes for the others means nothing.)
HWY_INLINE std::uint32_t finish_group(const PacketJob& job, std::uint32_t g,
                                      const PacketHits& hits) {
  const Packet& p = *job.packet;
  const std::uint64_t asked = job.block->finished->asked[job.base / 64];
  const std::uint32_t first = g * kGroupSize;
  if (p.tau_scale[g] == 0) return 0;
  const hn::CappedTag<std::uint32_t, kGroupSize> d;
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < kGroupSize; i += static_cast<std::uint32_t>(hn::MaxLanes(d))) {
    const auto primitives = hn::Load(d, hits.primitive + first + i);
    found |= bits_of(d, hn::Ne(primitives, hn::Set(d, kNone))) << i;
  }
  std::uint32_t rays = p.rays[g] & ~static_cast<std::uint32_t>(asked >> first);
  found &= rays;
  FinishedHits& finished = *job.block->finished;
  Hit<float>* const to = finished.hits + job.base + first;
  const auto count = static_cast<std::uint32_t>(std::popcount(p.rays[g]));
  if (found == 0) {
    std::fill_n(to, count, Hit<float>{});
  } else {
    RoundedColumns<float> numbers;
    round_group(p, g, hits, numbers);
    rays &= numbers.sure | ~found;
    found &= rays;
    const HitRows rows(numbers, hits.primitive + first, found);
    if (count == kGroupSize) {
      rows.write(to);
    } else {
      Hit<float> sixteen[kGroupSize];
      rows.write(sixteen);
      std::copy_n(sixteen, count, to);
    }
  }
  finished.found += count_of(found);
  finished.rays[job.base / 64] |= std::uint64_t{rays} << first;
  return rays;
}

// Where the mask says so. (Stores under a mask are slow on many machines, and nothing can be
// forwarded from them.)
template <class D, class T>
HWY_INLINE void blended_store(hn::Vec<D> v, hn::Mask<D> mask, D d, T* HWY_RESTRICT to) {
  hn::Store(hn::IfThenElse(mask, v, hn::Load(d, to)), d, to);
}

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
    left &= job.seeing(candidate.primitive, i);
    if (job.counts != nullptr) job.counts->candidates += count_of(left);
    const auto certain = cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
    const auto nearer = hn::And(certain, hn::Lt(cull.high(), hn::Load(d, hits.low + i)));
    const auto take_bits = bits_of(d, nearer) & left;
    left &= ~take_bits;
    open.rays |= left << lane;
    open.certain |= (bits_of(d, certain) & left) << lane;
    hn::Store(cull.low(), d, open.low + lane);
    hn::Store(cull.high(), d, open.high + lane);
    if (take_bits == 0) continue;
    const auto take = mask_of(d, take_bits);
    blended_store(cull.low(), take, d, hits.low + i);
    blended_store(cull.high(), take, d, hits.high + i);
    blended_store(hn::Min(tau_max, cull.high()), take, d, p.tau_max + i);
    const auto take_u = hn::RebindMask(du, take);
    blended_store(hn::Set(du, candidate.primitive), take_u, du, hits.primitive + i);
    blended_store(hn::Set(du, candidate.stride), take_u, du, hits.stride + i);
    blended_store(hn::Set(du, hits.offset_of(candidate)), take_u, du, hits.copy + i);
    if (hits.finishing) {
      for (std::size_t k = 0; k < 9; ++k) {
        const auto number = hn::Set(d, candidate.copy[k * candidate.stride]);
        blended_store(number, take, d, hits.corner[k] + i);
      }
    }
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
        const FilterRay one = p.ray(ray);
        LeafAnswer answer = cull_leaf<true>(leaf, one, first.tau_max, job.skip(ray));
        if (job.counts != nullptr) job.counts->candidates += count_of(answer.open);
        offer_all(leaf, answer, one, job.resolver_of(ray), first);
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
        p.asked += certain ? 0 : 1;
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
      blended_store(hn::Set(d, -bvh::kEmptyPlane), mask_of(d, rays >> i), d,
                    p.tau_max + g * kGroupSize + i);
    }
  };
  const auto group_visit = [&](const Leaf& leaf, const LeafBounds& bounds, std::uint32_t g,
                               std::uint32_t triangles, const GroupVisit& plan) {
    if (plan.singly) {
      for (std::uint32_t rays = plan.rays; rays != 0; rays &= rays - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rays));
        const std::uint32_t ray = g * kGroupSize + lane;
        if (meets_any<false>(leaf, p.ray(ray), job.skip(ray), job.resolver_of(ray), job.counts))
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
        left &= job.seeing(candidate.primitive, i);
        if (job.counts != nullptr) job.counts->candidates += count_of(left);
        const auto certain =
            cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
        const std::uint32_t sure = bits_of(d, certain) & left;
        found(g, sure << lane);
        left &= ~sure;
        p.asked += count_of(left);
        for (; left != 0; left &= left - 1) {
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
