// SPDX-License-Identifier: Apache-2.0
//
// Correct rounding of many hits at a time: predicate/round.cpp in lanes, double lanes for float
// scenes and lanes of compensated doubles for double scenes. Same bounds (fused products round less
// often than the bounds allow); what is not certain is left to it.
#if defined(PIERCE_KERNELS_ROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROUND_INL_H_
#undef PIERCE_KERNELS_ROUND_INL_H_
#else
#define PIERCE_KERNELS_ROUND_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/kernel.h"
#include "kernels/rounding/compensated-inl.h"
#include "kernels/rounding/hit_lanes-inl.h"
#include "kernels/rounding/tracked-inl.h"
#include "kernels/vectors-inl.h"
#include "predicate/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// How far the determinants in double may be off, by the sizes of S, E1, E2 and d.
template <class D>
struct DeterminantErrors {
  hn::Vec<D> den, uv, t;
};

template <class D>
HWY_INLINE DeterminantErrors<D> errors_of(D d, hn::Vec<D> s, hn::Vec<D> e1, hn::Vec<D> e2,
                                          hn::Vec<D> direction) {
  const auto e12 = hn::Mul(e1, e2);
  return {hn::Mul(hn::Set(d, bounds::kDenFactor), hn::Mul(e12, direction)),
          hn::Mul(hn::Set(d, bounds::kUvFactor), hn::Mul(hn::Mul(direction, s), hn::Max(e1, e2))),
          hn::Mul(hn::Set(d, bounds::kTFactor), hn::Mul(e12, s))};
}

// The same of w, from den, u and v.
template <class D>
HWY_INLINE hn::Vec<D> error_of_w(D d, const DeterminantErrors<D>& errors, hn::Vec<D> den,
                                 hn::Vec<D> u, hn::Vec<D> v) {
  const auto parts = hn::Add(hn::Add(hn::Abs(den), hn::Abs(u)), hn::Abs(v));
  const auto own = hn::Mul(hn::Set(d, bounds::kWFactor), parts);
  return hn::Add(hn::Add(errors.den, hn::Add(errors.uv, errors.uv)), own);
}

// predicate/filtered.h in lanes.
template <class D>
struct FilteredLanes {
  using VD = hn::Vec<D>;
  Numbers<VD> value;
  VD den_err, uv_err, w_err, t_err;
  hn::Mask<D> usable;
};

// What is known of determinants, to within what double arithmetic may lose, of these vectors.
template <class D>
HWY_INLINE FilteredLanes<D> with_errors(const V3<hn::Vec<D>>& s, const V3<hn::Vec<D>>& e1,
                                        const V3<hn::Vec<D>>& e2, const V3<hn::Vec<D>>& direction,
                                        const Numbers<hn::Vec<D>>& value) {
  const D d;
  using VD = hn::Vec<D>;
  const VD s_max = max_norm(s), e1_max = max_norm(e1), e2_max = max_norm(e2);
  const VD d_max = max_norm(direction);
  FilteredLanes<D> f;
  f.value = value;
  const VD least = hn::Min(hn::Min(s_max, e1_max), hn::Min(e2_max, d_max));
  const VD most = hn::Max(hn::Max(s_max, e1_max), hn::Max(e2_max, d_max));
  f.usable = hn::And(hn::Ge(least, hn::Set(d, bounds::kSmallestMagnitude)),
                     hn::Le(most, hn::Set(d, bounds::kLargestMagnitude)));
  const auto errors = errors_of(d, s_max, e1_max, e2_max, d_max);
  f.den_err = errors.den;
  f.uv_err = errors.uv;
  f.t_err = errors.t;
  f.w_err = error_of_w(d, errors, f.value.den, f.value.u, f.value.v);
  return f;
}

template <class D>
HWY_INLINE FilteredLanes<D> filtered(const HitLanes<D>& hit) {
  const auto s = hit.a - hit.o, e1 = hit.b - hit.a, e2 = hit.c - hit.a;
  return with_errors<D>(s, e1, e2, hit.d, determinants(s, e1, e2, hit.d));
}

