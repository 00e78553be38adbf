// SPDX-License-Identifier: Apache-2.0
//
// The cull once more, in double, of what float left open: of an exact ray and exact copies it is
// the double rung (predicate/certify.h) in lanes, by the same bounds. Where rays graze, or
// triangles are small beside their distance from the middle of the scene, float leaves many open,
// and the ladder would take them one by one.
#if defined(PIERCE_KERNELS_DOUBLE_CULL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_DOUBLE_CULL_INL_H_
#undef PIERCE_KERNELS_DOUBLE_CULL_INL_H_
#else
#define PIERCE_KERNELS_DOUBLE_CULL_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/kernel.h"
#include "kernels/rays/cull-inl.h"
#include "kernels/rounding/round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// What double says of some lanes, a bit each.
struct DoubleAnswer {
  std::uint32_t missed = 0;   // surely no hit
  std::uint32_t certain = 0;  // surely a hit, with tau within the interval that was stored
  // Whose weights are surely 0: of u, v and w (predicate::kZeroU ...), eight lanes each.
  std::uint32_t zeros = 0;

  // Of lanes from `i` on, counted from 0.
  HWY_INLINE void add(const DoubleAnswer& part, std::uint32_t i) {
    missed |= part.missed << i;
    certain |= part.certain << i;
    zeros |= part.zeros << i;
  }
};

// The range of tau: what is outside [min, max] is surely outside, what is inside (first, last) is
// surely inside.
template <class Number>
struct TauRange {
  Number min, max, first, last;
  // Whether `first` and `last` are the ray's own ends; and the first one does not count.
  bool own_first = false, own_last = false, open = false;

  [[nodiscard]] HWY_INLINE bool counts_first() const { return own_first && !open; }
};

// As float has it, up to `tau_max`; but the ends as they are, which nothing separates then from
// what starts, or ends, on a triangle: tau is t times a power of two, if that is in the range of
// ordinary numbers.
HWY_INLINE TauRange<double> tau_range(const FilterRay& ray, const TRange& t, float tau_max) {
  TauRange<double> range{static_cast<double>(ray.tau_min), static_cast<double>(tau_max),
                         static_cast<double>(ray.tau_first), static_cast<double>(ray.tau_last)};
  const auto is_ordinary = [](double tau, double of) {
    const double size = std::fabs(tau);
    return of == 0 || (size >= 0x1p-900 && size <= static_cast<double>(space::kTauLimit));
  };
  const double first = t.min * ray.tau_scale, last = t.max * ray.tau_scale;
  if (range.first > static_cast<double>(space::kTauLimit)) return range;  // nothing may be certain
  if (is_ordinary(first, t.min)) {
    range.min = range.first = first;
    range.own_first = true;
    range.open = t.open;
  }
  if (is_ordinary(last, t.max)) {
    range.own_last = true;
    range.max = std::min(range.max, last);
    range.last = last;
  }
  return range;
}

// Stores intervals of tau, outward so that the casts do not matter; returns which of them, as they
// are, lie surely within the range.
template <class D>
HWY_INLINE hn::Mask<D> store_taus(D d, const Ends<hn::Vec<D>>& tau,
                                  const TauRange<hn::Vec<D>>& range, float* low, float* high) {
  const hn::Rebind<float, D> df;
  const auto wider = [&](auto x) {
    return hn::MulAdd(hn::Abs(x), hn::Set(d, 0x1p-23), hn::Set(d, 0x1p-140));
  };
  const auto low_tau = hn::DemoteTo(df, hn::Sub(tau.low, wider(tau.low)));
  const auto high_tau = hn::DemoteTo(df, hn::Add(tau.high, wider(tau.high)));
  hn::StoreU(low_tau, df, low);
  hn::StoreU(high_tau, df, high);
  const auto started =
      range.counts_first() ? hn::Ge(tau.low, range.first) : hn::Gt(tau.low, range.first);
  const auto not_ended =
      range.own_last ? hn::Le(tau.high, range.last) : hn::Lt(tau.high, range.last);
  return hn::And(started, not_ended);
}

