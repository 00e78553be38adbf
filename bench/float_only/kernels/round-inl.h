// SPDX-License-Identifier: Apache-2.0
//
// Stands in for src/kernels/round-inl.h in pierce_float_only: t, u, v and w in plain double, with
// no word on how far off they are.
#if defined(PIERCE_KERNELS_ROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROUND_INL_H_
#undef PIERCE_KERNELS_ROUND_INL_H_
#else
#define PIERCE_KERNELS_ROUND_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/hit_lanes-inl.h"
#include "kernels/kernel.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

template <class D, class Real>
HWY_INLINE void store_rounded(D d, hn::Vec<D> x, Real* to) {
  if constexpr (std::is_same_v<Real, float>) {
    const hn::Rebind<float, D> df;
    hn::StoreU(hn::DemoteTo(df, x), df, to);
  } else {
    hn::StoreU(x, d, to);
  }
}

// Lanes i, i + 1, ... of the columns; the bits of those that are hit from the front.
template <class D, class Real>
HWY_INLINE std::uint32_t divide_lanes(D d, const HitLanes<D>& hit, std::size_t i,
                                      RoundedColumns<Real>& out, double to_t = 1) {
  const auto f = determinants(hit.a - hit.o, hit.b - hit.a, hit.c - hit.a, hit.d);
  const auto inverse = hn::Div(hn::Set(d, 1.0), f.den);
  store_rounded(d, hn::Mul(hn::Mul(f.t, inverse), hn::Set(d, to_t)), out.t + i);
  store_rounded(d, hn::Mul(f.u, inverse), out.u + i);
  store_rounded(d, hn::Mul(f.v, inverse), out.v + i);
  store_rounded(d, hn::Mul(f.w, inverse), out.w + i);
  return bits_of(d, hn::Lt(f.den, hn::Zero(d)));
}

template <class Real>
inline void round_columns(const HitColumns& hits, std::size_t count, RoundedColumns<Real>& out) {
  const hn::CappedTag<double, kRoundStep> d;
  out.sure = ~0U;
  out.front = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    out.front |= divide_lanes(d, load_hits(d, hits, i), i, out) << i;
  }
}

template <class Real>
inline bool round_pair(const predicate::RayD& ray, const predicate::TriangleD& triangle,
                       Hit<Real>& hit) {
  const hn::CappedTag<double, 1> d;
  RoundedColumns<Real> rounded;
  const std::uint32_t front = divide_lanes(d, hit_lanes(d, ray, triangle), 0, rounded);
  hit.t = rounded.t[0];
  hit.u = rounded.u[0];
  hit.v = rounded.v[0];
  hit.w = rounded.w[0];
  hit.facing = front != 0 ? Facing::Front : Facing::Back;
  return true;
}

inline bool round_copy(const FilterRay& ray, const Candidate& candidate, Hit<float>& hit) {
  const hn::CappedTag<double, 1> d;
  const auto lane = copied_lanes(d, ray, candidate);
  const auto f = determinants(lane.a - lane.o, lane.b - lane.a, lane.c - lane.a, lane.d);
  const auto inverse = hn::Div(hn::Set(d, 1.0), f.den);
  store_rounded(d, hn::Mul(hn::Mul(f.t, inverse), hn::Set(d, 1 / ray.tau_scale)), &hit.t);
  store_rounded(d, hn::Mul(f.u, inverse), &hit.u);
  store_rounded(d, hn::Mul(f.v, inverse), &hit.v);
  store_rounded(d, hn::Mul(f.w, inverse), &hit.w);
  hit.facing = hn::GetLane(f.den) < 0 ? Facing::Front : Facing::Back;
  return true;
}

template <class D>
HWY_INLINE void round_copies(const HitLanes<D>& hits, double to_t, std::size_t i,
                             RoundedColumns<float>& out) {
  out.sure = ~0U;
  out.front |= divide_lanes(D(), hits, i, out, to_t) << i;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
