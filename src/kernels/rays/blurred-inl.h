// SPDX-License-Identifier: Apache-2.0
//
// Trees of trees: the traversal of the top one, whose leaves hold others, and the queries of
// single-inl.h for rays that were brought to the spaces of those.
#if defined(PIERCE_KERNELS_BLURRED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_BLURRED_INL_H_
#undef PIERCE_KERNELS_BLURRED_INL_H_
#else
#define PIERCE_KERNELS_BLURRED_INL_H_
#endif

#include "kernels/rays/interleaved-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

inline Candidate closest_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                                 Resolver& resolver, TauInterval& tau, KernelCounts* counts) {
  FirstHit first;
  first.tau_max = ray.tau_max;
  if (tree.root != bvh::kNoChild) search(tree, ray, tree.root, skip, {resolver, 0}, first, counts);
  tau = first.tau;
  return first.triangle;
}

inline bool any_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                        Resolver& resolver, KernelCounts* counts) {
  return any_below(tree, ray, tree.root, skip, {resolver, 0}, counts);
}

inline void all_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                        CandidateSink& sink, KernelCounts* counts) {
  traverse(tree, ray, tree.root, skip, counts, RaySink{sink},
           [&](const Candidate& candidate, bool certain) {
             sink.add(candidate, certain);
             return false;
           });
}

// Where nodes lie, and what is behind the numbers of leaves.
struct VisitedAddresses {
  NodeAddresses nodes;
  const LeafVisitor& visitor;

  HWY_INLINE void prefetch(std::uint32_t ref) const {
    if (!bvh::is_leaf(ref)) return nodes.prefetch(ref);
    const std::byte* const at = visitor.first + bvh::leaf_offset(ref) * visitor.stride;
    for (std::size_t line = 0; line < 3; ++line) hwy::Prefetch(at + 64 * line);
  }
};

template <bool kCounting>
HWY_INLINE void visit_leaves(const bvh::Tree& tree, const FilterRay& ray, LeafVisitor& visitor,
                             KernelCounts* counts) {
  float tau_max = ray.tau_max;
  OrderedStack stack({ray.tau_min, tree.root});
  traverse_ordered<kCounting>(
      tree, VisitedAddresses{NodeAddresses(tree), visitor}, ray.tau_min, tau_max, box_ray(ray),
      stack, counts, [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
        const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree, ref);
        for (std::uint32_t i = 0; i < bvh::leaf_count(ref); ++i) {
          tau_max = std::min(tau_max, visitor.visit(numbers[i]));
        }
        return false;
      });
}

inline void visit_leaves(const bvh::Tree& tree, const FilterRay& ray, LeafVisitor& visitor,
                         KernelCounts* counts) {
  if (tree.root == bvh::kNoChild) return;
  if (counts == nullptr) {
    visit_leaves<false>(tree, ray, visitor, counts);
  } else {
    visit_leaves<true>(tree, ray, visitor, counts);
  }
}

inline std::uint32_t next_leaf(const bvh::Tree& tree, const FilterRay& ray, float tau_max,
                               LeafStack& stack, KernelCounts* counts) {
  const NodeAddresses addresses(tree);
  const BoxRay box = box_ray(ray);
  StackEntry* top = stack.entries + stack.size;
  std::uint32_t found = bvh::kNoChild;
  while (found == bvh::kNoChild && top != stack.entries) {
    const StackEntry next = *--top;
    if (next.tau > tau_max) continue;
    if (bvh::is_leaf(next.ref)) {
      found = next.ref;
      break;
    }
    if (counts != nullptr) ++counts->nodes;
    const bvh::Node& node = tree.nodes[next.ref];
    alignas(32) float entry[bvh::kWidth];
    const std::uint32_t bits = entered_children(node, box, ray.tau_min, tau_max, entry);
    if (bits != 0) top = push_ordered(node, bits, entry, addresses, top);
  }
  stack.size = static_cast<std::uint32_t>(top - stack.entries);
  return found;
}

template <bool kAny, class Done>
HWY_INLINE void traverse_blurred(const bvh::Tree& tree, const BlurredBlock& block,
                                 Resolver& resolver, KernelCounts* counts, const Done& done) {
  if (tree.root == bvh::kNoChild) {
    for (std::uint32_t i = 0; i < block.count; ++i) done(block.numbers[i], FirstHit{});
    return;
  }
  InterleavedRays<BlurredRay> rays;
  rays.rays = block.rays;
  rays.skips = block.skips;
  rays.resolver = &resolver;
  rays.count = block.count;
  std::copy_n(block.numbers, block.count, rays.numbers);
  traverse_interleaved<kAny>(tree, rays, counts, done);
}

inline void closest_blurred_block(const bvh::Tree& tree, const BlurredBlock& block,
                                  Resolver& resolver, Candidate* out, TauInterval* taus,
                                  KernelCounts* counts) {
  traverse_blurred<false>(tree, block, resolver, counts,
                          [&](std::uint32_t ray, const FirstHit& first) {
                            out[ray] = first.triangle;
                            taus[ray] = first.tau;
                          });
}

inline void any_blurred_block(const bvh::Tree& tree, const BlurredBlock& block, Resolver& resolver,
                              std::uint8_t* out, KernelCounts* counts) {
  traverse_blurred<true>(tree, block, resolver, counts,
                         [&](std::uint32_t ray, const FirstHit& first) {
                           out[ray] = first.triangle.primitive != kNone ? 1 : 0;
                         });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