// Which lie surely outside it.
template <class D>
HWY_INLINE hn::Mask<D> is_beyond(const Ends<hn::Vec<D>>& tau, const TauRange<hn::Vec<D>>& range) {
  const auto before = range.open ? hn::Le(tau.high, range.first) : hn::Lt(tau.high, range.min);
  return hn::Or(before, hn::Gt(tau.low, range.max));
}

template <class V>
HWY_INLINE auto is_same(const V3<V>& p, const V3<V>& q) {
  return hn::And(hn::And(hn::Eq(p.x, q.x), hn::Eq(p.y, q.y)), hn::Eq(p.z, q.z));
}

// Two corners in one place: no ray crosses it.
template <class D>
HWY_INLINE hn::Mask<D> is_segment(const HitLanes<D>& hit) {
  return hn::Or(hn::Or(is_same(hit.a, hit.b), is_same(hit.b, hit.c)), is_same(hit.c, hit.a));
}

// The determinants and how far each of them may be off. What is 0, and off by 0, is known to be 0.
template <class D>
struct BoundedLanes {
  using VD = hn::Vec<D>;
  Numbers<VD> value, err;
  hn::Mask<D> usable;

  HWY_INLINE BoundedLanes(D d, const HitLanes<D>& hit)
      : BoundedLanes(filtered(hit),
                     hn::Ge(max_norm(hit.a - hit.o), hn::Set(d, bounds::kSubnormalsAreNothing))) {}

 private:
  HWY_INLINE BoundedLanes(const FilteredLanes<D>& f, hn::Mask<D> far)
      : value(f.value),
        err{f.den_err, f.uv_err, f.uv_err, f.w_err, f.t_err},
        usable(hn::And(f.usable, far)) {}
};

template <class V>
HWY_INLINE V3<V> sizes_of(const V3<V>& p) {
  return {hn::Abs(p.x), hn::Abs(p.y), hn::Abs(p.z)};
}
template <class V>
HWY_INLINE V3<V> cross_of_sizes(const V3<V>& p, const V3<V>& q) {
  return {hn::MulAdd(p.y, q.z, hn::Mul(p.z, q.y)), hn::MulAdd(p.z, q.x, hn::Mul(p.x, q.z)),
          hn::MulAdd(p.x, q.y, hn::Mul(p.y, q.x))};
}

// Where the ray starts at a corner: T and two weights are 0, and the third one is all of den.
template <class D>
HWY_INLINE void start_at_corners(D d, const HitLanes<D>& hit, BoundedLanes<D>& f) {
  using VD = hn::Vec<D>;
  const auto at_a = is_same(hit.a, hit.o), at_b = is_same(hit.b, hit.o);
  const auto at_c = is_same(hit.c, hit.o);
  const auto at_any = hn::Or(hn::Or(at_a, at_b), at_c);
  if (hn::AllFalse(d, at_any)) return;
  const auto set = [&](const auto& all, const auto& none, VD& value, VD& err) HWY_ATTR {
    value = hn::IfThenElse(all, f.value.den, hn::IfThenZeroElse(none, value));
    err = hn::IfThenElse(all, f.err.den, hn::IfThenZeroElse(none, err));
  };
  set(at_b, hn::Or(at_a, at_c), f.value.u, f.err.u);
  set(at_c, hn::Or(at_a, at_b), f.value.v, f.err.v);
  set(at_a, hn::Or(at_b, at_c), f.value.w, f.err.w);
  f.value.t = hn::IfThenZeroElse(at_any, f.value.t);
  f.err.t = hn::IfThenZeroElse(at_any, f.err.t);
  const VD e1 = max_norm(hit.b - hit.a), e2 = max_norm(hit.c - hit.a), speed = max_norm(hit.d);
  const auto of_size =
      hn::And(hn::Ge(hn::Min(hn::Min(e1, e2), speed), hn::Set(d, bounds::kSmallestMagnitude)),
              hn::Le(hn::Max(hn::Max(e1, e2), speed), hn::Set(d, bounds::kLargestMagnitude)));
  f.usable = hn::Or(f.usable, hn::And(at_any, of_size));
}

