// SPDX-License-Identifier: Apache-2.0
//
// One ray at a time against eight boxes, or eight triangles, at a time: the traversals.
#if defined(PIERCE_KERNELS_SINGLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_SINGLE_INL_H_
#undef PIERCE_KERNELS_SINGLE_INL_H_
#else
#define PIERCE_KERNELS_SINGLE_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "bvh/node.h"
#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "kernels/rays/box-inl.h"
#include "kernels/rays/leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Axes along which the ray may not move: where its direction is 0 in float, a bit each.
template <class AnyRay>
HWY_INLINE std::uint32_t zero_axes(const AnyRay& ray) {
  const hn::CappedTag<float, 4> d4;
  std::uint32_t zero = 0;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d4))
    zero |= bits_of(d4, hn::Eq(hn::Load(d4, ray.direction + i), hn::Zero(d4))) << i;
  return zero & 7;
}

// Which children a ray leaves out that its boxes do not: those across axes along which it does not
// move.
struct LeavesOutNone {
  static constexpr bool kStill = false;
  HWY_INLINE std::uint32_t operator()(const bvh::Node&, std::uint32_t children) const {
    return children;
  }
};
struct LeavesOutAcross {
  static constexpr bool kStill = true;
  std::uint32_t still;
  HWY_INLINE std::uint32_t operator()(const bvh::Node& node, std::uint32_t children) const {
    return children & ~bvh::children_across(node, still);
  }
};

using StackEntry = LeafStack::Entry;
inline constexpr int kStackSize = LeafStack::kSize;

// Where nodes and leaves lie in memory, by whether a reference is to a leaf.
struct NodeAddresses {
  const std::byte* base[2];

  explicit NodeAddresses(const bvh::Tree& tree)
      : base{reinterpret_cast<const std::byte*>(tree.nodes.data()), tree.leaves.data()} {}

  // Prefetches all cache lines of a node (4) or a leaf (up to 6; the last two of a node are its
  // first again). Branch-free, since which of the two comes is unpredictable; the address is
  // computed as an integer because that of kNoChild, prefetched too, points nowhere.
  HWY_INLINE void prefetch(std::uint32_t ref) const {
    static_assert(sizeof(bvh::Node) == 256 && bvh::kLeafUnit == 32);
    static_assert(4 * (10 * bvh::kWidth + bvh::kLeafHead) + 32 <= 6 * 64);
    const std::uint32_t leaf = ref >> 31;
    const std::uint64_t index = ref & (0x7fffffffU >> (3 * leaf));
    const auto* at = reinterpret_cast<const std::byte*>(
        reinterpret_cast<std::uintptr_t>(base[leaf]) + (index << (8 - 3 * leaf)));
    hwy::Prefetch(at);
    hwy::Prefetch(at + 64);
    hwy::Prefetch(at + 128);
    hwy::Prefetch(at + 192);
    hwy::Prefetch(at + 256 * leaf);
    hwy::Prefetch(at + 320 * leaf);
  }
};

// Puts three or more entered children on the stack, the nearest on top: each goes as deep as
// there are farther ones, so that no branch depends on the order.
template <class Addresses>
HWY_INLINE StackEntry* push_ordered(const bvh::Node& node, std::uint32_t bits,
                                    const float* HWY_RESTRICT entry, const Addresses& addresses,
                                    StackEntry* top) {
  const D d;
  const hn::RebindToSigned<D> di;
  using VI = hn::Vec<decltype(di)>;
  // As integers, floats that are not negative keep their order (and others have one); the number
  // of the lane instead of the last three bits makes all of them different.
  alignas(32) std::int32_t keys[bvh::kWidth];
  VI key[kParts];
  for (int part = 0; part < kParts; ++part) {
    const VI near = hn::BitCast(di, hn::Load(d, entry + part * kLanes));
    key[part] = hn::Or(hn::AndNot(hn::Set(di, 7), near), hn::Iota(di, part * kLanes));
    hn::Store(key[part], di, keys + part * kLanes);
  }
  for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
    const auto child = static_cast<std::uint32_t>(std::countr_zero(rest));
    const VI own = hn::Set(di, keys[child]);
    std::uint32_t farther = 0;
    for (int part = 0; part < kParts; ++part) {
      farther |= bits_of(di, hn::Gt(key[part], own)) << (part * kLanes);
    }
    const std::uint32_t ref = node.child[child];
    top[std::popcount(farther & bits)] = {entry[child], ref};
    addresses.prefetch(ref);
  }
  return top + std::popcount(bits);
}

