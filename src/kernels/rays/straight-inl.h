// SPDX-License-Identifier: Apache-2.0
//
// One ray from its own coordinates to its answer, in one go: what lies in between stays in
// registers.
#if defined(PIERCE_KERNELS_STRAIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_STRAIGHT_INL_H_
#undef PIERCE_KERNELS_STRAIGHT_INL_H_
#else
#define PIERCE_KERNELS_STRAIGHT_INL_H_
#endif

#include "kernels/rays/single_queries-inl.h"
#include "kernels/rays/transform-inl.h"
#include "kernels/rounding/round_one-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The ways to filter space; they return false if a ray does not go there in lanes.
struct ByScaling {
  float scale;
  const Ray<float>& r;

  HWY_INLINE bool operator()(FilterRay& ray) const { return transform_scaled(scale, r, ray); }
  // The smallest directions are left to others: what is subnormal has no inverse.
  [[nodiscard]] HWY_INLINE bool has_inverse(const FilterRay& ray) const {
    return ray.tau_scale >= static_cast<double>(scale) * static_cast<double>(kSmallestSlope);
  }
  // inverse_slope of ray.direction, to the bit. It is divided before it is scaled by a power of
  // two, so that the division need not wait for that; a component without an inverse is below
  // kSmallestSlope of the direction's size.
  [[nodiscard]] HWY_INLINE V4 inverse(const FilterRay&) const {
    const hn::CappedTag<float, 4> d4;
    const auto direction = hn::LoadU(d4, &r.direction.x);
    const auto inverse = hn::Mul(hn::Div(hn::Set(d4, 1.0F), direction),
                                 power_of_two_below(max_norm_of_three(d4, direction)));
    return hn::Or(hn::Min(hn::Abs(inverse), hn::Set(d4, 1 / kSmallestSlope)),
                  hn::And(direction, hn::Set(d4, -0.0F)));
  }
};
template <class Real>
struct ByMap {
  const space::AffineMap& map;
  const Ray<Real>& r;

  HWY_INLINE bool operator()(FilterRay& ray) const { return transform_affine(map, r, ray); }
  [[nodiscard]] HWY_INLINE bool has_inverse(const FilterRay&) const { return true; }
  [[nodiscard]] HWY_INLINE V4 inverse(const FilterRay& ray) const { return inverse_slope_of(ray); }
};

// The rest of a traversal, from where float is not certain any more. The ray is transformed again,
// and for this alone: what has an address does not stay in registers.
template <class Way>
HWY_NOINLINE void search_on(const bvh::Tree& tree, const Way& way, OrderedStack& stack,
                            Resolver& resolver, FirstHit& first) {
  FilterRay ray;
  way(ray);
  search<false>(tree, ray, box_ray<AheadRay>(ray, inverse_slope_of(ray)), stack, kNone,
                {resolver, 0}, first, nullptr);
}

template <class Way>
HWY_NOINLINE bool any_on(const bvh::Tree& tree, const Way& way, AnyStack& stack,
                         Resolver& resolver) {
  FilterRay ray;
  way(ray);
  return traverse<false>(tree, ray, box_ray<AheadRay>(ray, inverse_slope_of(ray)), stack, kNone,
                         nullptr, [&](const Candidate& candidate, bool certain) {
                           TauInterval tau;
                           return RayResolver{resolver, 0}.takes(ray, candidate, certain, tau);
                         });
}

// Whether it may go straight: it moves along all axes, and is ahead.
template <class Way>
HWY_INLINE bool goes_straight(const Way& way, FilterRay& ray) {
  return way(ray) && is_ahead(ray) && way.has_inverse(ray) && zero_axes(ray) == 0;
}

// A hit that may come before the first one or after it: float cannot tell.
struct Tie {
  Candidate hit;
  TauInterval tau;
  bool many = false;  // it is not the only one
};