// As in pair_axes-inl.h.
template <class D>
HWY_INLINE void bound_by_terms(D d, const HitLanes<D>& hit, BoundedLanes<D>& f) {
  using VD = hn::Vec<D>;
  const auto s = hit.a - hit.o, s_b = hit.b - hit.o;
  const auto e1 = hit.b - hit.a, e2 = hit.c - hit.a, e3 = hit.c - hit.b;
  const auto is_seen = [](const V3<VD>& p)
                           HWY_ATTR { return is_not_small(p, bounds::kSmallestComponent); };
  const auto seen = hn::And(hn::And(hn::And(is_seen(s), is_seen(s_b)), is_seen(hit.d)),
                            hn::And(hn::And(is_seen(e1), is_seen(e2)), is_seen(e3)));
  const auto factor = hn::Set(d, bounds::kTermwise);
  const auto e1_size = sizes_of(e1), e2_size = sizes_of(e2), d_size = sizes_of(hit.d);
  const auto n = cross_of_sizes(e1_size, e2_size), r = cross_of_sizes(d_size, sizes_of(s));
  // Takes the smaller bound; returns where.
  const auto bound = [&](const V3<VD>& p, const V3<VD>& q, VD& err) HWY_ATTR {
    const VD by_terms = hn::Mul(factor, dot(p, q));
    const auto less = hn::And(seen, hn::Lt(by_terms, err));
    err = hn::IfThenElse(less, by_terms, err);
    return less;
  };
  bound(n, d_size, f.err.den);
  bound(r, e2_size, f.err.u);
  bound(r, e1_size, f.err.v);
  bound(n, sizes_of(s), f.err.t);
  const auto less = bound(cross_of_sizes(d_size, sizes_of(s_b)), sizes_of(e3), f.err.w);
  f.value.w = hn::IfThenElse(less, dot(cross(hit.d, s_b), e3), f.value.w);
  start_at_corners(d, hit, f);
}

// Of pairs of an exact ray and a copy. Stores intervals of tau, of meaning where a hit is certain.
// docs/algorithm.md, "The cull once more, in double".
template <class D>
HWY_INLINE DoubleAnswer double_cull_lanes(D d, const HitLanes<D>& hit, const BoundedLanes<D>& f,
                                          const TauRange<hn::Vec<D>>& range, Sides sides,
                                          float* low, float* high) {
  using VD = hn::Vec<D>;
  const auto sign = sign_of_side(d, f.value.den, sides);
  const VD den = hn::Xor(f.value.den, sign), zero = hn::Zero(d);
  const auto known = hn::Gt(hn::Abs(den), f.err.den);
  const VD u = hn::Xor(f.value.u, sign), v = hn::Xor(f.value.v, sign);
  const VD w = hn::Xor(f.value.w, sign);
  const auto is_zero = [&](VD x, VD err)
                           HWY_ATTR { return hn::And(hn::Eq(x, zero), hn::Eq(err, zero)); };
  const auto u_zero = is_zero(u, f.err.u), v_zero = is_zero(v, f.err.v);
  const auto w_zero = is_zero(w, f.err.w);
  const auto outside = hn::Or(hn::Or(hn::Lt(u, hn::Neg(f.err.u)), hn::Lt(v, hn::Neg(f.err.v))),
                              hn::Lt(w, hn::Neg(f.err.w)));
  const auto other_side = hn::Lt(den, zero);

  const Denominator<D> denominator(f.value.den, f.err.den);
  const auto tau = denominator.ends(f.value.t, f.err.t);
  const auto beyond = hn::And(denominator.clear, is_beyond<D>(tau, range));
  DoubleAnswer answer;
  const auto missed =
      hn::And(f.usable, hn::Or(hn::And(known, hn::Or(outside, other_side)), beyond));
  answer.missed = bits_of(d, hn::Or(missed, is_segment(hit)));

  const auto weights =
      hn::And(hn::And(hn::Or(u_zero, hn::Gt(u, f.err.u)), hn::Or(v_zero, hn::Gt(v, f.err.v))),
              hn::Or(w_zero, hn::Gt(w, f.err.w)));
  const auto inside = hn::And(weights, hn::And(denominator.clear, hn::Gt(den, zero)));
  const auto within = store_taus(d, tau, range, low, high);
  const auto certain = hn::And(f.usable, hn::And(inside, within));
  answer.certain = bits_of(d, certain);
  answer.zeros = bits_of(d, hn::And(certain, u_zero)) | bits_of(d, hn::And(certain, v_zero)) << 8 |
                 bits_of(d, hn::And(certain, w_zero)) << 16;
  return answer;
}

