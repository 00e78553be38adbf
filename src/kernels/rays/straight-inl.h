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
    return static_cast<float>(ray.tau_scale) >= scale * kSmallestSlope;  // powers of two
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

// The cull in double, of a ray that is transformed again, and for this alone: what has an address
// does not stay in registers.
template <class Way>
HWY_NOINLINE DoubleAnswer double_cull_again(const Way& way, const float* rows, std::uint32_t count,
                                            float tau_max, std::uint32_t open, float* low,
                                            float* high, Resolver& resolver) {
  FilterRay ray;
  if (!way(ray) || !ray.exact) return {};
  const RayResolver asked_of{resolver, 0};
  return double_cull_some(rows, count, ray, tau_max, open, kNoAxis, low, high, asked_of);
}
template <class Way>
HWY_INLINE auto double_cull_of(const Way& way, const Leaf& leaf, float tau_max,
                               Resolver& resolver) {
  return [&way, &leaf, tau_max, &resolver](std::uint32_t open, float* low, float* high) HWY_ATTR {
    return double_cull_again(way, leaf.rows, leaf.count, tau_max, open, low, high, resolver);
  };
}

// Offers the open triangles of a leaf of some of which double is not certain either.
template <class Way>
HWY_NOINLINE FirstHit offer_again(const Way& way, Leaf leaf, LeafAnswer& answer, FirstHit first,
                                  Resolver& resolver) {
  FilterRay ray;
  way(ray);
  offer_all<false>(leaf, answer, ray, {resolver, 0}, first);
  return first;
}

// Whether one of them is hit.
template <class Way>
HWY_NOINLINE bool meets_again(const Way& way, Leaf leaf, LeafAnswer& answer, Resolver& resolver) {
  FilterRay ray;
  way(ray);
  return takes_any<false>(leaf, answer, ray, {resolver, 0});
}

// The same of rays that do not move along some axes: these have an address, for double is asked
// more often of them, and may know more.
inline HWY_NOINLINE void offer_still(const FilterRay& ray, const Leaf& leaf, LeafAnswer& answer,
                                     FirstHit& first, Resolver& resolver) {
  offer_all(leaf, answer, ray, {resolver, 0}, first);
}
inline HWY_NOINLINE bool meets_still(const FilterRay& ray, const Leaf& leaf, LeafAnswer& answer,
                                     Resolver& resolver) {
  return takes_any(leaf, answer, ray, {resolver, 0});
}

inline HWY_NOINLINE bool is_before(Resolver& resolver, Candidate challenger, Candidate best) {
  return resolver.is_before(0, challenger, best);
}

// Whether it may go straight.
template <class Way>
HWY_INLINE bool goes_straight(const Way& way, FilterRay& ray) {
  return way(ray) && is_ahead(ray) && way.has_inverse(ray);
}

// What a ray leaves out that does not move along some axes.
template <class Real>
LeavesOutAcross across_still_axes(const Ray<Real>& ray) {
  return {predicate::still_axes(ray.direction)};
}

// The first hit. `certain`: float was, or double, of all candidates and their order.
template <class Way, class LeavesOut>
HWY_INLINE Candidate closest_straight(const bvh::Tree& tree, const FilterRay& ray, const Way& way,
                                      Resolver& resolver, bool& certain, const LeavesOut& entered) {
  FirstHit first;
  first.tau_max = ray.tau_max;
  certain = true;
  OrderedStack stack({0, tree.root});
  bvh::LeafScratch scratch;
  traverse_ordered<false>(
      tree, NodeAddresses(tree), ray.tau_min, first.tau_max,
      box_ray<AheadRay>(ray, way.inverse(ray)), stack, nullptr,
      [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
        const Leaf leaf(tree, ref, scratch);
        LeafAnswer answer = cull_leaf<true>(leaf, ray, first.tau_max, kNone);
        if (answer.unsure() != 0) [[unlikely]] {
          if constexpr (LeavesOut::kStill) {
            certain = false;
            offer_still(ray, leaf, answer, first, resolver);
            return false;
          }
          offer_sharing_feature(leaf, answer, ray, {resolver, 0}, first);
          if (answer.unsure() != 0)
            ask_double(answer, double_cull_of(way, leaf, first.tau_max, resolver));
          if (answer.unsure() != 0 || answer.zeros != 0) {
            certain = false;
            LeafAnswer copy = answer;  // what has an address does not stay in registers
            first = offer_again(way, leaf, copy, first, resolver);
            return false;
          }
        }
        for (std::uint32_t open = answer.open; open != 0;) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
          open &= open - 1;
          const Candidate hit = leaf.candidate(lane);
          first.offer_if(
              hit, {answer.tau_low[lane], answer.tau_high[lane]},
              [&]() HWY_ATTR __attribute__((always_inline)) {
                certain = false;
                const bool before = is_before(resolver, hit, first.triangle);
                if (open != 0 && ray.exact && leaf.kept)
                  open &= ~repeats_of(before ? hit : first.triangle, leaf.rows, leaf.count);
                return before;
              });
        }
        return false;
      },
      entered);
  return first.triangle;
}

