// SPDX-License-Identifier: Apache-2.0
//
// Pairs of a ray and a triangle that it hits, in lanes, and the determinants that tell where.
#if defined(PIERCE_KERNELS_HIT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_HIT_LANES_INL_H_
#undef PIERCE_KERNELS_HIT_LANES_INL_H_
#else
#define PIERCE_KERNELS_HIT_LANES_INL_H_
#endif

#include <cstddef>

#include "kernels/kernel.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The five determinants of predicate/determinants.h; Number is lanes of doubles or of Pairs of
// them.
template <class Number>
struct Numbers {
  Number den, u, v, w, t;
};

template <class Number, class V>
HWY_INLINE Numbers<Number> determinants(const V3<Number>& s, const V3<Number>& e1,
                                        const V3<Number>& e2, const V3<V>& d) {
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

template <class D>
struct HitLanes {
  V3<hn::Vec<D>> a, b, c, o, d;
};

template <class D>
HWY_INLINE HitLanes<D> load_hits(D d, const HitColumns& hits, std::size_t i) {
  const auto point = [&](std::size_t row) {
    return load_rows(d, &hits.number[row][i], kRoundBatch);
  };
  return {point(0), point(3), point(6), point(9), point(12)};
}

// One pair in all lanes.
template <class D>
HWY_INLINE HitLanes<D> hit_lanes(D d, const predicate::RayD& ray,
                                 const predicate::TriangleD& triangle) {
  const auto point = [&](const Vec3<double>& p) { return broadcast(d, &p.x); };
  return {point(triangle.a), point(triangle.b), point(triangle.c), point(ray.origin),
          point(ray.direction)};
}

// The same of an exact ray and a triangle's copy, where they are in filter space.
template <class D>
HWY_INLINE HitLanes<D> copied_lanes(D d, const FilterRay& ray, const Candidate& candidate) {
  using VD = hn::Vec<D>;
  const auto lane = [&](float x) { return hn::Set(d, static_cast<double>(x)); };
  const auto corner = [&](std::size_t row) {
    const std::size_t stride = candidate.stride;
    const float* p = candidate.copy + row * stride;
    return V3<VD>{lane(p[0]), lane(p[stride]), lane(p[2 * stride])};
  };
  const auto triple = [&](const float* p) { return V3<VD>{lane(p[0]), lane(p[1]), lane(p[2])}; };
  return {corner(0), corner(3), corner(6), triple(ray.origin), triple(ray.direction)};
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
