// SPDX-License-Identifier: Apache-2.0
//
// Interleaved traversal of incoherent rays, one node or leaf a step, to hide latency: while one ray
// waits for memory or for the end of its chain of operations, the others go on. (Not what Embree
// calls a ray rays.) A step has no branch that depends on the ray, save when something is found.
#if defined(PIERCE_KERNELS_INTERLEAVED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_INTERLEAVED_INL_H_
#undef PIERCE_KERNELS_INTERLEAVED_INL_H_
#else
#define PIERCE_KERNELS_INTERLEAVED_INL_H_
#endif

#include <array>
#include <limits>
#include <memory>

#include "kernels/rays/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// How many rays are in flight at a time.
inline constexpr std::uint32_t kInFlight = 24;
// So many leaves a ray are many.
inline constexpr std::uint32_t kManyLeaves = 10;
// From so many on rays go one by one: they no longer wait for memory, but for what they compute.
inline constexpr std::uint32_t kTooManyLeaves = 96;

// A ray in flight: what the box test needs of it, where it stands, and its stack.
struct alignas(64) RaySlot {
  float inverse[3], entry[3], exit[3];  // as in BoxRay
  float tau_min, tau_max;               // nothing beyond tau_max matters any more
  std::uint32_t near[3], far[3];        // as EntryPlanes, in floats
  std::uint32_t octant;                 // of its direction
  std::uint32_t ref;                    // where it goes next
  std::uint32_t top;                    // of the stack
  std::uint32_t still;                  // axes along which it does not move
  std::uint32_t ray;
  FirstHit first;
  // The traversal stack, the nearest of each node last; kNoChild is the sentinel at the bottom.
  alignas(64) float stack_tau[kStackSize + 2 * bvh::kWidth];
  std::uint32_t stack_ref[kStackSize + 2 * bvh::kWidth];
};

template <class AnyRay>
HWY_INLINE void start(const AnyRay& ray, std::uint32_t number, std::uint32_t root, RaySlot& slot) {
  const hn::CappedTag<float, 4> d4;
  const auto terms =
      box_terms(d4, hn::Load(d4, ray.origin), hn::Load(d4, ray.direction), box_floor(ray));
  hn::StoreU(terms.inverse, d4,
             slot.inverse);  // each spills a lane into the next, which comes after
  hn::StoreU(terms.entry, d4, slot.entry);
  hn::StoreU(terms.exit, d4, slot.exit);
  slot.tau_min = ray.tau_min;
  slot.tau_max = ray.tau_max;
  slot.octant = 0;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t lower = axis * bvh::kWidth;
    const auto upper = static_cast<std::uint32_t>(kUpperPlanes);
    const std::uint32_t backward = std::bit_cast<std::uint32_t>(ray.direction[axis]) >> 31;
    slot.near[axis] = lower + backward * upper;
    slot.far[axis] = lower + (1 - backward) * upper;
    slot.octant |= backward << axis;
  }
  slot.ref = root;
  slot.top = 1;
  slot.stack_tau[0] = -std::numeric_limits<float>::infinity();
  slot.stack_ref[0] = bvh::kNoChild;
  slot.ray = number;
  slot.first = FirstHit{};
  slot.first.tau_max = ray.tau_max;
}

// Pops the nearest, and prefetches it.
HWY_INLINE void pop_next(const NodeAddresses& addresses, RaySlot& slot) {
  const std::uint32_t ref = slot.stack_ref[--slot.top];
  slot.ref = ref;
  addresses.prefetch(ref);
}

// Shortens the ray, and removes what lies beyond its new end from the stack.
HWY_INLINE void shorten(float tau_max, RaySlot& slot) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const V limit = hn::Set(d, tau_max);
  slot.tau_max = tau_max;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < slot.top; i += kLanes) {
    const V tau = hn::LoadU(d, slot.stack_tau + i);
    const auto refs = hn::LoadU(du, slot.stack_ref + i);
    const auto keep = hn::And(hn::Le(tau, limit), hn::FirstN(d, slot.top - i));
    const Compressor compress(d, keep);
    hn::StoreU(compress(tau), d, slot.stack_tau + kept);
    hn::StoreU(compress(refs), du, slot.stack_ref + kept);
    kept += compress.count(d);
  }
  slot.top = kept;
}

