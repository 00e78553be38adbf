// SPDX-License-Identifier: Apache-2.0
//
// One pair of a ray and a triangle, where four doubles fit into a vector: x, y and z of a point are
// its lanes, and the four determinants that are dot products are summed in one go.
#if defined(PIERCE_KERNELS_PAIR_AXES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_PAIR_AXES_INL_H_
#undef PIERCE_KERNELS_PAIR_AXES_INL_H_
#else
#define PIERCE_KERNELS_PAIR_AXES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "kernels/rounding/round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Of x, y and z.
template <class D>
HWY_INLINE bool all_three(D d, hn::Mask<D> mask) {
  return (bits_of(d, mask) & 7) == 7;
}

// As many lanes as are of use for one hit.
using DOne = hn::CappedTag<double, 4>;

// The points of a pair, x, y and z of each in the first three lanes; the fourth means nothing.
template <class D>
struct PairAxes {
  hn::Vec<D> a, b, c, o, d;
};

template <class D>
HWY_INLINE PairAxes<D> pair_axes(D d, const predicate::RayD& ray,
                                 const predicate::TriangleD& triangle) {
  static_assert(sizeof(triangle) == 9 * sizeof(double));
  // A lane too many each, which is in the triangle, or in the ray; but for the last corner.
  alignas(32) static constexpr std::int64_t kNext[4] = {1, 2, 3, 0};
  const auto c = hn::LoadU(d, &triangle.b.z);
  return {hn::LoadU(d, &triangle.a.x), hn::LoadU(d, &triangle.b.x),
          hn::TableLookupLanes(c, hn::SetTableIndices(d, kNext)), hn::LoadU(d, &ray.origin.x),
          hn::LoadU(d, &ray.direction.x)};
}

// Of what lies in memory, of which nothing beyond may be read.
template <class D>
HWY_INLINE PairAxes<D> axes_in_place(D d, const Ray<double>& ray, const Vec3<double>& a,
                                     const Vec3<double>& b, const Vec3<double>& c) {
  const auto first_three = hn::FirstN(d, 3);
  const auto point = [&](const Vec3<double>& p) { return hn::MaskedLoad(first_three, d, &p.x); };
  return {point(a), point(b), point(c), hn::LoadU(d, &ray.origin.x),
          hn::LoadU(d, &ray.direction.x)};
}

// The corner of a copy that begins in this row.
template <class D>
HWY_INLINE hn::Vec<D> copied_corner(D d, const Candidate& candidate, std::size_t row) {
  const hn::Rebind<float, D> df;
  const std::size_t stride = candidate.stride;
  const float* p = candidate.copy + row * stride;
  const auto x_z = hn::InterleaveLower(df, hn::Set(df, p[0]), hn::Set(df, p[2 * stride]));
  return hn::PromoteTo(d, hn::InterleaveLower(df, x_z, hn::Set(df, p[stride])));
}

// Of an exact ray and a triangle's copy, where they are in filter space.
template <class D>
HWY_INLINE PairAxes<D> copied_axes(D d, const FilterRay& ray, const Candidate& candidate) {
  const hn::Rebind<float, D> df;
  return {copied_corner(d, candidate, 0), copied_corner(d, candidate, 3),
          copied_corner(d, candidate, 6), hn::PromoteTo(d, hn::Load(df, ray.origin)),
          hn::PromoteTo(d, hn::Load(df, ray.direction))};
}
// Of a ray in its own coordinates, to which `unscale` takes the copy.
template <class D>
HWY_INLINE PairAxes<D> copied_axes(D d, const Ray<double>& ray, const Candidate& candidate,
                                   double unscale) {
  const auto corner = [&](std::size_t row) {
    return hn::Mul(copied_corner(d, candidate, row), hn::Set(d, unscale));
  };
  return {corner(0), corner(3), corner(6), hn::LoadU(d, &ray.origin.x),
          hn::LoadU(d, &ray.direction.x)};
}

// y, z and x of x, y and z.
template <class D>
HWY_INLINE hn::Vec<D> turned(D d, hn::Vec<D> v) {
  alignas(32) static constexpr std::int64_t kTurn[4] = {1, 2, 0, 3};
  return hn::TableLookupLanes(v, hn::SetTableIndices(d, kTurn));
}
template <class D, TwoParts N>
HWY_INLINE N turned(D d, const N& v) {
  return {turned(d, v.high), turned(d, v.low)};
}

