// SPDX-License-Identifier: Apache-2.0
//
// Correct rounding of one hit: what round-inl.h does for many, for one as fast as can be. Where
// four doubles fit into a vector, its four numbers are divided in one go (pair_axes-inl.h); where
// two do, two numbers share a division.
#if defined(PIERCE_KERNELS_ROUND_ONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROUND_ONE_INL_H_
#undef PIERCE_KERNELS_ROUND_ONE_INL_H_
#else
#define PIERCE_KERNELS_ROUND_ONE_INL_H_
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/rounding/pair_axes-inl.h"
#include "kernels/rounding/round-inl.h"
#include "predicate/axis_signs.h"
#include "predicate/round.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Whether all numbers of a hit are certain: those of the bits t, u, v, w, and the weights that are
// known to be 0, which it sets.
template <class Real>
HWY_INLINE bool all_certain(std::uint32_t bits, std::uint8_t zeros, Hit<Real>& hit) {
  if (zeros == 0) return bits == 15;
  if ((zeros & predicate::kZeroU) != 0) hit.u = 0;
  if ((zeros & predicate::kZeroV) != 0) hit.v = 0;
  if ((zeros & predicate::kZeroW) != 0) hit.w = 0;
  static_assert(predicate::kZeroU == 1 && predicate::kZeroV == 2 && predicate::kZeroW == 4);
  return (bits | std::uint32_t{zeros} << 1) == 15;
}

// t, u, v and w of the quotients, and the facing. Upper ends only if `high` is not null.
// `certain`: of which it is certain, as bits.
template <class D, class Den, class Number, class Real>
HWY_INLINE Rounded round_axes(D d, const Den& den, const DividedNumbers<Number>& value,
                              const FilteredAxes<D>& f, Hit<Real>& hit, Hit<Real>* high,
                              std::uint8_t zeros, std::uint32_t& certain) {
  static_assert(offsetof(Hit<Real>, u) == sizeof(Real) &&
                offsetof(Hit<Real>, w) == 3 * sizeof(Real));
  certain = den.round(value.tuvw, f.tuvw_err, &hit.t, high == nullptr ? nullptr : &high->t);
  hit.facing = hn::GetLane(f.value.den) < 0 ? Facing::Front : Facing::Back;
  if (!f.usable || bits_of(d, den.clear) != 15) return Rounded::None;
  return all_certain(certain, zeros, hit) ? Rounded::All : Rounded::Ends;
}
template <class D, class Den, class Number, class Real>
HWY_INLINE Rounded round_axes(D d, const Den& den, const DividedNumbers<Number>& value,
                              const FilteredAxes<D>& f, Hit<Real>& hit, Hit<Real>* high,
                              std::uint8_t zeros) {
  std::uint32_t certain = 0;
  return round_axes(d, den, value, f, hit, high, zeros, certain);
}

// In two lanes a pair is twice, until two numbers share a division.
template <class V>
HWY_INLINE V two(V a, V b) {
  return hn::InterleaveLower(hn::DFromV<V>(), a, b);
}
template <class V>
HWY_INLINE Compensated<V> two(const Compensated<V>& a, const Compensated<V>& b) {
  return {two(a.high, b.high), two(a.low, b.low)};
}

// As round_axes; `value` has the determinants, `t_err` the error of that of t.
template <class D, class Real, class Den, class Number>
HWY_INLINE Rounded round_two_by_two(const FilteredLanes<D>& f, const Den& den,
                                    const Numbers<Number>& value, hn::Vec<D> t_err, Hit<Real>& hit,
                                    Hit<Real>* high, std::uint8_t zeros) {
  Real numbers[4], ends[4];
  const std::uint32_t bits =
      den.round(two(value.t, value.u), two(t_err, f.uv_err), numbers, ends) |
      den.round(two(value.v, value.w), two(f.uv_err, f.w_err), numbers + 2, ends + 2) << 2;
  const auto set = [](Hit<Real>& to, const Real(&from)[4]) {
    to.t = from[0];
    to.u = from[1];
    to.v = from[2];
    to.w = from[3];
  };
  set(hit, numbers);
  if (high != nullptr) set(*high, ends);
  hit.facing = hn::GetLane(f.value.den) < 0 ? Facing::Front : Facing::Back;
  if (bits_of(D(), f.usable) == 0 || bits_of(D(), den.clear) != 3) return Rounded::None;
  return all_certain(bits, zeros, hit) ? Rounded::All : Rounded::Ends;
}

