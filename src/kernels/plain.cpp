// SPDX-License-Identifier: Apache-2.0
//
// The plain kernel: no SIMD, no leaf cull, every triangle of every leaf goes to the resolver. The
// yardstick that the wide kernels are held against, and what any machine can run.
#include "kernels/plain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "bvh/leaf_access.h"
#include "kernels/bounds.h"

namespace pierce::kernels {
namespace {

struct BoxRay {
  float inverse[3];
  float origin_in[3];   // origin * inverse + pad: for the entry
  float origin_out[3];  // origin * inverse - pad: for the exit
};

// `blur`: what the ray is blurred by.
BoxRay box_ray(const FilterRay& ray, float blur) {
  BoxRay b;
  for (int axis = 0; axis < 3; ++axis) {
    const float slope = std::fabs(ray.direction[axis]) < kSmallestSlope
                            ? std::copysign(kSmallestSlope, ray.direction[axis])
                            : ray.direction[axis];
    const float inverse = 1 / slope;
    const float floor = kBoxFloor + blur * (1 + 0x1p-20F);
    const float pad = (kBoxOrigin * std::fabs(ray.origin[axis]) + floor) * std::fabs(inverse);
    b.inverse[axis] = inverse;
    b.origin_in[axis] = ray.origin[axis] * inverse + pad;
    b.origin_out[axis] = ray.origin[axis] * inverse - pad;
  }
  return b;
}

// The first tau at which the ray may be in the child's box, or more than `tau_max` if it never is.
float entry_of(const bvh::Node& node, int child, const BoxRay& ray, float tau_min, float tau_max) {
  float entry = tau_min;
  float exit = tau_max;
  for (int axis = 0; axis < 3; ++axis) {
    const float lower = node.lower[axis][child];
    const float upper = node.upper[axis][child];
    const bool forward = ray.inverse[axis] > 0;
    const float near_plane = forward ? lower : upper;
    const float far_plane = forward ? upper : lower;
    entry = std::max(entry, near_plane * ray.inverse[axis] - ray.origin_in[axis]);
    exit = std::min(exit, far_plane * ray.inverse[axis] - ray.origin_out[axis]);
  }
  return entry <= exit ? entry : bvh::kEmptyPlane;
}

// The next leaf that the ray may enter, nearest first; kNoChild if there is none before `tau_max`.
std::uint32_t next_leaf_of(const bvh::Tree& tree, const BoxRay& box, float tau_min, float tau_max,
                           LeafStack& stack, KernelCounts* counts) {
  while (stack.size != 0) {
    const LeafStack::Entry next = stack.entries[--stack.size];
    if (next.tau > tau_max) continue;
    if (bvh::is_leaf(next.ref)) return next.ref;
    if (counts != nullptr) ++counts->nodes;
    const bvh::Node& node = tree.nodes[next.ref];
    const std::uint32_t first = stack.size;
    for (int child = 0; child < bvh::kWidth && node.child[child] != bvh::kNoChild; ++child) {
      const float tau = entry_of(node, child, box, tau_min, tau_max);
      if (tau > tau_max) continue;
      // Nearest on top: insertion into the few that this node has pushed.
      std::uint32_t at = stack.size;
      stack.entries[stack.size++] = {tau, node.child[child]};
      for (; at > first && stack.entries[at - 1].tau < tau; --at)
        std::swap(stack.entries[at - 1], stack.entries[at]);
    }
  }
  return bvh::kNoChild;
}

// Calls `leaf(ref, tau_max)` for each; it returns the new end of the range, a negative infinite one
// to stop.
template <class Leaf>
void traverse_leaves(const bvh::Tree& tree, const FilterRay& ray, float blur, KernelCounts* counts,
                     const Leaf& leaf) {
  const BoxRay box = box_ray(ray, blur);
  float tau_max = ray.tau_max;
  LeafStack stack;
  stack.start(tree);
  for (;;) {
    const std::uint32_t ref = next_leaf_of(tree, box, ray.tau_min, tau_max, stack, counts);
    if (ref == bvh::kNoChild) return;
    tau_max = std::min(tau_max, leaf(ref, tau_max));
  }
}

constexpr float kGoOn = std::numeric_limits<float>::infinity();

// Of a block's ray `number`.
struct PlainRay {
  const FilterRay& ray;
  float blur = 0;
  std::uint32_t number = 0;
};

// The same, triangle by triangle: `visit(candidate)` returns the new end of the range.
template <class Visit>
void traverse(const bvh::Tree& tree, const PlainRay& plain, KernelCounts* counts,
              const Visit& visit) {
  bvh::LeafScratch scratch;
  traverse_leaves(tree, plain.ray, plain.blur, counts, [&](std::uint32_t ref, float tau_max) {
    if (counts != nullptr) ++counts->leaves;
    const std::uint32_t count = bvh::leaf_count(ref);
    const float* rows = bvh::leaf_block(tree, ref, scratch) + bvh::kLeafHead;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Candidate candidate{bvh::number_in(rows, count, i), count, rows + i};
      if (counts != nullptr) ++counts->candidates;
      tau_max = std::min(tau_max, visit(candidate));
    }
    return tau_max;
  });
}

Candidate closest_of(const bvh::Tree& tree, const PlainRay& plain, std::uint32_t skip,
                     Resolver& resolver, TauInterval& tau, KernelCounts* counts) {
  Candidate best;
  traverse(tree, plain, counts, [&](const Candidate& candidate) {
    TauInterval its_tau;
    if (candidate.primitive == skip || !resolver.is_hit(plain.number, candidate, its_tau))
      return kGoOn;
    if (best.primitive == kNone || resolver.is_before(plain.number, candidate, best)) {
      best = candidate;
      tau = its_tau;
    }
    return its_tau.high;
  });
  return best;
}

bool any_of(const bvh::Tree& tree, const PlainRay& plain, std::uint32_t skip, Resolver& resolver,
            KernelCounts* counts) {
  bool found = false;
  traverse(tree, plain, counts, [&](const Candidate& candidate) {
    TauInterval tau;
    if (found || candidate.primitive == skip || !resolver.is_hit(plain.number, candidate, tau))
      return kGoOn;
    found = true;
    return -kGoOn;
  });
  return found;
}

Candidate closest(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip,
                  Resolver& resolver, KernelCounts* counts) {
  TauInterval tau;
  return closest_of(tree, {ray}, skip, resolver, tau, counts);
}

bool any(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, Resolver& resolver,
         KernelCounts* counts) {
  return any_of(tree, {ray}, skip, resolver, counts);
}

void all_of(const bvh::Tree& tree, const PlainRay& plain, std::uint32_t skip, CandidateSink& sink,
            KernelCounts* counts) {
  traverse(tree, plain, counts, [&](const Candidate& candidate) {
    if (candidate.primitive != skip) sink.add(candidate, false);
    return kGoOn;
  });
}

void all(const bvh::Tree& tree, const FilterRay& ray, std::uint32_t skip, CandidateSink& sink,
         KernelCounts* counts) {
  all_of(tree, {ray}, skip, sink, counts);
}

Candidate closest_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                          Resolver& resolver, TauInterval& tau, KernelCounts* counts) {
  return closest_of(tree, {ray, ray.blur}, skip, resolver, tau, counts);
}

