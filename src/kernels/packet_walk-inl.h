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

// From so many triangles on it is worth a look which of its rays a group takes into a leaf.
inline constexpr int kManyTriangles = 2;

// A packet under way: the place in the block of its first ray, and whom to ask.
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
  // Of the rays from ray i on, those that do not see the triangle.
  [[nodiscard]] HWY_INLINE std::uint32_t blind_to(std::uint32_t primitive, std::uint32_t i) const {
    const hn::CappedTag<std::uint32_t, kGroupSize> d;
    const auto skips = hn::LoadU(d, block->skips + base + i);
    return bits_of(d, hn::Eq(skips, hn::Set(d, primitive)));
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

// What waits: children of nodes (number of the node times eight, and of the child), none of which
// any ray enters before `near`.
struct PacketStack {
  float near[kStackSize];
  std::uint32_t child[kStackSize];
};

// A leaf that groups of a packet may enter, and its box: the planes of the child of a node that it
// is, or null if it is the root.
struct PacketLeaf {
  std::uint32_t ref;
  std::uint32_t groups;
  const float* box;
};

// Walks the leaves that some ray of the packet may enter, the nearest first if kOrdered; `visit`
// may lower the packet's tau_max.
template <bool kOrdered, class LeafVisit>
HWY_INLINE void walk_packet(const PacketJob& job, const PlanePlaces& planes,
                            const LeafVisit& visit) {
  Packet& p = *job.packet;
  const bvh::Tree& tree = *job.tree;
  const Places places(tree);
  shorten(hn::LoadU(D4(), p.groups.greatest_tau_max), p);
  if (bvh::is_leaf(tree.root)) {
    visit(PacketLeaf{tree.root, p.together, nullptr});
    return;
  }
  PacketStack stack;
  std::uint32_t top = 0;
  for (std::uint32_t ref = tree.root;;) {
    if (job.counts != nullptr) ++job.counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    alignas(32) float entry[bvh::kWidth];
    std::uint32_t children = children_in_reach(node, planes, p.all, entry);
    [[maybe_unused]] const std::uint32_t first = top;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      places.send_for(node.child[child]);
      std::uint32_t at = top++;
      if constexpr (kOrdered) {
        for (; at > first && stack.near[at - 1] < entry[child]; --at) {
          stack.near[at] = stack.near[at - 1];
          stack.child[at] = stack.child[at - 1];
        }
      }
      stack.near[at] = entry[child];
      stack.child[at] = ref * bvh::kWidth + child;
    }
    for (;;) {
      if (top == 0) return;
      --top;
      if (stack.near[top] > p.all.greatest_tau_max[0]) continue;
      const bvh::Node& parent = tree.nodes[stack.child[top] / bvh::kWidth];
      const std::uint32_t child = stack.child[top] % bvh::kWidth;
      const float* const box = &parent.lower[0][child];
      const std::uint32_t groups = bundles_entering(box, planes, p.groups) & p.together;
      if (groups == 0) continue;
      ref = parent.child[child];
      if (!bvh::is_leaf(ref)) break;
      visit(PacketLeaf{ref, groups, box});
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
    cull.find_place();
    const VP tau_max = hn::Load(d, p.tau_max + i);
    left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), tau_max));
    if (left == 0) continue;
    left &= ~job.blind_to(candidate.primitive, i);
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
    hn::BlendedStore(hn::Set(du, hits.place_of(candidate)), take_u, du, hits.copy + i);
    left &= ~take_bits;
    open.rays |= left << lane;
    open.certain |= (bits_of(d, certain) & left) << lane;
    hn::Store(cull.low(), d, open.low + lane);
    hn::Store(cull.high(), d, open.high + lane);
  }
}

// Of a leaf and a group: whether its rays should go one by one, and which may enter at all.
struct GroupVisit {
  std::uint32_t rays;
  bool singly;
};

HWY_INLINE GroupVisit plan_visit(const PacketLeaf& at, const PlanePlaces& planes,
                                 std::uint32_t triangles, std::uint32_t g, Packet& p) {
  std::uint32_t rays = p.rays[g];
  const int count = std::popcount(triangles);
  if (count < kManyTriangles || at.box == nullptr) return {rays, false};
  rays &= rays_entering(at.box, planes, g, p);
  return {rays, count > std::popcount(rays)};
}

// Calls `visit(leaf, bounds, group, triangles, plan)` for each group that may meet triangles.
template <class GroupVisitor>
HWY_INLINE void visit_groups(const PacketJob& job, const PacketLeaf& at, const PlanePlaces& planes,
                             std::uint32_t backward, bvh::LeafScratch& scratch,
                             const GroupVisitor& visit) {
  Packet& p = *job.packet;
  if (job.counts != nullptr) ++job.counts->leaves;
  const Leaf leaf(*job.tree, at.ref, scratch);
  const LeafBounds bounds = leaf_bounds(leaf.edge, p.exact);
  const TriangleBoxes boxes(leaf, backward);
  const D4 d;
  V4 ends = hn::LoadU(d, p.groups.greatest_tau_max);
  for (std::uint32_t rest = at.groups; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    const std::uint32_t triangles = boxes.in_reach_of(p.groups, g);
    if (triangles == 0) continue;
    const GroupVisit plan = plan_visit(at, planes, triangles, g, p);
    if (plan.rays == 0) continue;
    visit(leaf, bounds, g, triangles, plan);
    const V4 end = hn::Set(d, interval_of(p.tau_max + g * kGroupSize).high);
    ends = hn::IfThenElse(mask_of(d, 1U << g), end, ends);
  }
  shorten(ends, p);
}