// Of a ray that moves along one axis alone, and whose origin is exactly where it seems across that:
// U, V and W are differences of two products of the corners' distances from it, and where these are
// floats their signs are the true ones. `lost`: what its place along the axis may be off by.
// Returns the lanes of which it knows whether they are hit. docs/algorithm.md, "The cull once more,
// in double".
template <class D>
HWY_INLINE std::uint32_t cull_along_axis(D d, const HitLanes<D>& hit, std::uint32_t axis,
                                         const TauRange<hn::Vec<D>>& range, hn::Vec<D> lost,
                                         Sides sides, DoubleAnswer& answer, float* low,
                                         float* high) {
  using VD = hn::Vec<D>;
  const hn::Rebind<float, D> df;
  const auto component = [](const V3<VD>& p, std::uint32_t k) {
    return k == 0 ? p.x : k == 1 ? p.y : p.z;
  };
  auto known = hn::FirstN(d, hn::Lanes(d));
  const auto across = [&](const V3<VD>& corner, std::uint32_t k) HWY_ATTR {
    const auto distance = two_sum(component(corner, k), hn::Neg(component(hit.o, k)));
    const auto as_float = hn::PromoteTo(d, hn::DemoteTo(df, distance.high));
    known =
        hn::And(known, hn::And(hn::Eq(distance.low, hn::Zero(d)), hn::Eq(as_float, distance.high)));
    return distance.high;
  };
  const std::uint32_t p = (axis + 1) % 3, q = (axis + 2) % 3;
  const VD a_p = across(hit.a, p), a_q = across(hit.a, q);
  const VD b_p = across(hit.b, p), b_q = across(hit.b, q);
  const VD c_p = across(hit.c, p), c_q = across(hit.c, q);
  const VD speed = component(hit.d, axis);
  const VD sign = hn::And(speed, hn::Set(d, -0.0));
  const auto side = [&](VD m, VD n) { return hn::Xor(hn::Sub(m, n), sign); };
  const VD u = side(hn::Mul(c_p, a_q), hn::Mul(c_q, a_p));
  const VD v = side(hn::Mul(a_p, b_q), hn::Mul(a_q, b_p));
  const VD w = side(hn::Mul(b_p, c_q), hn::Mul(b_q, c_p));
  const VD zero = hn::Zero(d);
  const VD least = hn::Min(hn::Min(u, v), w), greatest = hn::Max(hn::Max(u, v), w);
  const auto back = hn::And(hn::Ge(least, zero), hn::Gt(greatest, zero));
  const auto front = hn::And(hn::Le(greatest, zero), hn::Lt(least, zero));
  const auto met = sides == Sides::Back    ? back
                   : sides == Sides::Front ? front
                                           : hn::Or(back, front);
  const auto zeros = [&](VD x) HWY_ATTR { return bits_of(d, hn::And(known, hn::Eq(x, zero))); };
  answer.zeros = zeros(u) | zeros(v) << 8 | zeros(w) << 16;

  // The place is a mean of the corners' places, weighted.
  const auto along = [&](const V3<VD>& corner) {
    return hn::Sub(component(corner, axis), component(hit.o, axis));
  };
  const VD a = along(hit.a), b = along(hit.b), c = along(hit.c);
  const VD weighted = hn::Add(hn::Add(hn::Mul(u, b), hn::Mul(v, c)), hn::Mul(w, a));
  const VD tau = hn::Div(weighted, hn::Mul(hn::Add(hn::Add(u, v), w), speed));
  const VD reach = hn::Max(hn::Max(hn::Abs(a), hn::Abs(b)), hn::Abs(c));
  const VD err = hn::MulAdd(reach, hn::Set(d, bounds::kAlongAxis), lost);
  const Ends<VD> ends{hn::Sub(tau, err), hn::Add(tau, err)};
  const auto beyond = is_beyond<D>(ends, range);
  const auto within = store_taus(d, ends, range, low, high);
  answer.missed = bits_of(d, hn::And(known, hn::Or(hn::Not(met), beyond)));
  answer.certain = bits_of(d, hn::And(known, hn::And(met, within))) & ~answer.missed;
  return bits_of(d, known);
}