template <class Way, class LeavesOut>
HWY_INLINE Straight any_straight(const bvh::Tree& tree, const FilterRay& ray, const Way& way,
                                 Resolver& resolver, const LeavesOut& entered) {
  AnyStack stack(tree.root);
  bvh::LeafScratch scratch;
  const std::uint32_t stopped = traverse_leaves<false>(
      tree, ray.tau_min, ray.tau_max, box_ray<AheadRay>(ray, way.inverse(ray)), stack, nullptr,
      [&](std::uint32_t ref) HWY_ATTR __attribute__((always_inline)) {
        const Leaf leaf(tree, ref, scratch);
        LeafAnswer answer = cull_leaf<true>(leaf, ray, ray.tau_max, kNone);
        if (answer.open != 0 && answer.certain == 0) [[unlikely]] {
          if constexpr (LeavesOut::kStill) return meets_still(ray, leaf, answer, resolver);
          ask_double(answer, double_cull_of(way, leaf, ray.tau_max, resolver));
          if (answer.open != 0 && answer.certain == 0) {
            LeafAnswer copy = answer;
            return meets_again(way, leaf, copy, resolver);
          }
        }
        return answer.certain != 0;
      },
      entered);
  return stopped != bvh::kNoChild ? Straight::Hit : Straight::Miss;
}

// What rays of floats in a float scene, and rays of any other scene, make of their first hit.
HWY_INLINE Straight first_hit(const ByScaling&, const FilterRay& ray, const Candidate& winner,
                              bool certain, Hit<float>* hit) {
  if (winner.primitive == kNone) return Straight::Miss;
  if (!certain) return Straight::Hit;
  return round_copy(DOne(), ray, winner, *hit) ? Straight::Rounded : Straight::NotRounded;
}
template <class Real>
HWY_INLINE Straight first_hit(const ByMap<Real>&, const FilterRay&, const Candidate& winner, bool,
                              Hit<float>*) {
  return winner.primitive == kNone ? Straight::Miss : Straight::Hit;
}

template <class Way, class LeavesOut>
HWY_INLINE Straight closest_by(const bvh::Tree& tree, const FilterRay& ray, const Way& way,
                               Resolver& resolver, Candidate& winner, Hit<float>* hit,
                               const LeavesOut& entered) {
  bool certain = false;
  winner = closest_straight(tree, ray, way, resolver, certain, entered);
  return first_hit(way, ray, winner, certain, hit);
}

// Of rays that do not move along some axes. Apart, for there are few.
template <class Way>
HWY_NOINLINE Straight closest_by_still(const bvh::Tree& tree, const Way& way, Resolver& resolver,
                                       Candidate& winner, Hit<float>* hit) {
  FilterRay ray;
  if (!way(ray)) return Straight::NotServed;
  return closest_by(tree, ray, way, resolver, winner, hit, across_still_axes(way.r));
}
template <class Way>
HWY_NOINLINE Straight any_by_still(const bvh::Tree& tree, const Way& way, Resolver& resolver) {
  FilterRay ray;
  if (!way(ray)) return Straight::NotServed;
  return any_straight(tree, ray, way, resolver, across_still_axes(way.r));
}

template <class Way>
HWY_INLINE Straight closest_by(const bvh::Tree& tree, const Way& way, Resolver& resolver,
                               Candidate& winner, Hit<float>* hit) {
  FilterRay ray;
  if (!goes_straight(way, ray)) return Straight::NotServed;
  if (tree.root == bvh::kNoChild) return Straight::Miss;
  if (zero_axes(ray) != 0) [[unlikely]]
    return closest_by_still(tree, way, resolver, winner, hit);
  return closest_by(tree, ray, way, resolver, winner, hit, LeavesOutNone{});
}

template <class Way>
HWY_INLINE Straight any_by(const bvh::Tree& tree, const Way& way, Resolver& resolver) {
  FilterRay ray;
  if (!goes_straight(way, ray)) return Straight::NotServed;
  if (tree.root == bvh::kNoChild) return Straight::Miss;
  if (zero_axes(ray) != 0) [[unlikely]]
    return any_by_still(tree, way, resolver);
  return any_straight(tree, ray, way, resolver, LeavesOutNone{});
}

inline Straight closest_scaled(const bvh::Tree& tree, float scale, const Ray<float>& r,
                               Resolver& resolver, Candidate& winner, Hit<float>& hit) {
  return closest_by(tree, ByScaling{scale, r}, resolver, winner, &hit);
}

inline Straight any_scaled(const bvh::Tree& tree, float scale, const Ray<float>& r,
                           Resolver& resolver) {
  return any_by(tree, ByScaling{scale, r}, resolver);
}

template <class Real>
inline Straight closest_mapped(const bvh::Tree& tree, const space::AffineMap& map,
                               const Ray<Real>& r, Resolver& resolver, Candidate& winner) {
  return closest_by(tree, ByMap<Real>{map, r}, resolver, winner, nullptr);
}

template <class Real>
inline Straight any_mapped(const bvh::Tree& tree, const space::AffineMap& map, const Ray<Real>& r,
                           Resolver& resolver) {
  return any_by(tree, ByMap<Real>{map, r}, resolver);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
