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

#include <cstddef>
#include <cstdint>

#include "kernels/rays/cull-inl.h"
#include "kernels/rounding/round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// What double says of some lanes, a bit each.
struct DoubleAnswer {
  std::uint32_t missed = 0;   // surely no hit
  std::uint32_t certain = 0;  // surely a hit, with tau within the interval that was stored
};

// As FilterRay has them.
template <class V>
struct RangeLanes {
  V tau_min, tau_max, tau_first, tau_last;
};

// Of pairs of an exact ray and a copy. Stores intervals of tau, of meaning where a hit is certain.
// docs/algorithm.md, "The cull once more, in double".
template <class D>
HWY_INLINE DoubleAnswer double_cull_lanes(D d, const HitLanes<D>& hit,
                                          const RangeLanes<hn::Vec<D>>& range, Sides sides,
                                          float* low, float* high) {
  const hn::Rebind<float, D> df;
  const auto f = filtered(hit);
  const auto usable =
      hn::And(f.usable, hn::Ge(max_norm(hit.a - hit.o), hn::Set(d, bounds::kSubnormalsAreNothing)));

  const auto sign = sign_of_side(d, f.value.den, sides);
  const auto den = hn::Xor(f.value.den, sign);
  const auto uv = hn::Min(hn::Xor(f.value.u, sign), hn::Xor(f.value.v, sign));
  const auto w = hn::Xor(f.value.w, sign);
  const auto known = hn::Gt(hn::Abs(den), f.den_err);
  const auto outside = hn::Or(hn::Lt(uv, hn::Neg(f.uv_err)), hn::Lt(w, hn::Neg(f.w_err)));
  const auto other_side = hn::Lt(den, hn::Zero(d));

  const Denominator<D> denominator(f.value.den, f.den_err);
  const auto tau = denominator.ends(f.value.t, f.t_err);
  const auto beyond = hn::And(
      denominator.clear, hn::Or(hn::Lt(tau.high, range.tau_min), hn::Gt(tau.low, range.tau_max)));
  DoubleAnswer answer;
  answer.missed =
      bits_of(d, hn::And(usable, hn::Or(hn::And(known, hn::Or(outside, other_side)), beyond)));

  // Outward, so that the casts do not matter.
  const auto wider = [&](auto x) {
    return hn::MulAdd(hn::Abs(x), hn::Set(d, 0x1p-23), hn::Set(d, 0x1p-140));
  };
  const auto low_tau = hn::DemoteTo(df, hn::Sub(tau.low, wider(tau.low)));
  const auto high_tau = hn::DemoteTo(df, hn::Add(tau.high, wider(tau.high)));
  hn::StoreU(low_tau, df, low);
  hn::StoreU(high_tau, df, high);
  const auto inside = hn::And(hn::And(hn::Gt(uv, f.uv_err), hn::Gt(w, f.w_err)),
                              hn::And(denominator.clear, hn::Gt(den, hn::Zero(d))));
  const auto within = hn::And(hn::Gt(hn::PromoteTo(d, low_tau), range.tau_first),
                              hn::Lt(hn::PromoteTo(d, high_tau), range.tau_last));
  answer.certain = bits_of(d, hn::And(usable, hn::And(inside, within)));
  return answer;
}

template <class D>
HWY_INLINE hn::Vec<D> load_as_doubles(D d, const float* row) {
  return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, D>(), row));
}

// One exact ray against those triangles of a leaf of which `open` has bits: rows of their corners,
// `stride` apart. Apart: it is seldom asked.
[[gnu::cold]] inline HWY_NOINLINE DoubleAnswer double_cull(const float* rows, std::size_t stride,
                                                           const FilterRay& ray, float tau_max,
                                                           std::uint32_t open, float* low,
                                                           float* high) {
  using D8 = hn::CappedTag<double, 8>;
  using VD = hn::Vec<D8>;
  const D8 d;
  const auto all = [&](float x) { return hn::Set(d, static_cast<double>(x)); };
  const auto point = [&](const float* p) { return V3<VD>{all(p[0]), all(p[1]), all(p[2])}; };
  const V3<VD> origin = point(ray.origin), direction = point(ray.direction);
  const RangeLanes<VD> range{all(ray.tau_min), all(tau_max), all(ray.tau_first), all(ray.tau_last)};
  DoubleAnswer answer;
  for (std::uint32_t i = 0; i < 8; i += static_cast<std::uint32_t>(hn::Lanes(d))) {
    if (((open >> i) & ((1U << hn::Lanes(d)) - 1)) == 0) continue;
    const auto corner = [&](std::size_t row) {
      const float* p = rows + row * stride + i;
      return V3<VD>{load_as_doubles(d, p), load_as_doubles(d, p + stride),
                    load_as_doubles(d, p + 2 * stride)};
    };
    const HitLanes<D8> hits{corner(0), corner(3), corner(6), origin, direction};
    const DoubleAnswer part = double_cull_lanes(d, hits, range, ray.sides, low + i, high + i);
    answer.missed |= part.missed << i;
    answer.certain |= part.certain << i;
  }
  return answer;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
