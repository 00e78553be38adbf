// SPDX-License-Identifier: Apache-2.0
//
// One ray against the eight triangles of a leaf, and what becomes of its first hit.
#if defined(PIERCE_KERNELS_LEAF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_LEAF_INL_H_
#undef PIERCE_KERNELS_LEAF_INL_H_
#else
#define PIERCE_KERNELS_LEAF_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "bvh/leaf_access.h"
#include "kernels/kernel.h"
#include "kernels/rays/cull-inl.h"
#include "kernels/rays/double_cull_one-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

using D = hn::CappedTag<float, bvh::kWidth>;
using V = hn::Vec<D>;
inline constexpr int kLanes = static_cast<int>(hn::MaxLanes(D{}));
inline constexpr int kParts = bvh::kWidth / kLanes;
static_assert(bvh::kWidth % kLanes == 0, "eight boxes are a whole number of vectors");

// A leaf block: in the tree, or, if that keeps no copies, in the scratch (until its next use).
struct Leaf {
  const float* rows;
  std::uint32_t count;
  float edge, reach;
  bool kept;  // in the tree: copies of other leaves are where they were

  HWY_INLINE Leaf(const bvh::Tree& tree, std::uint32_t ref, bvh::LeafScratch& scratch)
      : rows(bvh::leaf_block(tree, ref, scratch)),
        count(bvh::leaf_count(ref)),
        kept(tree.layout == bvh::Layout::Full) {
    edge = rows[0];
    reach = rows[1];
    rows += bvh::kLeafHead;
  }
  [[nodiscard]] HWY_INLINE Candidate candidate(std::uint32_t lane) const {
    return {bvh::number_in(rows, count, lane), count, rows + lane};
  }
};

HWY_INLINE std::uint32_t count_of(std::uint32_t bits) {
  return static_cast<std::uint32_t>(std::popcount(bits));
}

template <class AnyRay>
inline constexpr bool kIsBlurred = std::is_same_v<AnyRay, BlurredRay>;

// What the leaf cull says about the triangles of a block, a bit each.
struct LeafAnswer {
  std::uint32_t open = 0;     // not discarded
  std::uint32_t certain = 0;  // surely hit, with tau within the interval below
  std::uint32_t zeros = 0;    // as in DoubleAnswer
  alignas(32) float tau_low[bvh::kWidth];
  alignas(32) float tau_high[bvh::kWidth];

  [[nodiscard]] HWY_INLINE std::uint32_t unsure() const { return open & ~certain; }
  [[nodiscard]] HWY_INLINE std::uint8_t zeros_of(std::uint32_t lane) const {
    const std::uint32_t bits = zeros >> lane;
    return static_cast<std::uint8_t>((bits & 1) | (bits >> 7 & 2) | (bits >> 14 & 4));
  }
};

// The cull of one leaf. With kEarly it stops as soon as nothing is open: a predictable early exit
// for one ray, which interleaved rays would mispredict.
template <bool kEarly, class AnyRay>
HWY_INLINE LeafAnswer cull_leaf(const Leaf& leaf, const AnyRay& ray, float tau_max,
                                std::uint32_t skip) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  LeafAnswer answer;
  const V3<V> origin = broadcast(d, ray.origin);
  const V3<V> direction = broadcast(d, ray.direction);
  LeafBounds bounds = leaf_bounds(leaf.edge, std::max(leaf.reach, ray.reach), ray.exact, ray.sides);
  if constexpr (kIsBlurred<AnyRay>) bounds = blurred(bounds, leaf.edge, ray.blur);
  const std::uint32_t lanes =
      (1U << leaf.count) - 1;  // what stands in the lanes beyond means nothing
  for (std::uint32_t i = 0; i < bvh::kWidth; i += kLanes) {
    const float* rows = leaf.rows + i;
    Cull<D> cull(load_rows(d, rows, leaf.count), load_rows(d, rows + 3 * leaf.count, leaf.count),
                 load_rows(d, rows + 6 * leaf.count, leaf.count), origin, direction, bounds);
    std::uint32_t open = bits_of(d, cull.open()) & (lanes >> i);
    if (kEarly && open == 0) {
      if constexpr (kParts == 1) return answer;
      continue;
    }
    cull.compute_tau();
    const auto numbers = hn::BitCast(du, hn::LoadU(d, rows + 9 * leaf.count));
    const auto seen = hn::RebindMask(d, hn::Ne(numbers, hn::Set(du, bvh::LeafNumber(skip).bits())));
    const auto in_range = cull.in_range(hn::Set(d, ray.tau_min), hn::Set(d, tau_max));
    open &= bits_of(d, hn::And(seen, in_range));
    if (kEarly && open == 0) {
      if constexpr (kParts == 1) return answer;
      continue;
    }
    const auto certain = cull.certain(hn::Set(d, ray.tau_first), hn::Set(d, ray.tau_last));
    answer.open |= open << i;
    answer.certain |= (bits_of(d, certain) & open) << i;
    hn::Store(cull.low(), d, answer.tau_low + i);
    hn::Store(cull.high(), d, answer.tau_high + i);
  }
  return answer;
}