template <class D>
HWY_INLINE hn::Vec<D> load_as_doubles(D d, const float* row) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), row));
}

inline constexpr std::uint32_t kNoAxis = 3;

// One exact ray against those triangles of a leaf of which `open` has bits: rows of their corners,
// `stride` apart. `axis`: that of cull_along_axis, if there is one. `asked_of` knows of the ray
// what is asked then. Apart: it is seldom asked.
template <class AskedOf>
HWY_NOINLINE DoubleAnswer double_cull(const float* rows, std::size_t stride, const FilterRay& ray,
                                      const TauRange<double>& tau, std::uint32_t open,
                                      std::uint32_t axis, float* low, float* high,
                                      const AskedOf& asked_of) {
  using D8 = hn::CappedTag<double, 8>;
  using VD = hn::Vec<D8>;
  const D8 d;
  const auto all = [&](float x) { return hn::Set(d, static_cast<double>(x)); };
  const auto point = [&](const float* p) { return V3<VD>{all(p[0]), all(p[1]), all(p[2])}; };
  const V3<VD> origin = point(ray.origin), direction = point(ray.direction);
  const TauRange<VD> range{hn::Set(d, tau.min),
                           hn::Set(d, tau.max),
                           hn::Set(d, tau.first),
                           hn::Set(d, tau.last),
                           tau.own_first,
                           tau.own_last,
                           tau.open};
  const bool whole = axis == kNoAxis || asked_of.is_whole(ray);
  const VD lost = hn::Set(d, whole ? 0.0 : bounds::kLostAlongAxis);
  DoubleAnswer answer;
  for (std::uint32_t i = 0; i < 8; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
    std::uint32_t asked = (open >> i) & ((1U << hn::Lanes(d)) - 1);
    if (asked == 0) continue;
    const auto corner = [&](std::size_t row) {
      const float* p = rows + row * stride + i;
      return V3<VD>{load_as_doubles(d, p), load_as_doubles(d, p + stride),
                    load_as_doubles(d, p + 2 * stride)};
    };
    const HitLanes<D8> hits{corner(0), corner(3), corner(6), origin, direction};
    if (axis != kNoAxis) {
      DoubleAnswer part;
      asked &= ~cull_along_axis(d, hits, axis, range, lost, ray.sides, part, low + i, high + i);
      if (asked == 0) {
        answer.add(part, i);
        continue;
      }
    }
    BoundedLanes<D8> f(d, hits);
    DoubleAnswer part = double_cull_lanes(d, hits, f, range, ray.sides, low + i, high + i);
    if ((asked & ~(part.missed | part.certain)) != 0 && asked_of.is_whole(ray)) {
      bound_by_terms(d, hits, f);
      part = double_cull_lanes(d, hits, f, range, ray.sides, low + i, high + i);
      if (!AskedOf::kEdges) part.certain &= ~(part.zeros | part.zeros >> 8 | part.zeros >> 16);
    }
    answer.add(part, i);
  }
  return answer;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