bool any_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                 Resolver& resolver, KernelCounts* counts) {
  return any_of(tree, {ray, ray.blur}, skip, resolver, counts);
}

void all_blurred(const bvh::Tree& tree, const BlurredRay& ray, std::uint32_t skip,
                 CandidateSink& sink, KernelCounts* counts) {
  all_of(tree, {ray, ray.blur}, skip, sink, counts);
}

void visit_leaves(const bvh::Tree& tree, const FilterRay& ray, LeafVisitor& visitor,
                  KernelCounts* counts) {
  traverse_leaves(tree, ray, 0, counts, [&](std::uint32_t ref, float tau_max) {
    const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree, ref);
    for (std::uint32_t i = 0; i < bvh::leaf_count(ref); ++i) {
      tau_max = std::min(tau_max, visitor.visit(numbers[i]));
    }
    return tau_max;
  });
}

std::uint32_t next_leaf(const bvh::Tree& tree, const FilterRay& ray, float tau_max,
                        LeafStack& stack, KernelCounts* counts) {
  return next_leaf_of(tree, box_ray(ray, 0), ray.tau_min, tau_max, stack, counts);
}

void closest_blurred_block(const bvh::Tree& tree, const BlurredBlock& block, Resolver& resolver,
                           Candidate* out, TauInterval* taus, KernelCounts* counts) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const std::uint32_t ray = block.numbers[i];
    out[ray] = closest_of(tree, {block.rays[ray], block.rays[ray].blur, ray}, block.skips[ray],
                          resolver, taus[ray], counts);
  }
}