// Asks double about what float left open without being certain of it: `ask(unsure, low, high)`.
template <class Ask>
HWY_INLINE void ask_double(LeafAnswer& answer, const Ask& ask) {
  alignas(32) float low[bvh::kWidth], high[bvh::kWidth];
  const DoubleAnswer finer = ask(answer.unsure(), low, high);
  answer.open &= ~(answer.unsure() & finer.missed);
  const std::uint32_t certain = answer.unsure() & finer.certain;
  answer.certain |= certain;
  for (std::uint32_t rest = certain; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    answer.tau_low[lane] = low[lane];
    answer.tau_high[lane] = high[lane];
  }
  answer.zeros = finer.zeros;
}

// Which triangles of a leaf have the corners of this one, and larger numbers: of copies that are
// exact, they are hit where it is, and come after it. Of the same part loaded many times there are
// as many as it was loaded.
inline HWY_NOINLINE std::uint32_t repeats_of(Candidate triangle, const float* rows,
                                             std::uint32_t count) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  std::uint32_t repeats = 0;
  for (std::uint32_t i = 0; i < bvh::kWidth; i += kLanes) {
    const auto stored = hn::BitCast(du, hn::LoadU(d, rows + 9 * count + i));
    const auto numbers = hn::Xor(stored, hn::Set(du, bvh::LeafNumber(0).bits()));
    auto same = hn::RebindMask(d, hn::Gt(numbers, hn::Set(du, triangle.primitive)));
    for (std::uint32_t k = 0; k < 9; ++k) {
      const V corner = hn::Set(d, triangle.copy[k * triangle.stride]);
      same = hn::And(same, hn::Eq(hn::LoadU(d, rows + k * count + i), corner));
    }
    repeats |= bits_of(d, same) << i;
  }
  return repeats;
}

// The exact resolver, asked about one ray.
struct RayResolver {
  Resolver& resolver;
  std::uint32_t ray;

  bool is_hit(const Candidate& candidate, TauInterval& tau) const {
    return resolver.is_hit(ray, candidate, tau);
  }
  [[nodiscard]] bool is_before(const Candidate& challenger, const Candidate& best) const {
    return resolver.is_before(ray, challenger, best);
  }
  [[nodiscard]] std::uint8_t zeros(const Candidate& hit) const {
    return hit.zeros != 0 ? hit.zeros : resolver.zeros(ray, hit);
  }
  [[nodiscard]] bool shares_feature(const Candidate& candidate, const Candidate& hit) const {
    return resolver.shares_feature(candidate, hit);
  }
  /// Along which axis alone the ray moves, if its origin is exactly where it seems across that.
  [[nodiscard]] std::uint32_t moving_axis(const FilterRay& of) const {
    const auto moves = [&](std::size_t axis) { return of.direction[axis] != 0 ? 1U << axis : 0U; };
    const std::uint32_t moving = moves(0) | moves(1) | moves(2);
    if (std::popcount(moving) != 1 || (resolver.still_in_place(ray, of.origin) | moving) != 7)
      return kNoAxis;
    return static_cast<std::uint32_t>(std::countr_zero(moving));
  }
  static constexpr bool kEdges = true;  // certain may be a hit on an edge, too
  [[nodiscard]] TRange t_range() const { return resolver.t_range(ray); }
  [[nodiscard]] bool is_whole(const FilterRay& of) const { return resolver.is_whole(ray, of); }
  /// Whether a candidate is a hit that counts. Fills `tau` unless it is certain.
  template <class AnyRay>
  HWY_INLINE bool takes(const AnyRay& of, const Candidate& candidate, bool certain,
                        TauInterval& tau) const {
    if (!certain) return is_hit(candidate, tau);
    return !of.masked || resolver.sees(ray, candidate.primitive);
  }
};

// What a sink knows of its ray.
struct RaySink {
  CandidateSink& sink;