template <class D, class P, class Q>
HWY_INLINE Q cross_of_axes(D d, const P& p, const Q& q) {
  return turned(d, Q(product_minus(p, turned(d, q), product(turned(d, p), q))));
}

template <class N>
struct Rows {
  N x, y, z;
};

// Of four vectors the first lanes, the second and the third.
template <class D>
HWY_INLINE Rows<hn::Vec<D>> rows_of(D d, const hn::Vec<D> (&v)[4]) {
  const auto low01 = hn::InterleaveLower(d, v[0], v[1]);
  const auto low23 = hn::InterleaveLower(d, v[2], v[3]);
  const auto high01 = hn::InterleaveUpper(d, v[0], v[1]);
  const auto high23 = hn::InterleaveUpper(d, v[2], v[3]);
  return {hn::ConcatLowerLower(d, low23, low01), hn::ConcatLowerLower(d, high23, high01),
          hn::ConcatUpperUpper(d, low23, low01)};
}
template <class D, TwoParts N>
HWY_INLINE Rows<N> rows_of(D d, const N (&v)[4]) {
  const auto high = rows_of(d, {v[0].high, v[1].high, v[2].high, v[3].high});
  const auto low = rows_of(d, {v[0].low, v[1].low, v[2].low, v[3].low});
  return {{high.x, low.x}, {high.y, low.y}, {high.z, low.z}};
}

// Lane k in all lanes.
template <int k, class D>
HWY_INLINE hn::Vec<D> all_from(D d, hn::Vec<D> v) {
  return hn::Broadcast<k % 2>(k < 2 ? hn::ConcatLowerLower(d, v, v)
                                    : hn::ConcatUpperUpper(d, v, v));
}
template <int k, class D, TwoParts N>
HWY_INLINE N all_from(D d, const N& v) {
  return {all_from<k>(d, v.high), all_from<k>(d, v.low)};
}

template <class D>
HWY_INLINE hn::Vec<D> with_last(D d, hn::Vec<D> v, hn::Vec<D> last) {
  return hn::IfThenElse(hn::FirstN(d, 3), v, last);
}
template <class D, TwoParts N>
HWY_INLINE N with_last(D d, const N& v, const N& last) {
  return {with_last(d, v.high, last.high), with_last(d, v.low, last.low)};
}

// The five determinants, of which four are to be divided by the one in all lanes.
template <class Number>
struct DividedNumbers {
  Number den, tuvw;
};
template <class V>
HWY_INLINE DividedNumbers<Compensated<V>> normalized(const DividedNumbers<Compensated<V>>& x) {
  return {normalized(x.den), normalized(x.tuvw)};
}

// From S, E1 and E2 and the direction.
template <class D, class Number>
HWY_INLINE DividedNumbers<Number> determinants_of_axes(D d, const Number& s, const Number& e1,
                                                       const Number& e2, hn::Vec<D> direction) {
  const Number n = cross_of_axes(d, e1, e2);
  const Number r = cross_of_axes(d, direction, s);
  const Number products[4] = {product(n, s), negated(Number(product(r, e2))), product(r, e1),
                              product(n, direction)};
  const auto rows = rows_of(d, products);
  const Number dots = sum(rows.x, Number(sum(rows.y, rows.z)));  // t u v den
  const Number den = all_from<3>(d, dots);
  const Number w = difference(Number(difference(den, all_from<1>(d, dots))), all_from<2>(d, dots));
  return {den, with_last(d, dots, w)};
}

// FilteredLanes of one pair: the errors of t, u, v and w a lane each.
template <class D>
struct FilteredAxes {
  DividedNumbers<hn::Vec<D>> value;
  hn::Vec<D> den_err, tuvw_err;
  bool usable;
};

