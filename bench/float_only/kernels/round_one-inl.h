// SPDX-License-Identifier: Apache-2.0
//
// Stands in for src/kernels/round_one-inl.h in pierce_float_only: plain double, as its neighbour.
#if defined(PIERCE_KERNELS_ROUND_ONE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROUND_ONE_INL_H_
#undef PIERCE_KERNELS_ROUND_ONE_INL_H_
#else
#define PIERCE_KERNELS_ROUND_ONE_INL_H_
#endif

#include "kernels/round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

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

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
