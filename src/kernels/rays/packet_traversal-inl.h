// SPDX-License-Identifier: Apache-2.0
//
// The traversal of a packet: which leaves its groups enter, and with which of their rays.
#if defined(PIERCE_KERNELS_PACKET_TRAVERSAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PACKET_TRAVERSAL_INL_H_
#undef PIERCE_KERNELS_PACKET_TRAVERSAL_INL_H_
#else
#define PIERCE_KERNELS_PACKET_TRAVERSAL_INL_H_
#endif

#include "kernels/rays/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// From so many triangles on it is worth a look which of its rays a group takes into a leaf.
inline constexpr int kManyTriangles = 2;

// After so many nodes and leaves a packet counts as diverged: from then on its rays are tested
// against a box one by one before it is entered, and where few are left each continues alone.
inline constexpr std::uint32_t kCoherentSteps = 64;
inline constexpr int kFewRays = 4;

// A ray that continues alone counts as so many steps of its packet.
inline constexpr std::uint32_t kStepsAlone = 4;

// A packet in flight: the index in the block of its first ray, and whom to ask.
struct PacketJob {
  const bvh::Tree* tree;
  const RayBlock* block;
  std::uint32_t base;
  Packet* packet;
  Resolver* resolver;
  KernelCounts* counts;
  bool loose = false;  // rays that need not be coherent, and a tree of few triangles