// What is still to be traversed, the next on top.
template <class Entry>
struct Stack {
  Entry entries[kStackSize];
  Entry* top = entries;

  HWY_INLINE explicit Stack(Entry start) { *top++ = start; }
};
using OrderedStack = Stack<StackEntry>;
using AnyStack = Stack<std::uint32_t>;

// Traverses the leaves that the ray may enter below what is on the stack, the nearest first.
// `visit(leaf's ref)` may make `tau_max` less: nothing beyond it matters any more. It returns true
// to stop: that leaf is returned then, else kNoChild.
template <bool kCounting, class Addresses, class Box, class Visit, class LeavesOut = LeavesOutNone>
HWY_INLINE std::uint32_t traverse_ordered(const bvh::Tree& tree, const Addresses& addresses,
                                          float tau_min, const float& tau_max, const Box& box,
                                          OrderedStack& stack, KernelCounts* counts,
                                          const Visit& visit, const LeavesOut& entered = {}) {
  StackEntry* top = stack.top - 1;
  std::uint32_t ref = top->ref;
  for (;;) {
    while (!bvh::is_leaf(ref)) {
      if constexpr (kCounting) ++counts->nodes;
      const bvh::Node& node = tree.nodes[ref];
      alignas(32) float entry[bvh::kWidth];
      std::uint32_t bits = entered(node, entered_children(node, box, tau_min, tau_max, entry));
      if (bits == 0) {
        ref = bvh::kNoChild;
        break;
      }
      const auto child = static_cast<std::uint32_t>(std::countr_zero(bits));
      ref = node.child[child];
      bits &= bits - 1;
      if (bits == 0) continue;
      const auto second = static_cast<std::uint32_t>(std::countr_zero(bits));
      if ((bits & (bits - 1)) == 0) {
        // Two: continue with the nearer, push the farther.
        const bool swapped = entry[second] < entry[child];
        const std::uint32_t other = node.child[second];
        addresses.prefetch(ref);
        addresses.prefetch(other);
        *top++ = {swapped ? entry[child] : entry[second], swapped ? ref : other};
        ref = swapped ? other : ref;
        continue;
      }
      top = push_ordered(node, bits | (1U << child), entry, addresses, top);
      ref = (--top)->ref;
    }
    if (ref != bvh::kNoChild && visit(ref)) {
      stack.top = top;
      return ref;
    }
    do {
      if (top == stack.entries) return bvh::kNoChild;
      --top;
    } while (top->tau > tau_max);
    ref = top->ref;
  }
}

// Looks for the first hit of one ray below what is on the stack.
template <bool kCounting, class AnyRay, class Box, class LeavesOut = LeavesOutNone>
HWY_INLINE void search(const bvh::Tree& tree, const AnyRay& ray, const Box& box,
                       OrderedStack& stack, std::uint32_t skip, const RayResolver& resolver,
                       FirstHit& first, KernelCounts* counts, const LeavesOut& entered = {}) {
  bvh::LeafScratch scratch;
  traverse_ordered<kCounting>(
      tree, NodeAddresses(tree), ray.tau_min, first.tau_max, box, stack, counts,
      [&](std::uint32_t leaf_ref) HWY_ATTR __attribute__((always_inline)) {
        if constexpr (kCounting) ++counts->leaves;
        const Leaf leaf(tree, leaf_ref, scratch);
        LeafAnswer answer = cull_leaf<true>(leaf, ray, first.tau_max, skip);
        if constexpr (kCounting) counts->candidates += count_of(answer.open);
        offer_all(leaf, answer, ray, resolver, first);
        return false;
      },
      entered);
}

