// SPDX-License-Identifier: Apache-2.0
//
// Correct rounding of many hits at a time: predicate/round.cpp in lanes, double lanes for float
// scenes and lanes of double-doubles for double scenes. Same formulas, same bounds (fused products
// round less often than the bounds allow); what is not certain is left to it.
#if defined(PIERCE_KERNELS_ROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROUND_INL_H_
#undef PIERCE_KERNELS_ROUND_INL_H_
#else
#define PIERCE_KERNELS_ROUND_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/kernel.h"
#include "kernels/vectors-inl.h"
#include "predicate/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

using DD = hn::CappedTag<double, kRoundStep>;
using VD = hn::Vec<DD>;

// exact::DoubleDouble in lanes; the errors of its operations are bounded there.
struct Pair {
  VD high, low;
};

HWY_INLINE Pair two_sum(VD a, VD b) {
  const VD sum = hn::Add(a, b);
  const VD b_part = hn::Sub(sum, a);
  const VD a_part = hn::Sub(sum, b_part);
  return {sum, hn::Add(hn::Sub(a, a_part), hn::Sub(b, b_part))};
}

HWY_INLINE Pair quick_two_sum(VD a, VD b) {
  const VD sum = hn::Add(a, b);
  return {sum, hn::Sub(b, hn::Sub(sum, a))};
}

HWY_INLINE Pair two_product(VD a, VD b) {
  const VD product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
  return {product, hn::MulSub(a, b, product)};
#else
  const VD splitter = hn::Set(DD{}, 0x1p27 + 1);
  const VD a_big = hn::Mul(splitter, a);
  const VD a_high = hn::Sub(a_big, hn::Sub(a_big, a));
  const VD a_low = hn::Sub(a, a_high);
  const VD b_big = hn::Mul(splitter, b);
  const VD b_high = hn::Sub(b_big, hn::Sub(b_big, b));
  const VD b_low = hn::Sub(b, b_high);
  const VD corners = hn::Add(hn::Mul(a_high, b_low), hn::Mul(a_low, b_high));
  const VD rest = hn::Sub(hn::Mul(a_high, b_high), product);
  return {product, hn::Add(hn::Add(rest, corners), hn::Mul(a_low, b_low))};
#endif
}

HWY_INLINE Pair negated(const Pair& a) { return {hn::Neg(a.high), hn::Neg(a.low)}; }

HWY_INLINE Pair sum(const Pair& a, const Pair& b) {
  const Pair s = two_sum(a.high, b.high);
  return quick_two_sum(s.high, hn::Add(s.low, hn::Add(a.low, b.low)));
}

HWY_INLINE Pair difference(const Pair& a, const Pair& b) { return sum(a, negated(b)); }

HWY_INLINE Pair product(const Pair& a, const Pair& b) {
  const Pair p = two_product(a.high, b.high);
  return quick_two_sum(p.high, hn::Add(p.low, hn::MulAdd(a.high, b.low, hn::Mul(a.low, b.high))));
}

HWY_INLINE Pair product(const Pair& a, VD b) {
  const Pair p = two_product(a.high, b);
  return quick_two_sum(p.high, hn::MulAdd(a.low, b, p.low));
}

HWY_INLINE Pair product(VD a, const Pair& b) { return product(b, a); }

HWY_INLINE Pair product_plus(const Pair& a, const Pair& b, const Pair& c) {
  return sum(product(a, b), c);
}
HWY_INLINE Pair product_plus(const Pair& a, VD b, const Pair& c) { return sum(product(a, b), c); }

HWY_INLINE Pair product_minus(const Pair& a, const Pair& b, const Pair& c) {
  return difference(product(a, b), c);
}
HWY_INLINE Pair product_minus(VD a, const Pair& b, const Pair& c) {
  return difference(product(b, a), c);
}

HWY_INLINE Pair quotient(const Pair& a, const Pair& b) {
  const VD first = hn::Div(a.high, b.high);
  const Pair rest = difference(a, product(b, first));
  return quick_two_sum(first, hn::Div(rest.high, b.high));
}