template <class D>
HWY_INLINE FilteredAxes<D> with_errors(D d, hn::Vec<D> s, hn::Vec<D> e1, hn::Vec<D> e2,
                                       hn::Vec<D> direction,
                                       const DividedNumbers<hn::Vec<D>>& value) {
  using VD = hn::Vec<D>;
  FilteredAxes<D> f;
  f.value = value;
  const auto sizes = rows_of(d, {hn::Abs(s), hn::Abs(e1), hn::Abs(e2), hn::Abs(direction)});
  const VD norms = hn::Max(hn::Max(sizes.x, sizes.y), sizes.z);
  const VD s_max = all_from<0>(d, norms), e1_max = all_from<1>(d, norms);
  const VD e2_max = all_from<2>(d, norms), d_max = all_from<3>(d, norms);
  f.usable = bits_of(d, hn::And(hn::Ge(norms, hn::Set(d, bounds::kSmallestMagnitude)),
                                hn::Le(norms, hn::Set(d, bounds::kLargestMagnitude)))) == 15;
  const auto errors = errors_of(d, s_max, e1_max, e2_max, d_max);
  const VD u = all_from<1>(d, f.value.tuvw), v = all_from<2>(d, f.value.tuvw);
  const VD w_err = error_of_w(d, errors, f.value.den, u, v);
  f.den_err = errors.den;
  const VD t_uv = hn::IfThenElse(hn::FirstN(d, 1), errors.t, errors.uv);
  f.tuvw_err = with_last(d, t_uv, w_err);
  return f;
}

template <class D>
HWY_INLINE FilteredAxes<D> filtered(D d, const PairAxes<D>& pair) {
  const auto s = hn::Sub(pair.a, pair.o);
  const auto e1 = hn::Sub(pair.b, pair.a), e2 = hn::Sub(pair.c, pair.a);
  return with_errors(d, s, e1, e2, pair.d, determinants_of_axes(d, s, e1, e2, pair.d));
}

// What a cross product's components may be at most: the sums of its products' sizes.
template <class D>
HWY_INLINE hn::Vec<D> cross_of_sizes(D d, hn::Vec<D> p, hn::Vec<D> q) {
  return turned(d, hn::MulAdd(p, turned(d, q), hn::Mul(turned(d, p), q)));
}

// Takes bounds for those that are made of each number's own products, and W from differences, as U
// and V are. Where coordinates are 0, or all but 0, as of floors and walls, these are much smaller;
// and of a number all of whose products are 0, the bound is 0. False if it cannot.
template <class D>
HWY_INLINE bool bound_by_terms(D d, const PairAxes<D>& pair, FilteredAxes<D>& f) {
  using VD = hn::Vec<D>;
  const VD s = hn::Sub(pair.a, pair.o), s_b = hn::Sub(pair.b, pair.o);
  const VD e1 = hn::Sub(pair.b, pair.a), e2 = hn::Sub(pair.c, pair.a), e3 = hn::Sub(pair.c, pair.b);
  const auto is_seen = [](VD x) HWY_ATTR { return is_not_small(x, bounds::kSmallestComponent); };
  const auto seen =
      hn::And(hn::And(is_seen(s), is_seen(s_b)),
              hn::And(hn::And(is_seen(e1), is_seen(e2)), hn::And(is_seen(e3), is_seen(pair.d))));
  if (!f.usable || !all_three(d, seen)) return false;

  const VD s_size = hn::Abs(s), e1_size = hn::Abs(e1), e2_size = hn::Abs(e2);
  const VD d_size = hn::Abs(pair.d);
  const VD n = cross_of_sizes(d, e1_size, e2_size), r = cross_of_sizes(d, d_size, s_size);
  const VD r_b = cross_of_sizes(d, d_size, hn::Abs(s_b));
  const auto terms = rows_of(
      d, {hn::Mul(n, s_size), hn::Mul(r, e2_size), hn::Mul(r, e1_size), hn::Mul(r_b, hn::Abs(e3))});
  const VD w = hn::Mul(cross_of_axes(d, pair.d, s_b), e3), den = hn::Mul(n, d_size);
  const auto others = rows_of(d, {den, den, w, w});
  const auto sum_of = [](const Rows<VD>& rows)
                          HWY_ATTR { return hn::Add(rows.x, hn::Add(rows.y, rows.z)); };
  const VD more = sum_of(others), factor = hn::Set(d, bounds::kTermwise);
  const VD tuvw_err = hn::Mul(factor, sum_of(terms));
  const auto less = hn::Lt(tuvw_err, f.tuvw_err);
  f.value.tuvw = hn::IfThenElse(less, with_last(d, f.value.tuvw, more), f.value.tuvw);
  f.tuvw_err = hn::IfThenElse(less, tuvw_err, f.tuvw_err);
  f.den_err = hn::Min(hn::Mul(factor, all_from<0>(d, more)), f.den_err);
  return true;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