// t of a triangle across an axis along which the ray moves. Rays that start on floors and walls
// have t = 0, of which lanes are never certain.
template <class D>
HWY_NOINLINE bool round_across(D d, const PairAxes<D>& pair, double& t) {
  const auto point = [&](hn::Vec<D> p) HWY_ATTR {
    double lanes[4];
    hn::StoreU(p, d, lanes);
    return Vec3<double>{lanes[0], lanes[1], lanes[2]};
  };
  const auto rounded = predicate::round_across_axis<double>(
      {point(pair.o), point(pair.d)}, {point(pair.a), point(pair.b), point(pair.c)});
  if (rounded) t = *rounded;
  return rounded.has_value();
}

template <class D>
HWY_INLINE Rounded round_fine_axes(D d, const PairAxes<D>& axes, Hit<double>& hit,
                                   Hit<double>* high = nullptr, std::uint8_t zeros = 0) {
  const auto s = two_sum(axes.a, hn::Neg(axes.o));
  const auto e1 = two_sum(axes.b, hn::Neg(axes.a)), e2 = two_sum(axes.c, hn::Neg(axes.a));
  const auto fine = normalized(determinants_of_axes(d, s, e1, e2, axes.d));
  const auto f = with_errors(d, s.high, e1.high, e2.high, axes.d, {fine.den.high, fine.tuvw.high});
  std::uint32_t certain = 0;
  const Rounded rounded =
      round_axes(d, FineDenominator<D>(fine.den, f.den_err), fine, f, hit, high, zeros, certain);
  if (rounded == Rounded::Ends && (certain & 1) == 0) [[unlikely]] {
    if (double t = 0; round_across(d, axes, t)) {
      hit.t = t;
      if (high != nullptr) high->t = t;
      if (all_certain(certain | 1, zeros, hit)) return Rounded::All;
    }
  }
  return rounded;
}

template <class D, class Real>
HWY_INLINE Rounded round_pair(D d, const predicate::RayD& ray, const predicate::TriangleD& triangle,
                              Hit<Real>& hit, Hit<Real>* high = nullptr, std::uint8_t zeros = 0) {
  constexpr bool kCoarse = std::is_same_v<Real, float>;
  if constexpr (hn::MaxLanes(d) == 4) {
    const auto axes = pair_axes(d, ray, triangle);
    if constexpr (kCoarse) {
      const auto f = filtered(d, axes);
      return round_axes(d, Denominator<D>(f.value.den, f.den_err), f.value, f, hit, high, zeros);
    } else {
      return round_fine_axes(d, axes, hit, high, zeros);
    }
  } else {
    const auto lanes = hit_lanes(d, ray, triangle);
    if constexpr (kCoarse) {
      const auto f = filtered(lanes);
      const Denominator<D> den(f.value.den, f.den_err);
      return round_two_by_two(f, den, f.value, f.t_err, hit, high, zeros);
    } else {
      const auto f = fine(lanes);
      const FineDenominator<D> den(f.value.den, f.rough.den_err);
      return round_two_by_two(f.rough, den, f.value, f.rough.t_err, hit, high, zeros);
    }
  }
}