// The five determinants of predicate/determinants.h; Number is a VD or a Pair.
template <class Number>
struct Numbers {
  Number den, u, v, w, t;
};

template <class Number>
HWY_INLINE Numbers<Number> determinants(const V3<Number>& s, const V3<Number>& e1,
                                        const V3<Number>& e2, const V3<VD>& d) {
  const V3<Number> n = cross(e1, e2);
  const V3<Number> r = cross(d, s);
  Numbers<Number> f;
  f.den = dot(n, d);
  f.u = negated(dot(r, e2));
  f.v = dot(r, e1);
  f.t = dot(n, s);
  f.w = difference(difference(f.den, f.u), f.v);
  return f;
}

// predicate/filtered.h in lanes.
struct FilteredLanes {
  Numbers<VD> value;
  VD den_err, uv_err, w_err, t_err;
  hn::Mask<DD> usable;
};

struct HitLanes {
  V3<VD> a, b, c, o, d;

  HitLanes(const HitColumns& hits, std::size_t i) {
    const auto point = [&](std::size_t row) {
      return load_rows(DD{}, &hits.number[row][i], kRoundBatch);
    };
    a = point(0);
    b = point(3);
    c = point(6);
    o = point(9);
    d = point(12);
  }
};

HWY_INLINE FilteredLanes filtered(const HitLanes& hit) {
  const DD d;
  const V3<VD> s = hit.a - hit.o;
  const V3<VD> e1 = hit.b - hit.a;
  const V3<VD> e2 = hit.c - hit.a;
  const VD s_max = max_norm(s), e1_max = max_norm(e1), e2_max = max_norm(e2);
  const VD d_max = max_norm(hit.d);
  FilteredLanes f;
  f.value = determinants(s, e1, e2, hit.d);
  const VD least = hn::Min(hn::Min(s_max, e1_max), hn::Min(e2_max, d_max));
  const VD most = hn::Max(hn::Max(s_max, e1_max), hn::Max(e2_max, d_max));
  f.usable = hn::And(hn::Ge(least, hn::Set(d, bounds::kSmallestMagnitude)),
                     hn::Le(most, hn::Set(d, bounds::kLargestMagnitude)));
  const VD e12 = hn::Mul(e1_max, e2_max);
  f.den_err = hn::Mul(hn::Set(d, bounds::kDenFactor), hn::Mul(e12, d_max));
  f.uv_err = hn::Mul(hn::Set(d, bounds::kUvFactor),
                     hn::Mul(hn::Mul(d_max, s_max), hn::Max(e1_max, e2_max)));
  f.t_err = hn::Mul(hn::Set(d, bounds::kTFactor), hn::Mul(e12, s_max));
  const VD parts =
      hn::Add(hn::Add(hn::Abs(f.value.den), hn::Abs(f.value.u)), hn::Abs(f.value.v));
  const VD own = hn::Mul(hn::Set(d, 2 * bounds::kDoubleUlp), parts);
  f.w_err = hn::Mul(hn::Add(hn::Add(f.den_err, hn::Add(f.uv_err, f.uv_err)), own),
                    hn::Set(d, 1 + 8 * bounds::kDoubleUlp));
  return f;
}

