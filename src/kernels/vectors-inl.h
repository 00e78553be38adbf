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

#include <bit>
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

/// With sixteen registers, the numbers of a ray are read from memory again wherever they are
/// needed. Told that they may have changed, the compiler does not spread them over vectors first,
/// only to keep those in memory.
template <class T>
HWY_INLINE void stay_in_memory(const T& numbers) {
#if HWY_TARGET > HWY_AVX3
  asm volatile("" : "+m"(const_cast<T&>(numbers)));
#else
  (void)numbers;
#endif
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

// hn::Compress where it is one instruction. Elsewhere Highway looks the order of the lanes up in a
// local table, which g++ 12 copies onto the stack at each call, a kilobyte at AVX2; this one stays
// where it is, and serves all vectors of a mask.
#if HWY_TARGET <= HWY_AVX3
template <class D>
struct Compressor {
  hn::Mask<D> mask;

  HWY_INLINE Compressor(D, hn::Mask<D> kept) : mask(kept) {}
  /// The lanes of the mask come first, in their order; the others mean nothing.
  template <class V>
  [[nodiscard]] HWY_INLINE V operator()(V v) const {
    return hn::Compress(v, hn::RebindMask(hn::DFromV<V>(), mask));
  }
  [[nodiscard]] HWY_INLINE std::uint32_t count(D d) const {
    return static_cast<std::uint32_t>(hn::CountTrue(d, mask));
  }
};
#else
/// Of each set of `kCount` lanes: their numbers in order, then anything.
template <std::size_t kCount>
struct LaneOrders {
  std::uint8_t lane[std::size_t{1} << kCount][kCount] = {};

  constexpr LaneOrders() {
    for (std::size_t bits = 0; bits < std::size_t{1} << kCount; ++bits) {
      std::size_t kept = 0;
      for (std::size_t i = 0; i < kCount; ++i) {
        if ((bits >> i & 1) != 0) lane[bits][kept++] = static_cast<std::uint8_t>(i);
      }
    }
  }
};
template <std::size_t kCount>
inline constexpr LaneOrders<kCount> kLaneOrders;

template <class D>
struct Compressor {
  std::uint32_t bits;
  hn::Vec<hn::RebindToUnsigned<D>> order;

  HWY_INLINE Compressor(D d, hn::Mask<D> kept) : bits(bits_of(d, kept)) {
    constexpr std::size_t kCount = hn::MaxLanes(D());
    const hn::RebindToUnsigned<D> du;
    const hn::Rebind<std::uint8_t, D> du8;
    order = hn::PromoteTo(du, hn::LoadU(du8, kLaneOrders<kCount>.lane[bits]));
  }
  /// The lanes of the mask come first, in their order; the others mean nothing.
  template <class V>
  [[nodiscard]] HWY_INLINE V operator()(V v) const {
    return hn::TableLookupLanes(v, hn::IndicesFromVec(hn::DFromV<V>(), order));
  }
  [[nodiscard]] HWY_INLINE std::uint32_t count(D) const {
    return static_cast<std::uint32_t>(std::popcount(bits));
  }
};
#endif

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