void any_blurred_block(const bvh::Tree& tree, const BlurredBlock& block, Resolver& resolver,
                       std::uint8_t* out, KernelCounts* counts) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    const std::uint32_t ray = block.numbers[i];
    const PlainRay plain{block.rays[ray], block.rays[ray].blur, ray};
    out[ray] = any_of(tree, plain, block.skips[ray], resolver, counts) ? 1 : 0;
  }
}

void closest_block(const bvh::Tree& tree, const RayBlock& block, Resolver& resolver, Candidate* out,
                   KernelCounts* counts) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    TauInterval tau;
    out[i] = closest_of(tree, {block.rays[i], 0, i}, block.skips[i], resolver, tau, counts);
  }
}

void any_block(const bvh::Tree& tree, const RayBlock& block, Resolver& resolver, std::uint8_t* out,
               KernelCounts* counts) {
  for (std::uint32_t i = 0; i < block.count; ++i) {
    out[i] = any_of(tree, {block.rays[i], 0, i}, block.skips[i], resolver, counts) ? 1 : 0;
  }
}

// Leaves all to predicate::round_hit.
template <class Real>
void round_none(const HitColumns&, std::size_t, RoundedColumns<Real>& out) {
  out.sure = out.bounded = 0;
}

template <class Real>
Rounded round_not_one(const predicate::RayD&, const predicate::TriangleD&, std::uint8_t, Hit<Real>&,
                      Hit<Real>&) {
  return Rounded::None;
}

bool round_not_finely(const predicate::RayD&, const predicate::TriangleD&, std::uint8_t,
                      Hit<float>&) {
  return false;
}

bool round_not_in_place(const Ray<double>&, const Vec3<double>&, const Vec3<double>&,
                        const Vec3<double>&, Hit<double>&) {
  return false;
}
bool round_not_unscaled(const Ray<double>&, const Candidate&, double, Hit<double>&) {
  return false;
}
predicate::Certified decide_nothing(const predicate::RayD&, const predicate::TriangleD&,
                                    predicate::Interval&) {
  return predicate::Certified::Unsure;
}
bool round_no_copy(const FilterRay&, const Candidate&, Hit<float>&) { return false; }

std::size_t no_transform_scaled(float, const Ray<float>*, std::size_t, FilterRay*) { return 0; }

template <class Real>
std::size_t no_transform_affine(const space::AffineMap&, const Ray<Real>*, std::size_t,
                                FilterRay*) {
  return 0;
}

template <class Real>
Straight closest_not_straight(const bvh::Tree&, const space::AffineMap&, const Ray<Real>&,
                              Resolver&, Candidate&) {
  return Straight::NotServed;
}
template <class Real>
Straight any_not_straight(const bvh::Tree&, const space::AffineMap&, const Ray<Real>&, Resolver&) {
  return Straight::NotServed;
}
Straight closest_not_scaled(const bvh::Tree&, float, const Ray<float>&, Resolver&, Candidate&,
                            Hit<float>&) {
  return Straight::NotServed;
}
Straight any_not_scaled(const bvh::Tree&, float, const Ray<float>&, Resolver&) {
  return Straight::NotServed;
}

bool none_within(const RayLimits&, const Ray<float>*, std::size_t) { return false; }
bool none_mapped(const space::AffineMap&, const Ray<double>*, std::size_t) { return false; }

}  // namespace

const Kernel& plain_kernel() {
  static constexpr Kernel kKernel{
      "plain",
      {no_transform_affine<float>, round_none<float>, round_not_one<float>,
       closest_not_straight<float>, any_not_straight<float>},
      {no_transform_affine<double>, round_none<double>, round_not_one<double>,
       closest_not_straight<double>, any_not_straight<double>},
      no_transform_scaled,
      none_within,
      none_mapped,
      round_no_copy,
      decide_nothing,
      round_not_finely,
      round_not_in_place,
      round_not_unscaled,
      closest_not_scaled,
      any_not_scaled,
      closest,
      any,
      closest_block,
      any_block,
      all,
      {closest_blurred, any_blurred, all_blurred, visit_leaves, next_leaf, closest_blurred_block,
       any_blurred_block},
      traverse_axis_plain,
      nearest_plain,
      winding_plain};
  return kKernel;
}

}  // namespace pierce::kernels