// Tests the children of a node; pushes those entered: in the order of their lanes or, if kOrdered,
// with the nearest of them last. If kStill, leaves out those across axes along which it does not
// move.
template <bool kOrdered, bool kStill>
HWY_INLINE void step_node(const bvh::Node& node, RaySlot& slot) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const float* planes = &node.lower[0][0];
  V near[kParts], far[kParts];
  for (int part = 0; part < kParts; ++part) {
    const auto meet = [&](const std::uint32_t* plane, const float* middle, std::size_t axis) {
      return hn::MulAdd(hn::Load(d, planes + plane[axis] + part * kLanes),
                        hn::Set(d, slot.inverse[axis]), hn::Set(d, middle[axis]));
    };
    near[part] = hn::Max(hn::Max(meet(slot.near, slot.entry, 0), meet(slot.near, slot.entry, 1)),
                         hn::Max(meet(slot.near, slot.entry, 2), hn::Set(d, slot.tau_min)));
    far[part] = hn::Min(hn::Min(meet(slot.far, slot.exit, 0), meet(slot.far, slot.exit, 1)),
                        hn::Min(meet(slot.far, slot.exit, 2), hn::Set(d, slot.tau_max)));
    if constexpr (kStill) {
      const auto across = mask_of(d, bvh::children_across(node, slot.still) >> (part * kLanes));
      near[part] = hn::IfThenElse(across, hn::Set(d, bvh::kEmptyPlane), near[part]);
    }
  }
  std::uint32_t top = slot.top;
  const auto push = [&](V tau, hn::Vec<decltype(du)> refs, hn::Mask<D> mask) {
    const Compressor compress(d, mask);
    hn::StoreU(compress(tau), d, slot.stack_tau + top);
    hn::StoreU(compress(refs), du, slot.stack_ref + top);
    top += compress.count(d);
  };
  const auto refs_of = [&](int part) { return hn::Load(du, node.child + part * kLanes); };
  if constexpr (kOrdered && kParts == 1) {
    // All lanes change places, to lie in the order of the ray's octant.
    const auto shifts = hn::Mul(hn::Iota(du, 0), hn::Set(du, bvh::kOrderBits));
    const auto lanes = hn::And(hn::Shr(hn::Set(du, node.order[slot.octant]), shifts),
                               hn::Set(du, std::uint32_t{bvh::kWidth - 1}));
    const auto order = hn::IndicesFromVec(d, lanes);
    const V tau = hn::TableLookupLanes(near[0], order);
    push(tau, hn::TableLookupLanes(refs_of(0), hn::IndicesFromVec(du, lanes)),
         hn::Le(tau, hn::TableLookupLanes(far[0], order)));
  } else if constexpr (kOrdered) {
    // In the order of their lanes, the nearest after the others. (If there is none, what is written
    // is beyond the top, or what was there.)
    const V none = hn::Set(d, bvh::kEmptyPlane);
    hn::Mask<D> entered[kParts];
    V least = none;
    for (int part = 0; part < kParts; ++part) {
      entered[part] = hn::Le(near[part], far[part]);
      least = hn::Min(least, hn::IfThenElse(entered[part], near[part], none));
    }
    least = hn::MinOfLanes(d, least);
    for (int part = 0; part < kParts; ++part)
      push(near[part], refs_of(part), hn::And(entered[part], hn::Gt(near[part], least)));
    for (int part = 0; part < kParts; ++part)
      push(near[part], refs_of(part), hn::And(entered[part], hn::Eq(near[part], least)));
  } else {
    for (int part = 0; part < kParts; ++part)
      push(near[part], refs_of(part), hn::Le(near[part], far[part]));
  }
  slot.top = top;
}

// Rays that are interleaved, some of a block. Those that do not move along an axis come last, for
// from the first of them on a node costs more.
template <class AnyRay>
struct InterleavedRays {
  const AnyRay* rays = nullptr;
  const std::uint32_t* skips = nullptr;
  Resolver* resolver = nullptr;
  std::uint32_t count = 0;
  std::uint32_t numbers[kBlockSize];
};

// One of them by itself.
template <bool kAny, class AnyRay>
HWY_NOINLINE FirstHit alone(const bvh::Tree& tree, const AnyRay& ray, std::uint32_t skip,
                            const RayResolver& resolver, KernelCounts* counts) {
  FirstHit first;
  if constexpr (kAny) {
    if (any_below(tree, ray, tree.root, skip, resolver, counts)) first.triangle.primitive = 0;
  } else {
    first.tau_max = ray.tau_max;
    search(tree, ray, tree.root, skip, resolver, first, counts);
  }
  return first;
}