// Takes the rays of a packet to their first hits.
inline void closest_packet(const PacketJob& job, Candidate* out) {
  Packet& p = *job.packet;
  PacketHits hits(*job.tree);
  bvh::LeafScratch scratch;
  const auto group_visit = [&](const Leaf& leaf, const LeafBounds& bounds, std::uint32_t g,
                               std::uint32_t triangles, const GroupVisit& plan) {
    const std::uint32_t first_ray = g * kGroupSize;
    if (plan.singly) {
      for (std::uint32_t rays = plan.rays; rays != 0; rays &= rays - 1) {
        const std::uint32_t ray = first_ray + static_cast<std::uint32_t>(std::countr_zero(rays));
        FirstHit first = hits.first(p, ray);
        const LeafAnswer answer = cull_leaf<true>(leaf, p.ray(ray), first.tau_max, job.skip(ray));
        if (job.counts != nullptr) job.counts->candidates += count_of(answer.open);
        offer_all(
            leaf, answer, [&]() -> Referee& { return job.referee(ray); }, first);
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
        if (!certain && !job.referee(ray).is_hit(candidate, tau)) continue;
        FirstHit first = hits.first(p, ray);
        first.offer(candidate, tau, [&]() -> Referee& { return job.referee(ray); });
        hits.set(ray, first, p);
      }
    }
  };
  const std::uint32_t backward = p.extent[std::countr_zero(p.together)].backward;
  const PlanePlaces planes(backward);
  walk_packet<true>(job, planes, [&](const PacketLeaf& at) {
    visit_groups(job, at, planes, backward, scratch, group_visit);
  });
  for (std::uint32_t rest = p.together; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    for (std::uint32_t rays = p.rays[g]; rays != 0; rays &= rays - 1) {
      const std::uint32_t ray = g * kGroupSize + static_cast<std::uint32_t>(std::countr_zero(rays));
      out[job.base + ray] = hits.candidate(ray);
    }
  }
}

// Whether the rays of a packet hit anything.
inline void any_packet(const PacketJob& job, std::uint8_t* out) {
  const DP d;
  Packet& p = *job.packet;
  const auto found = [&](std::uint32_t g, std::uint32_t rays) {  // they look no further
    p.rays[g] &= ~rays;
    for (; rays != 0; rays &= rays - 1) {
      const std::uint32_t ray = g * kGroupSize + static_cast<std::uint32_t>(std::countr_zero(rays));
      p.tau_max[ray] = -bvh::kEmptyPlane;
      out[job.base + ray] = 1;
    }
  };
  bvh::LeafScratch scratch;
  const auto group_visit = [&](const Leaf& leaf, const LeafBounds& bounds, std::uint32_t g,
                               std::uint32_t triangles, const GroupVisit& plan) {
    if (plan.singly) {
      for (std::uint32_t rays = plan.rays; rays != 0; rays &= rays - 1) {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(rays));
        const std::uint32_t ray = g * kGroupSize + lane;
        const auto referee = [&]() -> Referee& { return job.referee(ray); };
        if (meets_any(leaf, p.ray(ray), job.skip(ray), referee, job.counts)) found(g, 1U << lane);
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
        cull.find_place();
        left &= bits_of(d, cull.in_range(hn::Load(d, p.tau_min + i), hn::Load(d, p.tau_max + i)));
        if (left == 0) continue;
        left &= ~job.blind_to(candidate.primitive, i);
        if (job.counts != nullptr) job.counts->candidates += count_of(left);
        const auto certain =
            cull.certain(hn::Load(d, p.tau_first + i), hn::Load(d, p.tau_last + i));
        const std::uint32_t sure = bits_of(d, certain) & left;
        found(g, sure << lane);
        for (left &= ~sure; left != 0; left &= left - 1) {
          const std::uint32_t ray = lane + static_cast<std::uint32_t>(std::countr_zero(left));
          TauInterval tau;
          if (job.referee(g * kGroupSize + ray).is_hit(candidate, tau)) found(g, 1U << ray);
        }
      }
    }
  };
  const std::uint32_t backward = p.extent[std::countr_zero(p.together)].backward;
  const PlanePlaces planes(backward);
  walk_packet<false>(job, planes, [&](const PacketLeaf& at) {
    visit_groups(job, at, planes, backward, scratch, group_visit);
  });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