template <class V>
struct Ends {
  V low, high;
};

// Whether all of an interval rounds alike, and not to zero, whose sign has to be +.
template <class D>
HWY_INLINE hn::Mask<D> ends_agree(D df, hn::Vec<D> low, hn::Vec<D> high) {
  return hn::And(hn::Eq(low, high), hn::Ne(low, hn::Zero(df)));
}

// numerator / den to float, both known to within their errors.
template <class D>
struct Denominator {
  hn::Vec<D> inverse, magnitude, err;
  hn::Mask<D> clear;  // far enough from 0

  HWY_INLINE Denominator(hn::Vec<D> den, hn::Vec<D> den_err) : err(den_err) {
    const D d;
    inverse = hn::Div(hn::Set(d, 1.0), den);
    magnitude = hn::Mul(hn::Abs(inverse), hn::Set(d, bounds::kQuotientRoom));
    clear = hn::Gt(hn::Abs(den), hn::Mul(hn::Set(d, bounds::kQuotientClear), den_err));
  }

  // Of an interval that holds numerator / den.
  HWY_INLINE Ends<hn::Vec<D>> ends(hn::Vec<D> numerator, hn::Vec<D> numerator_err) const {
    const D d;
    const auto q = hn::Mul(numerator, inverse);
    const auto size = hn::Abs(q);
    const auto error = hn::MulAdd(hn::MulAdd(size, err, numerator_err), magnitude,
                                  hn::Mul(hn::Set(d, bounds::kQuotientFactor), size));
    return {hn::Sub(q, error), hn::Add(q, error)};
  }

  // Stores what the ends of lanes round to (the upper ones only if `high_to` is not null); returns
  // the bits of those that are certain.
  static HWY_INLINE std::uint32_t round(const Ends<hn::Vec<D>>& ends, float* to, float* high_to) {
    const hn::Rebind<float, D> df;
    const auto low = hn::DemoteTo(df, ends.low);
    const auto high = hn::DemoteTo(df, ends.high);
    hn::StoreU(low, df, to);
    if (high_to != nullptr) hn::StoreU(high, df, high_to);
    return bits_of(df, ends_agree(df, low, high));
  }

  HWY_INLINE std::uint32_t round(hn::Vec<D> numerator, hn::Vec<D> numerator_err, float* to,
                                 float* high_to = nullptr) const {
    return round(ends(numerator, numerator_err), to, high_to);
  }
};

// Rounds lanes i, i + 1, ... of the columns; returns the bits of those that are certain. kBounded:
// fills all of the columns.
template <bool kBounded, class D>
HWY_INLINE std::uint32_t round_lanes(const FilteredLanes<D>& f, std::size_t i,
                                     RoundedColumns<float>& out) {
  const Denominator<D> den(f.value.den, f.den_err);
  std::uint32_t bits = bits_of(D(), hn::And(f.usable, den.clear));
  if constexpr (kBounded) {
    const D d;
    const auto t = den.ends(f.value.t, f.t_err);
    out.bounded |= bits << i;
    hn::StoreU(t.low, d, out.t_from + i);
    hn::StoreU(t.high, d, out.t_to + i);
    bits &= den.round(t, out.t + i, out.t_high + i);
    bits &= den.round(f.value.u, f.uv_err, out.u + i, out.u_high + i);
    bits &= den.round(f.value.v, f.uv_err, out.v + i, out.v_high + i);
    bits &= den.round(f.value.w, f.w_err, out.w + i, out.w_high + i);
  } else {
    bits &= den.round(f.value.t, f.t_err, out.t + i);
    bits &= den.round(f.value.u, f.uv_err, out.u + i);
    bits &= den.round(f.value.v, f.uv_err, out.v + i);
    bits &= den.round(f.value.w, f.w_err, out.w + i);
  }
  return bits;
}