// Rounds lanes i, i + 1, ... of the columns; returns the bits of those that are certain.
HWY_INLINE std::uint32_t round_lanes(const HitLanes&, const FilteredLanes& f, std::size_t i,
                                     RoundedColumns<float>& out) {
  const DD d;
  const hn::Rebind<float, DD> df;
  constexpr double kUlp = bounds::kDoubleUlp;
  const VD inverse = hn::Div(hn::Set(d, 1.0), f.value.den);
  const VD magnitude = hn::Mul(hn::Abs(inverse), hn::Set(d, 1 + 0x1p-18));
  const auto sure = hn::And(f.usable, hn::Gt(hn::Abs(f.value.den), hn::Mul(hn::Set(d, 0x1p20), f.den_err)));
  std::uint32_t bits = bits_of(d, sure);
  const auto round = [&](VD numerator, VD numerator_err, float* to) {
    const VD q = hn::Mul(numerator, inverse);
    const VD size = hn::Abs(q);
    const VD error = hn::MulAdd(hn::MulAdd(size, f.den_err, numerator_err), magnitude,
                                hn::Mul(hn::Set(d, 4 * kUlp), size));
    const auto low = hn::DemoteTo(df, hn::Sub(q, error));
    const auto high = hn::DemoteTo(df, hn::Add(q, error));
    hn::StoreU(low, df, to + i);
    bits &= bits_of(df, hn::And(hn::Eq(low, high), hn::Ne(low, hn::Zero(df))));
  };
  round(f.value.t, f.t_err, out.t);
  round(f.value.u, f.uv_err, out.u);
  round(f.value.v, f.uv_err, out.v);
  round(f.value.w, f.w_err, out.w);
  return bits;
}

HWY_INLINE V3<Pair> exact_difference(const V3<VD>& p, const V3<VD>& q) {
  return {two_sum(p.x, hn::Neg(q.x)), two_sum(p.y, hn::Neg(q.y)), two_sum(p.z, hn::Neg(q.z))};
}

HWY_INLINE std::uint32_t round_lanes(const HitLanes& hit, const FilteredLanes& f, std::size_t i,
                                     RoundedColumns<double>& out) {
  const DD d;
  constexpr double kUlp = bounds::kDoubleUlp;
  constexpr double kFiner = bounds::kDoubleDoubleFactor /
                            std::min({bounds::kDenFactor, bounds::kUvFactor, bounds::kTFactor});
  const VD finer = hn::Set(d, kFiner);
  const Numbers<Pair> value =
      determinants(exact_difference(hit.a, hit.o), exact_difference(hit.b, hit.a),
                   exact_difference(hit.c, hit.a), hit.d);
  const VD den_err = hn::Mul(f.den_err, finer);
  const VD room = hn::Sub(hn::Abs(value.den.high), hn::Add(den_err, den_err));
  std::uint32_t bits = bits_of(
      d, hn::And(f.usable, hn::Gt(hn::Abs(f.value.den), hn::Add(f.den_err, f.den_err))));
  const auto round = [&](const Pair& numerator, VD numerator_err, double* to) {
    const Pair q = quotient(numerator, value.den);
    const VD size = hn::Abs(q.high);
    const VD error = hn::Div(hn::MulAdd(size, den_err, hn::Mul(numerator_err, finer)), room);
    // As in predicate/round.cpp, term by term.
    const VD own = hn::MulAdd(hn::Set(d, 64 * kUlp * kUlp), size,
                              hn::Mul(hn::Set(d, 2 * kUlp), hn::Abs(q.low)));
    const VD all = hn::MulAdd(error, hn::Set(d, 1 + 64 * kUlp), own);
    const VD low = hn::Add(q.high, hn::Sub(q.low, all));
    const VD high = hn::Add(q.high, hn::Add(q.low, all));
    hn::StoreU(low, d, to + i);
    bits &= bits_of(d, hn::Eq(low, high));
  };
  round(value.t, f.t_err, out.t);
  round(value.u, f.uv_err, out.u);
  round(value.v, f.uv_err, out.v);
  round(value.w, f.w_err, out.w);
  return bits;
}

template <class Real>
inline void round_columns(const HitColumns& hits, std::size_t count, RoundedColumns<Real>& out) {
  const DD d;
  out.sure = 0;
  out.front = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const HitLanes lanes(hits, i);
    const FilteredLanes f = filtered(lanes);
    out.front |= bits_of(d, hn::Lt(f.value.den, hn::Zero(d))) << i;
    out.sure |= round_lanes(lanes, f, i, out) << i;
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
