// SPDX-License-Identifier: Apache-2.0
//
// The walks of a packet: for its rays' first hits, and for any.
#if defined(PIERCE_KERNELS_PACKET_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_WALK_INL_H_
#undef PIERCE_KERNELS_PACKET_WALK_INL_H_
#else
#define PIERCE_KERNELS_PACKET_WALK_INL_H_
#endif

#include <limits>

#include "kernels/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// With no more than this many rays together, each goes on by itself.
inline constexpr int kFewRays = 2;

// A packet under way: the rays' place in the block and whom to ask.
struct PacketJob {
  const bvh::Tree* tree;
  const RayBlock* block;
  std::uint32_t base;
  Packet* packet;
  Referees* referees;
  KernelCounts* counts;

  [[nodiscard]] HWY_INLINE std::uint32_t skip(std::uint32_t i) const {
    return block->skips[base + i];
  }
  [[nodiscard]] HWY_INLINE Referee& referee(std::uint32_t i) const {
    return referees->of(base + i);
  }
  // The rays that do not see the triangle.
  [[nodiscard]] HWY_INLINE std::uint32_t blind_to(std::uint32_t primitive) const {
    const hn::CappedTag<std::uint32_t, kPacketSize> d;
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
      const auto skips = hn::LoadU(d, block->skips + base + i);
      bits |= bits_of(d, hn::Eq(skips, hn::Set(d, primitive))) << i;
    }
    return bits;
  }
};

// The referee of a ray, made when it is first asked.
class LateReferee final : public Referee {
 public:
  LateReferee(Referees& referees, std::uint32_t ray) : referees_(referees), ray_(ray) {}
  bool is_hit(const Candidate& candidate, TauInterval& tau) override {
    return referees_.of(ray_).is_hit(candidate, tau);
  }
  bool is_before(const Candidate& challenger, const Candidate& best) override {
    return referees_.of(ray_).is_before(challenger, best);
  }

 private:
  Referees& referees_;
  std::uint32_t ray_;
};

// One triangle against the rays from ray i on.
HWY_INLINE Cull<DP> cull_triangle(const Candidate& t, const LeafBounds& bounds, const Packet& p,
                                  std::uint32_t i) {
  const DP d;
  const auto corner = [&](std::uint32_t row) {
    const float* copy = t.copy + row * t.stride;
    return V3<VP>{hn::Set(d, copy[0]), hn::Set(d, copy[t.stride]), hn::Set(d, copy[2 * t.stride])};
  };
  return {corner(0),
          corner(3),
          corner(6),
          load_rows(d, p.origin[0] + i, kPacketSize),
          load_rows(d, p.direction[0] + i, kPacketSize),
          bounds};
}

// What waits: some rays of the packet, none of which enters before `near`. In columns, as a load
// that is wider than the stores before it has to wait for them.
struct PacketStack {
  float near[kStackSize];
  std::uint32_t ref[kStackSize];
  std::uint32_t rays[kStackSize];
};

// Walks the leaves that some ray of the packet may enter, the nearest first if kOrdered.
// `leaf(ref, rays)` looks at a leaf for the rays of the bits; `single(ref, ray)` takes one ray on
// from there. Both may lower the packet's tau_max.
template <bool kOrdered, class LeafVisit, class SingleVisit>
HWY_INLINE void walk_packet(const PacketJob& job, const LeafVisit& leaf,
                            const SingleVisit& single) {
  Packet& p = *job.packet;
  const Places places(*job.tree);
  PacketStack stack;
  stack.near[0] = p.least_tau_min;
  stack.ref[0] = job.tree->root;
  stack.rays[0] = p.lanes;
  for (std::uint32_t top = 1; top != 0;) {
    --top;
    if (stack.near[top] > p.greatest_tau_max) continue;
    const std::uint32_t ref = stack.ref[top];
    std::uint32_t rays = stack.rays[top] & p.lanes;
    if (std::popcount(rays) <= kFewRays) {
      for (; rays != 0; rays &= rays - 1) {
        single(ref, static_cast<std::uint32_t>(std::countr_zero(rays)));
      }
      p.greatest_tau_max = interval_of(p.tau_max).high;
      continue;
    }
    if (bvh::is_leaf(ref)) {
      if (job.counts != nullptr) ++job.counts->leaves;
      leaf(ref, rays);
      p.greatest_tau_max = interval_of(p.tau_max).high;
      continue;
    }
    if (job.counts != nullptr) ++job.counts->nodes;
    const bvh::Node& node = job.tree->nodes[ref];
    alignas(32) float entry[bvh::kWidth];
    std::uint32_t children = children_in_reach(node, p, entry);
    [[maybe_unused]] const std::uint32_t first = top;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      const std::uint32_t entering = rays_entering(node, child, p) & rays;
      if (entering == 0) continue;
      places.send_for(node.child[child]);
      std::uint32_t at = top++;
      if constexpr (kOrdered) {
        for (; at > first && stack.near[at - 1] < entry[child]; --at) {
          stack.near[at] = stack.near[at - 1];
          stack.ref[at] = stack.ref[at - 1];
          stack.rays[at] = stack.rays[at - 1];
        }
      }
      stack.near[at] = entry[child];
      stack.ref[at] = node.child[child];
      stack.rays[at] = entering;
    }
  }
}

