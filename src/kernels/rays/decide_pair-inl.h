// SPDX-License-Identifier: Apache-2.0
//
// Whether a ray hits a triangle, in double, and where that is not sure in compensated double: the
// double rung (predicate/certify.h), with x, y and z in lanes. Of scenes of doubles, whose leaves
// have no exact copies, float leaves open what rays start on, or end on; of these double knows
// little more than that they are near.
#if defined(PIERCE_KERNELS_DECIDE_PAIR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_DECIDE_PAIR_INL_H_
#undef PIERCE_KERNELS_DECIDE_PAIR_INL_H_
#else
#define PIERCE_KERNELS_DECIDE_PAIR_INL_H_
#endif

#include <algorithm>
#include <cmath>

#include "kernels/rounding/round_one-inl.h"
#include "predicate/certify.h"
#include "predicate/filtered.h"
#include "support/finite.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

template <class D>
HWY_INLINE predicate::Filtered in_rows(D d, const FilteredAxes<D>& axes) {
  double value[4], err[4];
  hn::StoreU(axes.value.tuvw, d, value);
  hn::StoreU(axes.tuvw_err, d, err);
  return {{hn::GetLane(axes.value.den), value[1], value[2], value[3], value[0]},
          hn::GetLane(axes.den_err),
          std::max(err[1], err[2]),
          err[3],
          err[0],
          axes.usable,
          axes.usable};
}

// By bounds that are made of each number's own terms: of a ray that starts in the plane of a floor
// or wall T is 0, and known to be.
template <class D>
HWY_INLINE predicate::Certified certify_by_terms(D d, const PairAxes<D>& pair, FilteredAxes<D>& f,
                                                 const predicate::RayD& ray,
                                                 predicate::Interval& t) {
  using predicate::Certified;
  if (!bound_by_terms(d, pair, f)) return Certified::Unsure;
  predicate::Filtered rows = in_rows(d, f);
  const bool at_zero = rows.t_err == 0 && rows.value.t == 0 && ray.t_max > 0;
  const Certified answer = predicate::certify_hit(rows, ray, [&](double bound) HWY_ATTR {
    if (bound == 0 && at_zero) return predicate::certified(!ray.open_start);
    return predicate::certify_above(rows, bound);
  });
  if (answer == Certified::Yes) t = predicate::t_interval(rows);
  return answer;
}

// Whether a number that is not sure is 0 as far as double goes: then it may well be 0, and more
// bits would not tell.
HWY_INLINE bool has_zero(const predicate::Filtered& f) {
  const auto& x = f.value;
  return x.den == 0 || x.u == 0 || x.v == 0 || x.w == 0 || x.t == 0;
}

// The same with more bits: high parts and bounds as predicate/fine.h has them, and the low parts of
// what is held against the range.
struct FineFilter {
  predicate::Filtered rough;  // but for its bounds: those of high and low parts together
  double den_low, t_low;

  // The sign of T / den - bound, as predicate::certify_above has it.
  [[nodiscard]] predicate::Certified above(double bound) const {
    if (is_infinite(bound)) return predicate::certified(bound < 0);
    const double den = rough.value.den;
    const double product = bound * den, product_low = std::fma(bound, den, -product);
    const double high = rough.value.t - product, low_product = bound * den_low;
    const double low = (t_low - product_low) - low_product;
    const double difference = std::copysign(1.0, den) * (high + low);
    const double error = rough.t_err + std::fabs(bound) * rough.den_err + bounds::kRangeFloor +
                         0x1p-50 * (std::fabs(high) + std::fabs(low) + std::fabs(low_product));
    if (difference > error) return predicate::Certified::Yes;
    return difference < -error ? predicate::Certified::No : predicate::Certified::Unsure;
  }

  [[nodiscard]] predicate::Certified certify(const predicate::RayD& ray) const {
    return predicate::certify_hit(rough, ray,
                                  [this](double bound) HWY_ATTR { return above(bound); });
  }

  // Holds the t of a hit: of the high parts, whose low ones are at most half of what is added.
  [[nodiscard]] predicate::Interval t() const {
    predicate::Filtered f = rough;
    f.den_err += 0x1p-52 * std::fabs(f.value.den);
    f.t_err += 0x1p-52 * std::fabs(f.value.t);
    return predicate::t_interval(f);
  }
};

template <class D>
HWY_INLINE FineFilter filter_finely(D d, const PairAxes<D>& pair) {
  const auto s = two_sum(pair.a, hn::Neg(pair.o));
  const auto e1 = two_sum(pair.b, hn::Neg(pair.a)), e2 = two_sum(pair.c, hn::Neg(pair.a));
  const auto fine = normalized(determinants_of_axes(d, s, e1, e2, pair.d));
  FineFilter f{
      in_rows(d, with_errors(d, s.high, e1.high, e2.high, pair.d, {fine.den.high, fine.tuvw.high})),
      hn::GetLane(fine.den.low), hn::GetLane(fine.tuvw.low)};
  constexpr double kFine = bounds::kFiner * (1 + 0x1p-50);
  f.rough.den_err *= kFine;
  f.rough.t_err *= kFine;
  f.rough.uv_err *= kFine;
  f.rough.w_err *= kFine;
  return f;
}

// Fills an interval that holds the t of a hit.
inline predicate::Certified decide_pair(const predicate::RayD& ray,
                                        const predicate::TriangleD& triangle,
                                        predicate::Interval& t) {
  const DOne d;
  if constexpr (hn::MaxLanes(d) == 4) {
    const auto pair = pair_axes(d, ray, triangle);
    auto axes = filtered(d, pair);
    const predicate::Filtered f = in_rows(d, axes);
    predicate::Certified answer = predicate::certify_hit(f, ray);
    if (answer == predicate::Certified::Yes) t = predicate::t_interval(f);
    if (answer != predicate::Certified::Unsure || !f.usable) return answer;
    answer = certify_by_terms(d, pair, axes, ray, t);
    if (answer != predicate::Certified::Unsure || has_zero(f)) return answer;
    const FineFilter fine = filter_finely(d, pair);
    t = fine.t();
    return fine.certify(ray);
  } else {
    return predicate::Certified::Unsure;
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
