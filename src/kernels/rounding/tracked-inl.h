// SPDX-License-Identifier: Apache-2.0
//
// Double arithmetic in lanes that notes whether it rounded. Between points of a grid, and along an
// axis, determinants are doubles often; their quotients are then rounded once, though they lie in
// the middle between two floats, or are 0.
#if defined(PIERCE_KERNELS_TRACKED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_TRACKED_INL_H_
#undef PIERCE_KERNELS_TRACKED_INL_H_
#else
#define PIERCE_KERNELS_TRACKED_INL_H_
#endif

#include <cstdint>

#include "kernels/rounding/compensated-inl.h"
#include "kernels/rounding/hit_lanes-inl.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// A number as double arithmetic has it; the bits of `low`, but for its sign, are 0 where nothing
// was rounded on the way.
template <class V>
struct Tracked {
  V high, low;
};

template <class V>
HWY_INLINE Tracked<V> sum(const Tracked<V>& a, const Tracked<V>& b) {
  const Compensated<V> s = two_sum(a.high, b.high);
  return {s.high, hn::Or(s.low, hn::Or(a.low, b.low))};
}
template <class V>
HWY_INLINE Tracked<V> product(const Tracked<V>& a, V b) {
  const Compensated<V> p = two_product(a.high, b);
  return {p.high, hn::Or(p.low, a.low)};
}
template <class V>
HWY_INLINE Tracked<V> product(const Tracked<V>& a, const Tracked<V>& b) {
  const Tracked<V> p = product(a, b.high);
  return {p.high, hn::Or(p.low, b.low)};
}

template <class V>
HWY_INLINE Tracked<V> tracked_difference(V a, V b) {
  const Compensated<V> s = two_sum(a, hn::Neg(b));
  return {s.high, s.low};
}
template <class V>
HWY_INLINE V3<Tracked<V>> tracked_difference(const V3<V>& p, const V3<V>& q) {
  return {tracked_difference(p.x, q.x), tracked_difference(p.y, q.y), tracked_difference(p.z, q.z)};
}

// Whether nothing of a product of three such numbers, or of differences of products of two with a
// third, can underflow unseen: 2^-150 each, or 0, leaves 2^-708 of what a product rounds off.
inline constexpr double kNotSmall = 0x1p-150;
template <class V>
HWY_INLINE auto is_not_small(V x, double least = kNotSmall) {
  const hn::DFromV<V> d;
  const V size = hn::Abs(x);
  return hn::Or(hn::Eq(size, hn::Zero(d)), hn::Ge(size, hn::Set(d, least)));
}
template <class V>
HWY_INLINE auto is_not_small(const V3<V>& p, double least = kNotSmall) {
  return hn::And(hn::And(is_not_small(p.x, least), is_not_small(p.y, least)),
                 is_not_small(p.z, least));
}

// t of a hit as a quotient: of the distance of a plane that stands across an axis, along which the
// ray then moves, for determinants have three factors and are doubles seldom; else of these.
template <class V>
struct TrackedPlace {
  Tracked<V> numerator, den;
};
template <class V>
HWY_INLINE TrackedPlace<V> tracked_place(const V3<Tracked<V>>& s, const V3<Tracked<V>>& e1,
                                         const V3<Tracked<V>>& e2, const V3<V>& direction,
                                         const Numbers<Tracked<V>>& value) {
  const auto zero = hn::Zero(hn::DFromV<V>());
  TrackedPlace<V> t{value.t, value.den};
  const auto look = [&](const Tracked<V>& way, V e1_part, V e2_part, V speed) {
    const auto across = hn::And(hn::Eq(e1_part, zero), hn::Eq(e2_part, zero));
    t.numerator = {hn::IfThenElse(across, way.high, t.numerator.high),
                   hn::IfThenElse(across, way.low, t.numerator.low)};
    t.den = {hn::IfThenElse(across, speed, t.den.high), hn::IfThenElse(across, zero, t.den.low)};
  };
  look(s.x, e1.x.high, e2.x.high, direction.x);
  look(s.y, e1.y.high, e2.y.high, direction.y);
  look(s.z, e1.z.high, e2.z.high, direction.z);
  return t;
}

// A quotient to float.
template <class D>
struct RoundedQuotient {
  hn::Vec<hn::Rebind<float, D>> value;  // never -0
  hn::Mask<D> sure;

  HWY_INLINE RoundedQuotient(const Tracked<hn::Vec<D>>& numerator, const Tracked<hn::Vec<D>>& den) {
    const D d;
    const hn::Rebind<float, D> df;
    const hn::RebindToUnsigned<D> du;
    const auto quotient = hn::Div(numerator.high, den.high);
    value = hn::Add(hn::DemoteTo(df, quotient), hn::Zero(df));
    // Where float has its 24 bits, a border between two floats is a double. If the quotient lies on
    // one side of it, so does it rounded to double, or else this is the border, and what it leaves
    // of the numerator is not 0.
    const auto size = hn::Abs(quotient);
    const auto ordinary =
        hn::And(hn::Ge(size, hn::Set(d, 0x1p-126)), hn::Lt(size, hn::Set(d, 0x1p127)));
    const auto tail = hn::And(hn::BitCast(du, quotient), hn::Set(du, 0x1fffffff));
    const auto off_border = hn::RebindMask(d, hn::Ne(tail, hn::Set(du, 0x10000000)));
    const auto back = two_product(quotient, den.high);
    const auto whole = hn::And(hn::Eq(back.high, numerator.high), hn::Eq(back.low, hn::Zero(d)));
    const auto lost = hn::Abs(hn::Or(numerator.low, den.low));
    sure = hn::And(hn::Eq(lost, hn::Zero(d)), hn::Or(hn::And(ordinary, hn::Or(off_border, whole)),
                                                     hn::Eq(numerator.high, hn::Zero(d))));
  }
};

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