  static constexpr bool kEdges = false;
  [[nodiscard]] TRange t_range() const { return sink.t_range(); }
  [[nodiscard]] bool is_whole(const FilterRay& of) const { return sink.is_whole(of); }
  [[nodiscard]] std::uint32_t moving_axis(const FilterRay&) const { return kNoAxis; }
};

// Calls `visit(candidate, certain, lane)` for the open triangles of a leaf until it returns true,
// and returns whether it did; it may take others out of `answer`. If kAsking, asks double once,
// before the first of which float is not certain; `asked_of` knows what double has to know.
template <bool kAsking, class AnyRay, class AskedOf, class Visit>
HWY_INLINE bool visit_open(const Leaf& leaf, const AnyRay& ray, float tau_max, LeafAnswer& answer,
                           const AskedOf& asked_of, const Visit& visit) {
  bool asked = false;
  for (std::uint32_t open = answer.open; open != 0; open &= answer.open) {
    if constexpr (kAsking && !kIsBlurred<AnyRay>) {
      if ((answer.unsure() & open & (~open + 1)) != 0 && !asked && ray.exact) [[unlikely]] {
        asked = true;
        ask_double(answer, [&](std::uint32_t unsure, float* low, float* high) HWY_ATTR {
          return double_cull_some(leaf.rows, leaf.count, ray, tau_max, unsure,
                                  asked_of.moving_axis(ray), low, high, asked_of);
        });
        open &= answer.open;
        if (open == 0) return false;
      }
    }
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
    open &= open - 1;
    Candidate candidate = leaf.candidate(lane);
    if (answer.zeros != 0) candidate.zeros = answer.zeros_of(lane);
    if (visit(candidate, ((answer.certain >> lane) & 1U) != 0, lane)) return true;
  }
  return false;
}

// The first hit of one ray, as far as it is known.
struct FirstHit {
  Candidate triangle;
  TauInterval tau{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity()};
  float tau_max = 0;  // nothing beyond matters any more

  /// Takes the candidate if it comes before what is known; asks `is_before()` if tau cannot tell.
  template <class IsBefore>
  HWY_INLINE void offer_if(const Candidate& candidate, const TauInterval& its_tau,
                           const IsBefore& is_before) {
    if (its_tau.low > tau.high) return;
    if (its_tau.high >= tau.low && (candidate.primitive == triangle.primitive || !is_before()))
      return;
    triangle = candidate;
    tau = its_tau;
    tau_max = std::min(tau_max, its_tau.high);
  }
  HWY_INLINE void offer(const Candidate& candidate, const TauInterval& its_tau,
                        const RayResolver& resolver) {
    offer_if(
        candidate, its_tau, [&]() HWY_ATTR __attribute__((always_inline)) {
          return resolver.is_before(candidate, triangle);
        });
  }
};

// Whether two hits lie in the same corner or on the same edge, by their copies, which are exact.
HWY_INLINE bool meet_in_shared_feature(const Candidate& p, const Candidate& q) {
  if (p.zeros == 0 || q.zeros == 0) return false;
  const auto corners_of = [](const Candidate& candidate) {
    return [&candidate](int k) { return candidate.corner(k); };
  };
  return predicate::meet_in_shared_feature(corners_of(p), p.zeros, corners_of(q), q.zeros);
}

// Which triangles of a leaf have a corner in this place, by their copies.
HWY_INLINE std::uint32_t around(const Vec3<float>& place, const Leaf& leaf) {
  const D d;
  const V3<V> p = broadcast(d, &place.x);
  std::uint32_t lanes = 0;
  for (std::uint32_t i = 0; i < bvh::kWidth; i += kLanes) {
    const auto is_there = [&](std::uint32_t row) HWY_ATTR {
      return is_same(load_rows(d, leaf.rows + row * leaf.count + i, leaf.count), p);
    };
    lanes |= bits_of(d, hn::Or(hn::Or(is_there(0), is_there(3)), is_there(6))) << i;
  }
  return lanes;
}

// Of some triangles of a leaf, the one with the least number.
HWY_INLINE std::uint32_t lane_of_least(const Leaf& leaf, std::uint32_t lanes) {
  std::uint32_t least = 0, number = kNone;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
    if (leaf.candidate(lane).primitive >= number) continue;
    least = lane;
    number = leaf.candidate(lane).primitive;
  }
  return least;
}