// The first hit. `certain`: float was, of all candidates.
template <class Way>
HWY_INLINE Candidate closest_straight(const bvh::Tree& tree, const FilterRay& ray, const Way& way,
                                      Resolver& resolver, bool& certain) {
  FirstHit first;
  first.tau_max = ray.tau_max;
  Tie tie;
  OrderedStack stack({0, tree.root});
  bvh::LeafScratch scratch;
  const std::uint32_t stopped = traverse_ordered<false>(
      tree, NodeAddresses(tree), ray.tau_min, first.tau_max,
      box_ray<AheadRay>(ray, way.inverse(ray)), stack,
      nullptr, [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
        const Leaf leaf(tree, ref, scratch);
        const LeafAnswer answer = cull_leaf<true>(leaf, ray, first.tau_max, kNone);
        if ((answer.open & ~answer.certain) != 0) [[unlikely]]
          return true;
        for (std::uint32_t open = answer.open; open != 0; open &= open - 1) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
          const Candidate hit = leaf.candidate(lane);
          const TauInterval tau{answer.tau_low[lane], answer.tau_high[lane]};
          first.offer_if(
              hit, tau, [&]() HWY_ATTR __attribute__((always_inline)) {
                tie.many = tie.hit.primitive != kNone;
                if (!tie.many) tie = {hit, tau};
                return false;
              });
        }
        return tie.many;
      });
  certain = stopped == bvh::kNoChild;
  if (certain && tie.hit.primitive == kNone) [[likely]]
    return first.triangle;
  // What has an address does not stay in registers: others get copies.
  FirstHit on = first;
  const Tie asked = tie;
  if (asked.hit.primitive != kNone) on.offer(asked.hit, asked.tau, RayResolver{resolver, 0});
  if (certain) return on.triangle;
  *stack.top++ = {ray.tau_min, stopped};
  search_on(tree, way, stack, resolver, on);
  return on.triangle;
}

template <class Way>
HWY_INLINE Straight any_straight(const bvh::Tree& tree, const Way& way, Resolver& resolver) {
  FilterRay ray;
  if (!goes_straight(way, ray)) return Straight::NotServed;
  if (tree.root == bvh::kNoChild) return Straight::Miss;
  AnyStack stack(tree.root);
  bvh::LeafScratch scratch;
  bool found = false;
  const std::uint32_t stopped = traverse_leaves<false>(
      tree, ray.tau_min, ray.tau_max, box_ray<AheadRay>(ray, way.inverse(ray)), stack,
      nullptr, [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
        const LeafAnswer answer =
            cull_leaf<true>(Leaf(tree, ref, scratch), ray, ray.tau_max, kNone);
        found = answer.certain != 0;
        return answer.open != 0;
      });
  if (!found && stopped != bvh::kNoChild) {
    *stack.top++ = stopped;
    found = any_on(tree, way, stack, resolver);
  }
  return found ? Straight::Hit : Straight::Miss;
}

inline Straight closest_scaled(const bvh::Tree& tree, float scale, const Ray<float>& r,
                               Resolver& resolver, Candidate& winner, Hit<float>& hit) {
  const ByScaling way{scale, r};
  FilterRay ray;
  if (!goes_straight(way, ray)) return Straight::NotServed;
  if (tree.root == bvh::kNoChild) return Straight::Miss;
  bool certain = false;
  winner = closest_straight(tree, ray, way, resolver, certain);
  if (winner.primitive == kNone) return Straight::Miss;
  if (!certain) return Straight::Hit;
  return round_copy(DOne(), ray, winner, hit) ? Straight::Rounded : Straight::NotRounded;
}

inline Straight any_scaled(const bvh::Tree& tree, float scale, const Ray<float>& r,
                           Resolver& resolver) {
  return any_straight(tree, ByScaling{scale, r}, resolver);
}

template <class Real>
inline Straight closest_mapped(const bvh::Tree& tree, const space::AffineMap& map,
                               const Ray<Real>& r, Resolver& resolver, Candidate& winner) {
  const ByMap<Real> way{map, r};
  FilterRay ray;
  if (!goes_straight(way, ray)) return Straight::NotServed;
  if (tree.root == bvh::kNoChild) return Straight::Miss;
  bool certain = false;
  winner = closest_straight(tree, ray, way, resolver, certain);
  return winner.primitive == kNone ? Straight::Miss : Straight::Hit;
}

template <class Real>
inline Straight any_mapped(const bvh::Tree& tree, const space::AffineMap& map, const Ray<Real>& r,
                           Resolver& resolver) {
  return any_straight(tree, ByMap<Real>{map, r}, resolver);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
