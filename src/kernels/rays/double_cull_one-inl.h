// SPDX-License-Identifier: Apache-2.0
//
// The cull in double of one triangle: what double_cull-inl.h does for eight, with x, y and z in
// lanes. Of a ray that starts where another one hit, or ends on a triangle, float leaves that one
// open and no other.
#if defined(PIERCE_KERNELS_DOUBLE_CULL_ONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_DOUBLE_CULL_ONE_INL_H_
#undef PIERCE_KERNELS_DOUBLE_CULL_ONE_INL_H_
#else
#define PIERCE_KERNELS_DOUBLE_CULL_ONE_INL_H_
#endif

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/rays/double_cull-inl.h"
#if HWY_TARGET != HWY_SCALAR  // which has no pairs of lanes
#include "kernels/rounding/pair_axes-inl.h"
#endif

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
template <class D>
HWY_INLINE bool is_same(D d, hn::Vec<D> p, hn::Vec<D> q) {
  return all_three(d, hn::Eq(p, q));
}

// As double_cull_lanes; the answer's bits are those of lane 0. Bounds may be 0: then it knows that
// something is 0, too.
template <class D>
HWY_INLINE DoubleAnswer double_cull_pair(D d, const PairAxes<D>& pair, const FilteredAxes<D>& f,
                                         const TauRange<double>& range, Sides sides, float& low,
                                         float& high) {
  const auto s = hn::Abs(hn::Sub(pair.a, pair.o));
  const bool usable =
      f.usable && !all_three(d, hn::Lt(s, hn::Set(d, bounds::kSubnormalsAreNothing)));

  const auto sign = sign_of_side(d, f.value.den, sides);
  const double den = hn::GetLane(hn::Xor(f.value.den, sign));
  const bool known = std::fabs(den) > hn::GetLane(f.den_err);
  const auto uvw = hn::Xor(f.value.tuvw, sign);  // after t
  const auto zero = hn::And(hn::Eq(uvw, hn::Zero(d)), hn::Eq(f.tuvw_err, hn::Zero(d)));
  const std::uint32_t zeros = bits_of(d, zero) >> 1 & 7;
  const bool outside = (bits_of(d, hn::Lt(uvw, hn::Neg(f.tuvw_err))) & 14) != 0;
  const bool inside = (bits_of(d, hn::Or(zero, hn::Gt(uvw, f.tuvw_err))) & 14) == 14;

  const Denominator<D> denominator(f.value.den, f.den_err);
  const bool clear = (bits_of(d, denominator.clear) & 1) != 0;
  const auto ends = denominator.ends(f.value.tuvw, f.tuvw_err);
  const double tau_low = hn::GetLane(ends.low), tau_high = hn::GetLane(ends.high);
  const auto wider = [](double x) { return std::fabs(x) * 0x1p-23 + 0x1p-140; };
  low = static_cast<float>(tau_low - wider(tau_low));
  high = static_cast<float>(tau_high + wider(tau_high));
  const bool before = range.open ? tau_high <= range.first : tau_high < range.min;
  const bool beyond = clear && (before || tau_low > range.max);
  const bool started = tau_low > range.first || (range.counts_first() && tau_low >= range.first);
  const bool not_ended = tau_high < range.last || (range.own_last && tau_high <= range.last);

  DoubleAnswer answer;
  if (usable && ((known && (outside || den < 0)) || beyond)) {
    answer.missed = 1;
  } else if (usable && inside && clear && den > 0 && started && not_ended) {
    answer.certain = 1;
    answer.zeros = (zeros & 1) | (zeros & 2) << 7 | (zeros & 4) << 14;
  } else if (!known) {  // two corners may be in one place: no ray crosses it
    const bool segment =
        is_same(d, pair.a, pair.b) || is_same(d, pair.b, pair.c) || is_same(d, pair.c, pair.a);
    answer.missed = segment ? 1 : 0;
  }
  return answer;
}

template <class D>
HWY_INLINE bool starts_at_corner(D d, const PairAxes<D>& pair) {
  return is_same(d, pair.a, pair.o) || is_same(d, pair.b, pair.o) || is_same(d, pair.c, pair.o);
}

// Of triangle `lane` of a leaf; `asked_of` knows of the ray what is asked then.
template <class AskedOf>
HWY_NOINLINE DoubleAnswer double_cull_one(const float* rows, std::size_t stride,
                                          const FilterRay& ray, const TauRange<double>& range,
                                          std::uint32_t lane, float* low, float* high,
                                          const AskedOf& asked_of) {
  const hn::CappedTag<double, 4> d;
  const auto pair =
      copied_axes(d, ray, Candidate{0, static_cast<std::uint32_t>(stride), rows + lane});
  auto f = filtered(d, pair);
  DoubleAnswer answer = double_cull_pair(d, pair, f, range, ray.sides, low[lane], high[lane]);
  if ((answer.missed | answer.certain) == 0) {
    if (starts_at_corner(d, pair))
      return double_cull(rows, stride, ray, range, 1U << lane, kNoAxis, low, high, asked_of);
    if (f.usable && asked_of.is_whole(ray) && bound_by_terms(d, pair, f)) {
      answer = double_cull_pair(d, pair, f, range, ray.sides, low[lane], high[lane]);
      if (answer.zeros != 0 && !AskedOf::kEdges) answer = {};
    }
  }
  DoubleAnswer in_leaf;
  in_leaf.add(answer, lane);
  return in_leaf;
}

#endif  // HWY_TARGET != HWY_SCALAR

// Of those triangles that `open` has bits of.
template <class AskedOf>
HWY_INLINE DoubleAnswer double_cull_some(const float* rows, std::size_t stride,
                                         const FilterRay& ray, float tau_max, std::uint32_t open,
                                         std::uint32_t axis, float* low, float* high,
                                         const AskedOf& asked_of) {
  const TauRange<double> range = tau_range(ray, asked_of.t_range(), tau_max);
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(hn::CappedTag<double, 4>()) == 4) {
    if (axis == kNoAxis && (open & (open - 1)) == 0) [[likely]] {
      return double_cull_one(rows, stride, ray, range,
                             static_cast<std::uint32_t>(std::countr_zero(open)), low, high,
                             asked_of);
    }
  }
#endif
  return double_cull(rows, stride, ray, range, open, axis, low, high, asked_of);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