// t, u, v and w; t as tracked_place has it.
template <class D, class Number>
HWY_INLINE RoundedQuotient<D> tracked_quotients(D d, const Number& s, const Number& e1,
                                                const Number& e2, hn::Vec<D> direction,
                                                const DividedNumbers<Number>& value) {
  const auto zero = hn::Zero(d);
  const std::uint32_t across =
      bits_of(d, hn::And(hn::Eq(e1.high, zero), hn::Eq(e2.high, zero))) & 7;
  if (across == 0) return {value.tuvw, value.den};
  double way[4], lost[4], speed[4];
  hn::StoreU(s.high, d, way);
  hn::StoreU(s.low, d, lost);
  hn::StoreU(direction, d, speed);
  const int axis = std::countr_zero(across);
  const auto first = hn::FirstN(d, 1);
  const auto with_first = [&](const Number& number, double high, double low) {
    return Number{hn::IfThenElse(first, hn::Set(d, high), number.high),
                  hn::IfThenElse(first, hn::Set(d, low), number.low)};
  };
  return {with_first(value.tuvw, way[axis], lost[axis]), with_first(value.den, speed[axis], 0)};
}

template <class D>
HWY_INLINE bool round_axes_quotients(D d, const PairAxes<D>& pair, std::uint8_t zeros,
                                     Hit<float>& hit) {
  const auto s = tracked_difference(pair.a, pair.o);
  const auto e1 = tracked_difference(pair.b, pair.a), e2 = tracked_difference(pair.c, pair.a);
  const auto all_seen = hn::And(hn::And(is_not_small(s.high), is_not_small(pair.d)),
                                hn::And(is_not_small(e1.high), is_not_small(e2.high)));
  if ((bits_of(d, all_seen) & 7) != 7) return false;
  const auto value = determinants_of_axes(d, s, e1, e2, pair.d);
  const auto f =
      with_errors(d, s.high, e1.high, e2.high, pair.d, {value.den.high, value.tuvw.high});
  const Denominator<D> den(f.value.den, f.den_err);
  if (!f.usable || bits_of(d, den.clear) != 15) return false;
  const RoundedQuotient<D> quotient = tracked_quotients(d, s, e1, e2, pair.d, value);
  const std::uint32_t known = bits_of(d, quotient.sure);
  const std::uint32_t certain = den.round(f.value.tuvw, f.tuvw_err, &hit.t);
  const hn::Rebind<float, D> df;
  hn::StoreU(hn::IfThenElse(mask_of(df, known), quotient.value, hn::LoadU(df, &hit.t)), df, &hit.t);
  hit.facing = hn::GetLane(f.value.den) < 0 ? Facing::Front : Facing::Back;
  return all_certain(known | certain, zeros, hit);
}

// A pair of which ends do not agree: its numbers may be quotients of doubles.
inline bool round_quotients(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                            std::uint8_t zeros, Hit<float>& hit) {
  const DOne d;
  if constexpr (hn::MaxLanes(d) == 4) {
    const auto pair = pair_axes(d, ray, triangle);
    const auto f = filtered(d, pair);
    // Small weights, of which double knows little, are no ties.
    const auto& tuvw = f.value.tuvw;
    const auto like_ties =
        hn::Or(has_bits_to_spare(d, tuvw, f.tuvw_err), hn::Eq(tuvw, hn::Zero(d)));
    return (bits_of(d, has_bits_to_spare(d, f.value.den, f.den_err)) & 1) != 0 &&
           bits_of(d, like_ties) == 15 && round_axes_quotients(d, pair, zeros, hit);
  } else {
    const auto lanes = hit_lanes(d, ray, triangle);
    const auto f = filtered(lanes);
    if ((bits_of(d, has_bits_to_spare(d, f.value.den, f.den_err)) & 1) == 0) return false;
    RoundedColumns<float> out;
    out.bounded = 0;
    round_lanes<true>(f, 0, out);
    if ((round_quotients(lanes, 0, out) & 1) == 0) return false;
    hit.t = out.t[0];
    hit.u = out.u[0];
    hit.v = out.v[0];
    hit.w = out.w[0];
    hit.facing = hn::GetLane(f.value.den) < 0 ? Facing::Front : Facing::Back;
    return true;
  }
}