  [[nodiscard]] HWY_INLINE std::uint32_t skip(std::uint32_t i) const {
    return block->skips[base + i];
  }
  [[nodiscard]] HWY_INLINE RayResolver resolver_of(std::uint32_t i) const {
    return {*resolver, base + i};
  }
  // Bit k: ray i + k does not skip this triangle, and its mask does not hide it.
  [[nodiscard]] HWY_INLINE std::uint32_t seeing(std::uint32_t primitive, std::uint32_t i) const {
    const hn::CappedTag<std::uint32_t, kGroupSize> d;
    const auto skips = hn::LoadU(d, block->skips + base + i);
    auto sees = hn::Ne(skips, hn::Set(d, primitive));
    if (block->masks != nullptr) {
      const auto masks = hn::LoadU(d, block->masks + base + i);
      const auto common = hn::And(masks, hn::Set(d, resolver->mask_of(primitive)));
      sees = hn::And(sees, hn::Ne(common, hn::Zero(d)));
    }
    return bits_of(d, sees);
  }
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

// The stack: children of nodes (number of the node times eight, and of the child), none of which
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

// Of a leaf and a group: whether its rays should go one by one, and which may enter at all.
struct GroupVisit {
  std::uint32_t rays;
  bool singly;
};

HWY_INLINE GroupVisit plan_visit(const PacketLeaf& at, const PlaneOffsets& planes,
                                 std::uint32_t triangles, std::uint32_t g, Packet& p) {
  std::uint32_t rays = p.rays[g];
  const int count = std::popcount(triangles);
  if (count < kManyTriangles || at.box == nullptr) return {rays, false};
  rays &= rays_entering(at.box, planes, g, p);
  return {rays, count > std::popcount(rays)};
}

// Where the groups end, with that of group g as it now is.
HWY_INLINE V4 with_end_of(std::uint32_t g, const Packet& p, V4 ends) {
  const D4 d;
  const V4 end = hn::Set(d, interval_of(p.tau_max + g * kGroupSize).high);
  return hn::IfThenElse(mask_of(d, 1U << g), end, ends);
}

// One leaf of traverse_packet.
template <class GroupVisitor>
HWY_INLINE void visit_groups(const PacketJob& job, const PacketLeaf& at, const PlaneOffsets& planes,
                             bvh::LeafScratch& scratch, const GroupVisitor& visit) {
  Packet& p = *job.packet;
  if (job.counts != nullptr) ++job.counts->leaves;
  const Leaf leaf(*job.tree, at.ref, scratch);
  const LeafBounds bounds = leaf_bounds(leaf.edge, std::max(leaf.reach, p.reach), p.exact, p.sides);
  const TriangleBoxes boxes(leaf, planes.backward);
  V4 ends = hn::LoadU(D4(), p.groups.greatest_tau_max);
  for (std::uint32_t rest = at.groups; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    const std::uint32_t triangles = boxes.in_reach_of(p.groups, g);
    if (triangles == 0) continue;
    const GroupVisit plan = plan_visit(at, planes, triangles, g, p);
    if (plan.rays == 0) continue;
    visit(leaf, bounds, g, triangles, plan);
    ends = with_end_of(g, p, ends);
  }
  shorten(ends, p);
}

// The groups of which some ray enters the box; if these are few rays, `single(ref, ray)` takes each
// on from there, and no group is left.
template <class SingleVisitor>
HWY_NOINLINE std::uint32_t diverge(const PacketJob& job, const PlaneOffsets& planes,
                                   const float* box, std::uint32_t ref, std::uint32_t groups,
                                   const SingleVisitor& single) {
  Packet& p = *job.packet;
  std::uint32_t rays[kGroups];
  std::uint32_t entering = 0;
  int count = 0;
  for (std::uint32_t rest = groups; rest != 0; rest &= rest - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
    rays[g] = rays_entering(box, planes, g, p) & p.rays[g];
    count += std::popcount(rays[g]);
    entering |= (rays[g] != 0 ? 1U : 0U) << g;
  }
  if (count > kFewRays) return entering;
  V4 ends = hn::LoadU(D4(), p.groups.greatest_tau_max);
  for (; entering != 0; entering &= entering - 1) {
    const auto g = static_cast<std::uint32_t>(std::countr_zero(entering));
    for (std::uint32_t rest = rays[g]; rest != 0; rest &= rest - 1) {
      single(ref, g * kGroupSize + static_cast<std::uint32_t>(std::countr_zero(rest)));
      p.steps += kStepsAlone;
    }
    ends = with_end_of(g, p, ends);
  }
  shorten(ends, p);
  return 0;
}

// A tree of no more triangles than this is not worth a traversal, nor are its rays worth sorting:
// all of them are held against all triangles, as many at a time as there are lanes.
inline constexpr std::uint32_t kFewTriangles = kGroupLanes;

inline bool has_few_triangles(const bvh::Tree& tree) {
  if (tree.root == bvh::kNoChild) return false;
  if (bvh::is_leaf(tree.root)) return bvh::leaf_count(tree.root) <= kFewTriangles;
  std::uint32_t count = 0;
  for (const std::uint32_t ref : tree.nodes[tree.root].child) {
    if (ref == bvh::kNoChild) break;
    if (!bvh::is_leaf(ref)) return false;
    count += bvh::leaf_count(ref);
  }
  return count <= kFewTriangles;
}

// Calls `visit` as traverse_packet does, for each leaf of a tree that has_few_triangles.
template <class GroupVisitor>
HWY_INLINE void visit_all_leaves(const PacketJob& job, const GroupVisitor& visit) {
  const Packet& p = *job.packet;
  const bvh::Tree& tree = *job.tree;
  bvh::LeafScratch scratch;
  const auto visit_leaf = [&](std::uint32_t ref) {
    if (job.counts != nullptr) ++job.counts->leaves;
    const Leaf leaf(tree, ref, scratch);
    const LeafBounds bounds =
        leaf_bounds(leaf.edge, std::max(leaf.reach, p.reach), p.exact, p.sides);
    for (std::uint32_t rest = p.together; rest != 0; rest &= rest - 1) {
      const auto g = static_cast<std::uint32_t>(std::countr_zero(rest));
      if (p.rays[g] == 0) continue;
      visit(leaf, bounds, g, (1U << leaf.count) - 1, GroupVisit{p.rays[g], false});
    }
  };
  if (bvh::is_leaf(tree.root)) return visit_leaf(tree.root);
  if (job.counts != nullptr) ++job.counts->nodes;
  for (const std::uint32_t ref : tree.nodes[tree.root].child) {
    if (ref == bvh::kNoChild) break;
    visit_leaf(ref);
  }
}

// Which of a node's children stand across axes along which no ray of the packet moves.
class LeftOutOfPacket {
 public:
  HWY_INLINE explicit LeftOutOfPacket(const PacketJob& job) : job_(job) {
    const D4 d;
    axes_ = 7;
    for (std::uint32_t rest = job.packet->together; rest != 0; rest &= rest - 1) {
      const Extent& extent = job.packet->extent[std::countr_zero(rest)];
      axes_ &= bits_of(d, hn::And(hn::Eq(extent.direction_low, hn::Zero(d)),
                                  hn::Eq(extent.direction_high, hn::Zero(d))));
    }
  }
  HWY_INLINE std::uint32_t operator()(const bvh::Node& node) {
    return axes_ == 0 ? 0 : among(node);
  }