// Whether double knows den so well that a quotient which is not certain is hardly one by chance.
template <class D>
HWY_INLINE hn::Mask<D> has_bits_to_spare(D d, hn::Vec<D> den, hn::Vec<D> den_err) {
  return hn::Ge(hn::Mul(hn::Abs(den), hn::Set(d, 0x1p-36)), den_err);
}

// Of lanes i, i + 1, ..., whose ends do not all agree: the numbers that are quotients of doubles.
// Returns the bits of those of which all is certain now.
template <class D>
HWY_NOINLINE std::uint32_t round_quotients(const HitLanes<D>& hit, std::size_t i,
                                           RoundedColumns<float>& out) {
  const D d;
  const hn::Rebind<float, D> df;
  using Number = Tracked<hn::Vec<D>>;
  const auto s = tracked_difference(hit.a, hit.o);
  const auto e1 = tracked_difference(hit.b, hit.a), e2 = tracked_difference(hit.c, hit.a);
  const Numbers<Number> value = determinants(s, e1, e2, hit.d);
  const auto all_seen = hn::And(hn::And(is_not_small(highs(s)), is_not_small(hit.d)),
                                hn::And(is_not_small(highs(e1)), is_not_small(highs(e2))));
  std::uint32_t bits = out.bounded >> i;
  const auto round = [&](const Number& number, const Number& den, float* low_at, float* high_at) {
    const RoundedQuotient<D> quotient(number, den);
    const std::uint32_t known = bits_of(d, hn::And(quotient.sure, all_seen));
    const auto low = hn::LoadU(df, low_at), high = hn::LoadU(df, high_at);
    const auto choice = mask_of(df, known);
    hn::StoreU(hn::IfThenElse(choice, quotient.value, low), df, low_at);
    hn::StoreU(hn::IfThenElse(choice, quotient.value, high), df, high_at);
    bits &= known | bits_of(df, ends_agree(df, low, high));
  };
  const auto t = tracked_place(s, e1, e2, hit.d, value);
  round(t.numerator, t.den, out.t + i, out.t_high + i);
  round(value.u, value.den, out.u + i, out.u_high + i);
  round(value.v, value.den, out.v + i, out.v_high + i);
  round(value.w, value.den, out.w + i, out.w_high + i);
  return bits;
}

template <class V>
HWY_INLINE V3<Compensated<V>> exact_difference(const V3<V>& p, const V3<V>& q) {
  return {two_sum(p.x, hn::Neg(q.x)), two_sum(p.y, hn::Neg(q.y)), two_sum(p.z, hn::Neg(q.z))};
}

// The same to double, of compensated determinants.
template <class D>
struct FineDenominator {
  using VD = hn::Vec<D>;
  Compensated<VD> den;
  VD err, inverse, inverse_room;
  hn::Mask<D> clear;

  // `rough_err`: what the same in double may be off by.
  HWY_INLINE FineDenominator(const Compensated<VD>& fine, VD rough_err) : den(fine) {
    const D d;
    err = hn::Mul(rough_err, hn::Set(d, bounds::kFiner));
    inverse = hn::Div(hn::Set(d, 1.0), den.high);
    inverse_room = hn::Div(hn::Set(d, 1.0), hn::Sub(hn::Abs(den.high), hn::Add(err, err)));
    clear = hn::Gt(hn::Abs(den.high), hn::Add(rough_err, rough_err));
  }

  // `numerator_err`: of the determinant in double.
  HWY_INLINE std::uint32_t round(const Compensated<VD>& numerator, VD numerator_err, double* to,
                                 double* high_to = nullptr) const {
    const D d;
    const Compensated<VD> q = quotient(numerator, den, inverse);
    const VD size = hn::Abs(q.high);
    const VD fine_err = hn::Mul(numerator_err, hn::Set(d, bounds::kFiner));
    const VD error = hn::Mul(hn::MulAdd(size, err, fine_err), inverse_room);
    // As in predicate/round.cpp, term by term.
    const VD own = hn::MulAdd(hn::Set(d, bounds::kFineQuotientFactor), size,
                              hn::Mul(hn::Set(d, bounds::kFineEnds), hn::Abs(q.low)));
    const VD all = hn::Add(error, own);
    const VD low = hn::Add(q.high, hn::Sub(q.low, all));
    const VD high = hn::Add(q.high, hn::Add(q.low, all));
    hn::StoreU(low, d, to);
    if (high_to != nullptr) hn::StoreU(high, d, high_to);
    return bits_of(d, hn::Eq(low, high));
  }
};