// By way of double: where den is small, as of rays that all but lie in the plane, double arithmetic
// has no bits to spare.
inline bool round_finely(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                         std::uint8_t zeros, Hit<float>& hit) {
  if (round_quotients(ray, triangle, zeros, hit)) return true;
  Hit<double> finer;
  Hit<double>* const no_ends = nullptr;
  return round_pair(DOne(), ray, triangle, finer, no_ends, zeros) == Rounded::All &&
         predicate::round_again(finer, hit);
}

template <class Real>
inline Rounded round_one(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                         std::uint8_t zeros, Hit<Real>& low, Hit<Real>& high) {
  const Rounded rounded = round_pair(DOne(), ray, triangle, low, &high, zeros);
  if (rounded == Rounded::All) [[likely]]
    return rounded;
  if constexpr (std::is_same_v<Real, float>) {
    if (Hit<float> finer; round_finely(ray, triangle, zeros, finer)) {
      low = finer;
      return Rounded::All;
    }
  }
  return rounded;
}

inline bool round_in_place(const Ray<double>& ray, const Vec3<double>& a, const Vec3<double>& b,
                           const Vec3<double>& c, Hit<double>& hit) {
  const DOne d;
  if constexpr (hn::MaxLanes(d) == 4) {
    return round_fine_axes(d, axes_in_place(d, ray, a, b, c), hit) == Rounded::All;
  } else {
    return round_pair(d, predicate::to_double(ray, Range::Closed), {a, b, c}, hit) == Rounded::All;
  }
}

inline bool round_unscaled(const Ray<double>& ray, const Candidate& candidate, double unscale,
                           Hit<double>& hit) {
  const DOne d;
  if constexpr (hn::MaxLanes(d) == 4) {
    return round_fine_axes(d, copied_axes(d, ray, candidate, unscale), hit) == Rounded::All;
  } else {
    const auto corner = [&](int k) {
      const Vec3<float> p = candidate.corner(k);
      return Vec3<double>{static_cast<double>(p.x) * unscale, static_cast<double>(p.y) * unscale,
                          static_cast<double>(p.z) * unscale};
    };
    return round_pair(d, predicate::to_double(ray, Range::Closed),
                      {corner(0), corner(1), corner(2)}, hit) == Rounded::All;
  }
}

template <class D>
HWY_INLINE bool round_copy(D d, const FilterRay& ray, const Candidate& candidate, Hit<float>& hit) {
  const auto to_t = hn::Set(d, 1 / ray.tau_scale);
  if constexpr (hn::MaxLanes(d) == 4) {
    auto f = filtered(d, copied_axes(d, ray, candidate));
    const auto factors = hn::IfThenElse(hn::FirstN(d, 1), to_t, hn::Set(d, 1.0));
    f.value.tuvw = hn::Mul(f.value.tuvw, factors);
    f.tuvw_err = hn::Mul(f.tuvw_err, factors);
    f.usable = true;
    const Denominator<D> den(f.value.den, f.den_err);
    return round_axes(d, den, f.value, f, hit, static_cast<Hit<float>*>(nullptr), 0) ==
           Rounded::All;
  } else {
    auto f = filtered(copied_lanes(d, ray, candidate));
    f.value.t = hn::Mul(f.value.t, to_t);
    f.t_err = hn::Mul(f.t_err, to_t);
    const Denominator<D> den(f.value.den, f.den_err);
    f.usable = hn::FirstN(d, hn::Lanes(d));
    return round_two_by_two(f, den, f.value, f.t_err, hit, static_cast<Hit<float>*>(nullptr), 0) ==
           Rounded::All;
  }
}

// One hit of an exact ray (of a float scene) from the triangle's copy, if float was certain of it:
// nothing was rounded on the way to filter space, so t is tau but for a power of two, and u, v, w
// are the same there. Certainty keeps the ray's origin so far from the triangle's corner that
// neither the window of the double rung needs a test, nor does it matter that subnormal components
// were rounded after all (docs/algorithm.md, "Rounding").
inline bool round_copy(const FilterRay& ray, const Candidate& candidate, Hit<float>& hit) {
  return round_copy(DOne(), ray, candidate, hit);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