 private:
  HWY_NOINLINE std::uint32_t among(const bvh::Node& node) {
    std::uint32_t children = bvh::children_across(node, axes_);
    if (children == 0 || sure_) return children;
    const Packet& p = *job_.packet;
    for (std::uint32_t g = 0; g < kGroups; ++g) {
      if (((p.together >> g) & 1U) == 0) continue;
      for (std::uint32_t rays = p.rays[g]; rays != 0; rays &= rays - 1) {
        axes_ &= job_.resolver->still_axes(job_.base + g * kGroupSize +
                                           static_cast<std::uint32_t>(std::countr_zero(rays)));
      }
    }
    sure_ = true;
    children = bvh::children_across(node, axes_);
    return children;
  }

  const PacketJob& job_;
  std::uint32_t axes_;  // where all directions are 0 in float, until ...
  bool sure_ = false;   // ... somebody was asked what they are
};

// Calls `visit(leaf, bounds, group, triangles, plan)` for each leaf and group that may meet
// triangles of it, the nearest leaf first if kOrdered; or `single(ref, ray)` for one ray and all
// that is below. They may lower the tau_max of the rays.
template <bool kOrdered, class GroupVisitor, class SingleVisitor>
HWY_INLINE void traverse_packet(const PacketJob& job, const GroupVisitor& visit,
                                const SingleVisitor& single) {
  if (job.loose) return visit_all_leaves(job, visit);
  Packet& p = *job.packet;
  const bvh::Tree& tree = *job.tree;
  const NodeAddresses addresses(tree);
  const PlaneOffsets planes(p.extent[std::countr_zero(p.together)].backward);
  bvh::LeafScratch scratch;
  p.steps = p.asked = 0;
  shorten(hn::LoadU(D4(), p.groups.greatest_tau_max), p);
  if (bvh::is_leaf(tree.root)) {
    visit_groups(job, {tree.root, p.together, nullptr}, planes, scratch, visit);
    return;
  }
  LeftOutOfPacket left_out(job);
  PacketStack stack;
  std::uint32_t top = 0, steps = 0;
  for (std::uint32_t ref = tree.root;;) {
    if (job.counts != nullptr) ++job.counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    alignas(32) float entry[bvh::kWidth];
    std::uint32_t children = children_in_reach(node, planes, p.all, entry) & ~left_out(node);
    [[maybe_unused]] const std::uint32_t first = top;
    for (; children != 0; children &= children - 1) {
      const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
      addresses.prefetch(node.child[child]);
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
      if (top == 0) {
        p.steps += steps;
        return;
      }
      --top;
      if (stack.near[top] > p.all.greatest_tau_max[0]) continue;
      const bvh::Node& parent = tree.nodes[stack.child[top] / bvh::kWidth];
      const std::uint32_t child = stack.child[top] % bvh::kWidth;
      const float* const box = &parent.lower[0][child];
      std::uint32_t groups = bundles_entering(box, planes, p.groups) & p.together;
      if (groups == 0) continue;
      ref = parent.child[child];
      if (++steps > kCoherentSteps) groups = diverge(job, planes, box, ref, groups, single);
      if (groups == 0) continue;
      if (!bvh::is_leaf(ref)) break;
      visit_groups(job, {ref, groups, box}, planes, scratch, visit);
    }
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
