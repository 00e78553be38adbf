// SPDX-License-Identifier: Apache-2.0
//
// Three-vectors of lanes, and the determinants of a ray and a triangle in them. One text for lanes
// of floats (the cull), of doubles and of double-doubles (the rounding).
#if defined(PIERCE_KERNELS_VECTORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_VECTORS_INL_H_
#undef PIERCE_KERNELS_VECTORS_INL_H_
#else
#define PIERCE_KERNELS_VECTORS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Arithmetic by names that lanes of double-doubles (round-inl.h) overload.
template <class V>
HWY_INLINE V negated(V a) {
  return hn::Neg(a);
}
template <class V>
HWY_INLINE V sum(V a, V b) {
  return hn::Add(a, b);
}
template <class V>
HWY_INLINE V difference(V a, V b) {
  return hn::Sub(a, b);
}
template <class V>
HWY_INLINE V product(V a, V b) {
  return hn::Mul(a, b);
}
template <class V>
HWY_INLINE V product_plus(V a, V b, V c) {
  return hn::MulAdd(a, b, c);
}
template <class V>
HWY_INLINE V product_minus(V a, V b, V c) {
  return hn::MulSub(a, b, c);
}

template <class V>
struct V3 {
  V x, y, z;
};

template <class V>
HWY_INLINE V3<V> operator-(const V3<V>& p, const V3<V>& q) {
  return {difference(p.x, q.x), difference(p.y, q.y), difference(p.z, q.z)};
}

template <class V, class W>
HWY_INLINE V3<V> cross(const V3<W>& p, const V3<V>& q) {
  return {product_minus(p.y, q.z, product(p.z, q.y)), product_minus(p.z, q.x, product(p.x, q.z)),
          product_minus(p.x, q.y, product(p.y, q.x))};
}

template <class V, class W>
HWY_INLINE V dot(const V3<V>& p, const V3<W>& q) {
  return product_plus(p.x, q.x, product_plus(p.y, q.y, V(product(p.z, q.z))));
}

template <class V>
HWY_INLINE V max_norm(const V3<V>& p) {
  return hn::Max(hn::Max(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z));
}

/// One point for all lanes.
template <class D, class Real>
HWY_INLINE V3<hn::Vec<D>> broadcast(D d, const Real* p) {
  return {hn::Set(d, p[0]), hn::Set(d, p[1]), hn::Set(d, p[2])};
}

/// A point a lane: x, y and z in rows `stride` apart.
template <class D, class Real>
HWY_INLINE V3<hn::Vec<D>> load_rows(D d, const Real* row, std::size_t stride) {
  return {hn::LoadU(d, row), hn::LoadU(d, row + stride), hn::LoadU(d, row + 2 * stride)};
}

/// Bit i: lane i of the mask.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8;
}

/// The mask with these bits.
template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, std::uint32_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                 static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(d, bytes);
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