// Traverses all leaves that the ray may enter below what is on the stack, in no order, until
// `visit(leaf's ref)` returns true: that leaf is returned then, else kNoChild.
template <bool kCounting, class Box, class Visit, class LeavesOut = LeavesOutNone>
HWY_INLINE std::uint32_t traverse_leaves(const bvh::Tree& tree, float tau_min, float tau_max,
                                         const Box& box, AnyStack& stack, KernelCounts* counts,
                                         const Visit& visit, const LeavesOut& entered = {}) {
  const NodeAddresses addresses(tree);
  std::uint32_t* top = stack.top;
  while (top != stack.entries) {
    const std::uint32_t ref = *--top;
    if (bvh::is_leaf(ref)) {
      if (!visit(ref)) continue;
      stack.top = top;
      return ref;
    }
    if constexpr (kCounting) ++counts->nodes;
    const bvh::Node& node = tree.nodes[ref];
    alignas(32) float entry[bvh::kWidth];
    std::uint32_t bits = entered(node, entered_children(node, box, tau_min, tau_max, entry));
    for (; bits != 0; bits &= bits - 1) {
      *top = node.child[std::countr_zero(bits)];
      addresses.prefetch(*top++);
    }
  }
  return bvh::kNoChild;
}

// The open triangles of all these leaves, until `visit(candidate, certain)` returns true; whether
// it did.
template <bool kCounting, class AnyRay, class Box, class AskedOf, class Visit,
          class LeavesOut = LeavesOutNone>
HWY_INLINE bool traverse(const bvh::Tree& tree, const AnyRay& ray, const Box& box, AnyStack& stack,
                         std::uint32_t skip, KernelCounts* counts, const AskedOf& asked_of,
                         const Visit& visit, const LeavesOut& entered = {}) {
  bvh::LeafScratch scratch;
  const auto in_leaf = [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
    if constexpr (kCounting) ++counts->leaves;
    const Leaf leaf(tree, ref, scratch);
    LeafAnswer answer = cull_leaf<true>(leaf, ray, ray.tau_max, skip);
    return visit_open<true>(leaf, ray, ray.tau_max, answer, asked_of,
                            [&](const Candidate& candidate, bool certain, std::uint32_t) HWY_ATTR {
                              if constexpr (kCounting) ++counts->candidates;
                              return visit(candidate, certain);
                            });
  };
  return traverse_leaves<kCounting>(tree, ray.tau_min, ray.tau_max, box, stack, counts, in_leaf,
                                    entered) != bvh::kNoChild;
}

template <class AnyRay, class AskedOf, class Visit>
HWY_INLINE bool traverse(const bvh::Tree& tree, const AnyRay& ray, std::uint32_t start,
                         std::uint32_t skip, KernelCounts* counts, const AskedOf& asked_of,
                         const Visit& visit) {
  if (start == bvh::kNoChild) return false;
  AnyStack stack(start);
  if (counts != nullptr)
    return traverse<true>(tree, ray, box_ray(ray), stack, skip, counts, asked_of, visit);
  return with_box_ray(ray, [&](const auto& box) HWY_ATTR {
    return traverse<false>(tree, ray, box, stack, skip, counts, asked_of, visit);
  });
}

template <class AnyRay>
HWY_INLINE void search(const bvh::Tree& tree, const AnyRay& ray, std::uint32_t ref,
                       std::uint32_t skip, const RayResolver& resolver, FirstHit& first,
                       KernelCounts* counts) {
  OrderedStack stack({ray.tau_min, ref});
  if (counts != nullptr) {
    search<true>(tree, ray, box_ray(ray), stack, skip, resolver, first, counts);
    return;
  }
  with_box_ray(ray, [&](const auto& box) HWY_ATTR {
    search<false>(tree, ray, box, stack, skip, resolver, first, counts);
  });
}

// Whether any triangle below `start` is hit.
template <class AnyRay>
inline bool any_below(const bvh::Tree& tree, const AnyRay& ray, std::uint32_t start,
                      std::uint32_t skip, const RayResolver& resolver, KernelCounts* counts) {
  return traverse(tree, ray, start, skip, counts, resolver,
                  [&](const Candidate& candidate, bool certain) {
                    TauInterval tau;
                    return resolver.takes(ray, candidate, certain, tau);
                  });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