// Takes each of the rays to its first hit (or, if kAny, to some hit); `done(ray, first)`.
template <bool kAny, class AnyRay, class Done>
HWY_INLINE void traverse_interleaved(const bvh::Tree& tree, const InterleavedRays<AnyRay>& rays,
                                     KernelCounts* counts, const Done& done) {
  // Not on the stack, which it would fill; and one for each thread.
  static thread_local const std::unique_ptr<RaySlot[]> kSlots(new RaySlot[kInFlight]);
  RaySlot* const slots = kSlots.get();
  const NodeAddresses addresses(tree);
  bvh::LeafScratch scratch;
  std::uint8_t at_node[kInFlight], at_leaf[kInFlight];
  std::uint32_t nodes = 0, leaves = 0, leaves_met = 0, next = 0;
  std::uint32_t still = 0;  // axes along which some of the rays do not move

  const auto start_next = [&](RaySlot& slot) {
    const std::uint32_t number = rays.numbers[next++];
    const AnyRay& ray = rays.rays[number];
    start(ray, number, tree.root, slot);
    slot.still = zero_axes(ray);
    if (slot.still != 0) [[unlikely]] {
      slot.still = rays.resolver->still_axes(number);
      still |= slot.still;
    }
  };
  const auto file = [&](std::uint8_t s) {
    RaySlot& slot = slots[s];
    if (slot.ref == bvh::kNoChild) {
      done(slot.ray, slot.first);
      if (next == rays.count || leaves_met > kTooManyLeaves * next) return;
      start_next(slot);
    }
    const std::uint32_t leaf = slot.ref >> 31;  // again without a branch
    at_leaf[leaves] = s;
    at_node[nodes] = s;
    leaves += leaf;
    nodes += 1 - leaf;
  };
  for (std::uint32_t s = 0; s < kInFlight && next < rays.count; ++s) {
    start_next(slots[s]);
    file(static_cast<std::uint8_t>(s));
  }
  std::uint8_t turn[kInFlight];
  while (nodes + leaves != 0) {
    while (nodes > leaves) {
      const std::uint32_t n = nodes;
      std::copy(at_node, at_node + n, turn);
      nodes = 0;
      if (counts != nullptr) counts->nodes += n;
      if (still == 0) [[likely]] {
        for (std::uint32_t i = 0; i < n; ++i) {
          RaySlot& slot = slots[turn[i]];
          step_node<!kAny, false>(tree.nodes[slot.ref], slot);
          pop_next(addresses, slot);
          file(turn[i]);
        }
      } else {
        for (std::uint32_t i = 0; i < n; ++i) {
          RaySlot& slot = slots[turn[i]];
          step_node<!kAny, true>(tree.nodes[slot.ref], slot);
          pop_next(addresses, slot);
          file(turn[i]);
        }
      }
    }
    const std::uint32_t n = leaves;
    std::copy(at_leaf, at_leaf + n, turn);
    leaves = 0;
    leaves_met += n;
    // Where a ray comes to many leaves, in most of them nothing is open, which a branch then knows.
    const bool many_leaves = leaves_met > kManyLeaves * next;
    if (counts != nullptr) counts->leaves += n;
    for (std::uint32_t i = 0; i < n; ++i) {
      RaySlot& slot = slots[turn[i]];
      const AnyRay& ray = rays.rays[slot.ray];
      const Leaf leaf(tree, slot.ref, scratch);
      const std::uint32_t skip = rays.skips[slot.ray];
      const RayResolver resolver{*rays.resolver, slot.ray};
      if constexpr (kAny) {
        const bool found = many_leaves ? meets_any<true>(leaf, ray, skip, resolver, counts)
                                       : meets_any<false>(leaf, ray, skip, resolver, counts);
        slot.first.triangle.primitive = found ? 0 : kNone;
        slot.top = found ? 1 : slot.top;
      } else {
        LeafAnswer answer = many_leaves ? cull_leaf<true>(leaf, ray, slot.tau_max, skip)
                                        : cull_leaf<false>(leaf, ray, slot.tau_max, skip);
        if (counts != nullptr) counts->candidates += count_of(answer.open);
        offer_all(leaf, answer, ray, resolver, slot.first);
        if (slot.first.tau_max < slot.tau_max) shorten(slot.first.tau_max, slot);
      }
      pop_next(addresses, slot);
      file(turn[i]);
    }
  }
  for (; next < rays.count; ++next) {
    const std::uint32_t number = rays.numbers[next];
    done(number, alone<kAny>(tree, rays.rays[number], rays.skips[number], {*rays.resolver, number},
                             counts));
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