// The first hits of a packet's rays, as far as they are known: candidates and intervals in rows.
struct PacketHits {
  alignas(64) std::uint32_t primitive[kPacketSize];
  alignas(64) std::uint32_t stride[kPacketSize];
  alignas(64) std::uint32_t copy[kPacketSize];  // in floats from `copies`
  alignas(64) float low[kPacketSize];
  alignas(64) float high[kPacketSize];
  const float* copies;  // the leaf memory; null if that keeps none

  HWY_INLINE explicit PacketHits(const bvh::Tree& tree)
      : copies(tree.layout == bvh::Layout::Full ? reinterpret_cast<const float*>(tree.leaves.data())
                                                : nullptr) {
    std::fill_n(primitive, kPacketSize, kNone);
    std::fill_n(low, kPacketSize, std::numeric_limits<float>::infinity());
    std::fill_n(high, kPacketSize, std::numeric_limits<float>::infinity());
  }
  [[nodiscard]] HWY_INLINE std::uint32_t place_of(const Candidate& candidate) const {
    static_assert((std::uint64_t{1} << 28) * bvh::kLeafUnit / sizeof(float) <= 1ULL << 32);
    return copies == nullptr ? 0 : static_cast<std::uint32_t>(candidate.copy - copies);
  }
  [[nodiscard]] HWY_INLINE Candidate candidate(std::uint32_t ray) const {
    if (primitive[ray] == kNone) return {};
    return {primitive[ray], stride[ray], copies + copy[ray]};
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
    stride[ray] = first.triangle.stride;
    copy[ray] = place_of(first.triangle);
    low[ray] = first.tau.low;
    high[ray] = first.tau.high;
    p.tau_max[ray] = first.tau_max;
  }
};

// One triangle for the rays of the bits. Where float tells everything, all at once; returns the
// rays for which it does not, with their intervals in `low` and `high`, and of these the certain.
struct Open {
  std::uint32_t rays = 0, certain = 0;
  alignas(64) float low[kPacketSize];
  alignas(64) float high[kPacketSize];
};

HWY_INLINE void take_certain(const PacketJob& job, const Candidate& candidate,
                             const LeafBounds& bounds, std::uint32_t active, PacketHits& hits,
                             Open& open) {
  const DP d;
  const hn::RebindToUnsigned<DP> du;
  Packet& p = *job.packet;
  open.rays = 0;
  open.certain = 0;
  for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
    Cull<DP> cull = cull_triangle(candidate, bounds, p, i);
    std::uint32_t left = bits_of(d, cull.open()) & (active >> i);
    if (left == 0) continue;
    cull.find_place();
    const VP tau_max = hn::Load(d, p.tau_max + i);
    left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), tau_max));
    if (left == 0) continue;
    left &= ~(job.blind_to(candidate.primitive) >> i);
    if (job.counts != nullptr)
      job.counts->candidates += static_cast<std::uint32_t>(std::popcount(left));
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
    hn::BlendedStore(hn::Set(du, hits.place_of(candidate)), take_u, du, hits.copy + i);
    left &= ~take_bits;
    open.rays |= left << i;
    open.certain |= (bits_of(d, certain) & left) << i;
    hn::Store(cull.low(), d, open.low + i);
    hn::Store(cull.high(), d, open.high + i);
  }
}