// The compensated determinants, and what is known of their high parts.
template <class D>
struct FineLanes {
  Numbers<Compensated<hn::Vec<D>>> value;
  FilteredLanes<D> rough;
};

template <class D>
HWY_INLINE FineLanes<D> fine(const HitLanes<D>& hit) {
  const auto s = exact_difference(hit.a, hit.o);
  const auto e1 = exact_difference(hit.b, hit.a), e2 = exact_difference(hit.c, hit.a);
  FineLanes<D> f;
  const auto value = determinants(s, e1, e2, hit.d);
  f.value = {normalized(value.den), normalized(value.u), normalized(value.v), normalized(value.w),
             normalized(value.t)};
  f.rough = with_errors<D>(
      highs(s), highs(e1), highs(e2), hit.d,
      {f.value.den.high, f.value.u.high, f.value.v.high, f.value.w.high, f.value.t.high});
  return f;
}

template <class D>
HWY_INLINE std::uint32_t round_lanes(const FineLanes<D>& f, std::size_t i,
                                     RoundedColumns<double>& out) {
  const FineDenominator<D> den(f.value.den, f.rough.den_err);
  std::uint32_t bits = bits_of(D(), hn::And(f.rough.usable, den.clear));
  out.bounded |= bits << i;
  bits &= den.round(f.value.t, f.rough.t_err, out.t + i, out.t_high + i);
  bits &= den.round(f.value.u, f.rough.uv_err, out.u + i, out.u_high + i);
  bits &= den.round(f.value.v, f.rough.uv_err, out.v + i, out.v_high + i);
  bits &= den.round(f.value.w, f.rough.w_err, out.w + i, out.w_high + i);
  return bits;
}

template <class Real>
inline void round_columns(const HitColumns& hits, std::size_t count, RoundedColumns<Real>& out) {
  const hn::CappedTag<double, kRoundStep> d;
  const auto front = [&](auto den) { return bits_of(d, hn::Lt(den, hn::Zero(d))); };
  out.sure = out.front = out.bounded = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto lanes = load_hits(d, hits, i);
    if constexpr (std::is_same_v<Real, float>) {
      const auto f = filtered(lanes);
      out.front |= front(f.value.den) << i;
      std::uint32_t sure = round_lanes<true>(f, i, out);
      const auto used = static_cast<unsigned>(std::min(count - i, hn::Lanes(d)));
      const std::uint32_t left = ~sure & ((1U << used) - 1);
      if (left != 0) [[unlikely]] {
        if ((left & bits_of(d, has_bits_to_spare(d, f.value.den, f.den_err))) != 0)
          sure = round_quotients(lanes, i, out);
      }
      out.sure |= sure << i;
    } else {
      const auto f = fine(lanes);
      out.front |= front(f.value.den.high) << i;
      out.sure |= round_lanes(f, i, out) << i;
    }
  }
}

// Hits of exact rays from their triangles' copies, a hit a lane (round_one-inl.h, round_copy), into
// lanes i, i + 1, ... of the columns; t is tau times `to_t`.
template <class D>
HWY_INLINE void round_copies(const HitLanes<D>& hits, double to_t, std::size_t i,
                             RoundedColumns<float>& out) {
  const D d;
  auto f = filtered(hits);
  f.value.t = hn::Mul(f.value.t, hn::Set(d, to_t));
  f.t_err = hn::Mul(f.t_err, hn::Set(d, to_t));
  f.usable = hn::FirstN(d, hn::Lanes(d));
  out.front |= bits_of(d, hn::Lt(f.value.den, hn::Zero(d))) << i;
  out.sure |= round_lanes<false>(f, i, out) << i;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