// Of those triangles of a leaf that `open` has bits of, those that have the corner, or the edge, in
// which a ray's first hit lies: either no hit, or one in the same place. Of a fan there are many.
struct SharingFeature {
  std::uint32_t lanes;
  FirstHit first;  // and the new one, if one of them comes before it
};
inline HWY_NOINLINE SharingFeature decide_sharing_feature(Leaf leaf, std::uint32_t open, bool exact,
                                                          FirstHit first,
                                                          const RayResolver& resolver) {
  first.triangle.zeros = resolver.zeros(first.triangle);
  const predicate::Support support = predicate::kSupports[first.triangle.zeros];
  if (support.count == 3) return {0, first};
  std::uint32_t lanes = open & around(first.triangle.corner(support.first), leaf) &
                        around(first.triangle.corner(support.last), leaf);
  std::uint32_t earlier = 0;  // by their numbers
  for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
    const std::uint32_t lane = rest & (~rest + 1);
    const Candidate candidate = leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(lane)));
    if (!exact && !resolver.shares_feature(candidate, first.triangle)) {
      lanes &= ~lane;
    } else if (candidate.primitive < first.triangle.primitive) {
      earlier |= lane;
    }
  }
  while (earlier != 0) {
    const std::uint32_t lane = lane_of_least(leaf, earlier);
    TauInterval tau;  // the same
    if (resolver.is_hit(leaf.candidate(lane), tau)) {
      first.triangle = leaf.candidate(lane);
      break;
    }
    earlier &= ~(1U << lane);
  }
  return {lanes, first};
}

// Takes these out of `answer`, of which double would have to be asked, and offers them to the first
// hit, whose copy has to be there still.
template <class AnyRay>
HWY_INLINE void offer_sharing_feature(const Leaf& leaf, LeafAnswer& answer, const AnyRay& ray,
                                      const RayResolver& resolver, FirstHit& first) {
  if (answer.unsure() == 0 || !leaf.kept || first.triangle.primitive == kNone) [[likely]]
    return;
  const SharingFeature sharing =
      decide_sharing_feature(leaf, answer.unsure(), ray.exact, first, resolver);
  answer.open &= ~sharing.lanes;
  first = sharing.first;
}

// Offers the open triangles of a leaf to a ray's first hit.
template <bool kAsking = true, class AnyRay>
HWY_INLINE void offer_all(const Leaf& leaf, LeafAnswer& answer, const AnyRay& ray,
                          const RayResolver& resolver, FirstHit& first) {
  if constexpr (kAsking && !kIsBlurred<AnyRay>)
    offer_sharing_feature(leaf, answer, ray, resolver, first);
  visit_open<kAsking>(leaf, ray, first.tau_max, answer, resolver,
                      [&](const Candidate& candidate, bool certain, std::uint32_t lane) HWY_ATTR {
                        TauInterval tau{answer.tau_low[lane], answer.tau_high[lane]};
                        if (!resolver.takes(ray, candidate, certain, tau)) return false;
                        first.offer_if(candidate, tau, [&]() HWY_ATTR {
                          const bool kept = !kIsBlurred<AnyRay> && ray.exact && leaf.kept;
                          if (kept && meet_in_shared_feature(candidate, first.triangle))
                            return candidate.primitive < first.triangle.primitive;
                          const bool before = resolver.is_before(candidate, first.triangle);
                          if (kept && answer.open >> lane != 1) {
                            answer.open &= ~repeats_of(before ? candidate : first.triangle,
                                                       leaf.rows, leaf.count);
                          }
                          return before;
                        });
                        return false;
                      });
}

// Whether one of the open triangles of a leaf is hit.
template <bool kAsking = true, class AnyRay>
HWY_INLINE bool takes_any(const Leaf& leaf, LeafAnswer& answer, const AnyRay& ray,
                          const RayResolver& resolver) {
  return visit_open<kAsking>(leaf, ray, ray.tau_max, answer, resolver,
                             [&](const Candidate& candidate, bool certain, std::uint32_t) HWY_ATTR {
                               TauInterval tau;
                               return resolver.takes(ray, candidate, certain, tau);
                             });
}

// Whether one of many rays hits a triangle of the leaf.
template <bool kEarly, class AnyRay>
HWY_INLINE bool meets_any(const Leaf& leaf, const AnyRay& ray, std::uint32_t skip,
                          const RayResolver& resolver, KernelCounts* counts) {
  LeafAnswer answer = cull_leaf<kEarly>(leaf, ray, ray.tau_max, skip);
  if (counts != nullptr) counts->candidates += count_of(answer.open);
  bool found = answer.certain != 0 && !ray.masked;
  if (answer.open != 0 && !found) [[unlikely]]
    found = takes_any(leaf, answer, ray, resolver);
  return found;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