// Takes the rays of a packet to their first hits.
inline void closest_packet(const PacketJob& job, Candidate* out) {
  Packet& p = *job.packet;
  PacketHits hits(*job.tree);
  bvh::LeafScratch scratch;
  const auto leaf_visit = [&](std::uint32_t ref, std::uint32_t active) {
    const Leaf leaf(*job.tree, ref, scratch);
    const LeafBounds bounds = leaf_bounds(leaf.edge, p.exact);
    Open open;
    std::uint32_t triangles = triangles_in_reach(leaf, p);
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
      take_certain(job, candidate, bounds, active, hits, open);
      for (; open.rays != 0; open.rays &= open.rays - 1) {
        const auto ray = static_cast<std::uint32_t>(std::countr_zero(open.rays));
        TauInterval tau{open.low[ray], open.high[ray]};
        const bool certain = ((open.certain >> ray) & 1U) != 0;
        if (!certain && !job.referee(ray).is_hit(candidate, tau)) continue;
        FirstHit first = hits.first(p, ray);
        first.offer(candidate, tau, [&]() -> Referee& { return job.referee(ray); });
        hits.set(ray, first, p);
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    LateReferee referee(*job.referees, job.base + ray);
    FirstHit first = hits.first(p, ray);
    search(*job.tree, p.ray(ray), ref, job.skip(ray), referee, first, job.counts);
    hits.set(ray, first, p);
  };
  walk_packet<true>(job, leaf_visit, single_visit);
  for (std::uint32_t rays = p.lanes; rays != 0; rays &= rays - 1) {
    const auto ray = static_cast<std::uint32_t>(std::countr_zero(rays));
    out[job.base + ray] = hits.candidate(ray);
  }
}

// Whether the rays of a packet hit anything.
inline void any_packet(const PacketJob& job, std::uint8_t* out) {
  const DP d;
  Packet& p = *job.packet;
  const std::uint32_t all = p.lanes;
  const auto found = [&](std::uint32_t rays) {  // they look no further
    p.lanes &= ~rays;
    for (; rays != 0; rays &= rays - 1) p.tau_max[std::countr_zero(rays)] = -bvh::kEmptyPlane;
  };
  bvh::LeafScratch scratch;
  const auto leaf_visit = [&](std::uint32_t ref, std::uint32_t active) {
    const Leaf leaf(*job.tree, ref, scratch);
    const LeafBounds bounds = leaf_bounds(leaf.edge, p.exact);
    std::uint32_t triangles = triangles_in_reach(leaf, p);
    for (; triangles != 0; triangles &= triangles - 1) {
      const Candidate candidate =
          leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(triangles)));
      for (std::uint32_t i = 0; i < kPacketSize; i += kPacketLanes) {
        Cull<DP> cull = cull_triangle(candidate, bounds, p, i);
        std::uint32_t left = bits_of(d, cull.open()) & ((active & p.lanes) >> i);
        if (left == 0) continue;
        cull.find_place();
        left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), hn::Load(d, p.tau_max + i)));
        if (left == 0) continue;
        left &= ~(job.blind_to(candidate.primitive) >> i);
        if (job.counts != nullptr)
          job.counts->candidates += static_cast<std::uint32_t>(std::popcount(left));
        const auto certain =
            cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
        const std::uint32_t sure = bits_of(d, certain) & left;
        found(sure << i);
        for (left &= ~sure; left != 0; left &= left - 1) {
          const std::uint32_t ray = i + static_cast<std::uint32_t>(std::countr_zero(left));
          TauInterval tau;
          if (job.referee(ray).is_hit(candidate, tau)) found(1U << ray);
        }
      }
    }
  };
  const auto single_visit = [&](std::uint32_t ref, std::uint32_t ray) {
    LateReferee referee(*job.referees, job.base + ray);
    if (any_below(*job.tree, p.ray(ray), ref, job.skip(ray), referee, job.counts)) {
      found(1U << ray);
    }
  };
  walk_packet<false>(job, leaf_visit, single_visit);
  for (std::uint32_t rays = all & ~p.lanes; rays != 0; rays &= rays - 1) {
    out[job.base + static_cast<std::uint32_t>(std::countr_zero(rays))] = 1;
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
