// SPDX-License-Identifier: Apache-2.0
//
// Conservative interval box test for a set of coherent rays: the intervals that hold their origins
// and directions, and eight boxes held against all of them at once.
#if defined(PIERCE_KERNELS_BUNDLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_BUNDLE_INL_H_
#undef PIERCE_KERNELS_BUNDLE_INL_H_
#else
#define PIERCE_KERNELS_BUNDLE_INL_H_
#endif

#include "kernels/rays/single-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Three axes and a lane that means nothing.
using D4 = hn::CappedTag<float, 4>;
using V4 = hn::Vec<D4>;

// How far apart the origins (in a scene of size 2) and the directions (of size 1 to 2) of a bundle
// may be.
inline constexpr float kOriginSpread = 0.25F;
inline constexpr float kDirectionSpread = 0.25F;

// The least and the greatest of the numbers of some rays. Bit i of `mixed`: on axis i the
// directions do not all have the same sign bit (zeros have one, too); else it is that of
// `backward`.
struct Extent {
  V4 origin_low, origin_high, direction_low, direction_high;
  std::uint32_t mixed, backward;
  bool one_range;  // known to be the same for all

  HWY_INLINE Extent& operator|=(const Extent& other) {
    origin_low = hn::Min(origin_low, other.origin_low);
    origin_high = hn::Max(origin_high, other.origin_high);
    direction_low = hn::Min(direction_low, other.direction_low);
    direction_high = hn::Max(direction_high, other.direction_high);
    mixed |= other.mixed | (backward ^ other.backward);
    return *this;
  }
  [[nodiscard]] HWY_INLINE bool coherent() const {
    const D4 d;
    const auto near =
        hn::And(hn::Le(hn::Sub(origin_high, origin_low), hn::Set(d, kOriginSpread)),
                hn::Le(hn::Sub(direction_high, direction_low), hn::Set(d, kDirectionSpread)));
    return mixed == 0 && (bits_of(d, near) & 7U) == 7U;
  }
};

// Lane by lane: the least and the greatest of many numbers, and the sign bits that all and that any
// of them have.
template <class V>
struct Extremes {
  V low, high, all, any;

  HWY_INLINE explicit Extremes(V x) : low(x), high(x), all(x), any(x) {}
  HWY_INLINE void add(V x) {
    low = hn::Min(low, x);
    high = hn::Max(high, x);
    all = hn::And(all, x);
    any = hn::Or(any, x);
  }
};

// The extremes of the first eight numbers of each of some rays, of which they are in lanes.
template <class Real>
struct EightExtremes {
  alignas(64) Real low[8], high[8];
  std::uint32_t all = 0, any = 0;

  // Of lanes that hold number `part` and those after it.
  template <class E>
  HWY_INLINE void set(E d, std::size_t part, const Extremes<hn::Vec<E>>& e) {
    const hn::RebindToSigned<E> di;
    hn::StoreU(e.low, d, low + part);
    hn::StoreU(e.high, d, high + part);
    all |= bits_of(di, hn::Lt(hn::BitCast(di, e.all), hn::Zero(di))) << part;
    any |= bits_of(di, hn::Lt(hn::BitCast(di, e.any), hn::Zero(di))) << part;
  }
};

// Rays of `kStride` numbers each.
template <std::size_t kStride, class Real, class Count>
HWY_INLINE EightExtremes<Real> extremes_of(const Real* numbers, Count count) {
  const hn::CappedTag<Real, 8> d;
  EightExtremes<Real> eight;
  for (std::size_t part = 0; part < 8; part += hn::Lanes(d)) {
    Extremes<hn::Vec<decltype(d)>> e(hn::LoadU(d, numbers + part));
    for (std::size_t i = 1; i < count; ++i) e.add(hn::LoadU(d, numbers + i * kStride + part));
    eight.set(d, part, e);
  }
  return eight;
}

// Sixteen rays of eight floats each, without gaps: two in a vector, if it is so long.
HWY_INLINE EightExtremes<float> extremes_of_sixteen(const float* numbers) {
  const hn::CappedTag<float, 16> d;
  constexpr std::size_t kLong = hn::MaxLanes(d);
  if constexpr (kLong < 16) {
    return extremes_of<8>(numbers, std::size_t{16});
  } else {
    const hn::Half<decltype(d)> half;
    Extremes<hn::Vec<decltype(d)>> e(hn::LoadU(d, numbers));
    HWY_UNROLL(7)
    for (std::size_t i = kLong; i < 128; i += kLong) e.add(hn::LoadU(d, numbers + i));
    Extremes<hn::Vec<decltype(half)>> one(hn::LowerHalf(half, e.low));
    one.low = hn::Min(one.low, hn::UpperHalf(half, e.low));
    one.high = hn::Max(hn::LowerHalf(half, e.high), hn::UpperHalf(half, e.high));
    one.all = hn::And(hn::LowerHalf(half, e.all), hn::UpperHalf(half, e.all));
    one.any = hn::Or(hn::LowerHalf(half, e.any), hn::UpperHalf(half, e.any));
    EightExtremes<float> eight;
    eight.set(half, 0, one);
    return eight;
  }
}

// Of eight numbers in a row those at 3, 4, 5 and 6. (To load them would have to wait for both
// halves to be stored.)
HWY_INLINE V4 after_three(V4 first, V4 last) {
  return hn::CombineShiftRightBytes<12>(D4(), last, first);
}

// The extent of rays of whose floats the origin comes first, the direction at kDirection,
// and the range at 6 if kDirection is 3.
template <std::size_t kDirection>
HWY_INLINE Extent extent_of(const EightExtremes<float>& e) {
  static_assert(kDirection == 3 || kDirection == 4);
  const D4 d;
  const V4 low = hn::LoadU(d, e.low), low_rest = hn::LoadU(d, e.low + 4);
  const V4 high = hn::LoadU(d, e.high), high_rest = hn::LoadU(d, e.high + 4);
  return {low,
          high,
          kDirection == 3 ? after_three(low, low_rest) : low_rest,
          kDirection == 3 ? after_three(high, high_rest) : high_rest,
          ((e.all ^ e.any) >> kDirection) & 7U,
          (e.all >> kDirection) & 7U,
          kDirection == 3 && e.low[6] == e.high[6] && e.low[7] == e.high[7]};
}

// What the tests of `kCount` bundles need: on each axis the origin that makes entries earliest and
// the one that makes exits latest, the least and the greatest inverse, and the pad of the greatest.
template <std::size_t kCount>
struct Bundles {
  float near_origin[3][kCount], far_origin[3][kCount];
  float inverse_low[3][kCount], inverse_high[3][kCount], pad[3][kCount];
  float least_tau_min[kCount], greatest_tau_max[kCount];  // nothing beyond matters any more
};
using Bundle = Bundles<1>;

// Sets all of bundle i but its range.
template <std::size_t kCount>
HWY_INLINE void set_bundle(const Extent& extent, std::size_t i, Bundles<kCount>& bundles) {
  const D4 d;
  const auto backward = mask_of(d, extent.backward);
  const auto set = [&](V4 numbers, float(&rows)[3][kCount]) {
    alignas(16) float lanes[4];
    hn::Store(numbers, d, lanes);
    for (std::size_t axis = 0; axis < 3; ++axis) rows[axis][i] = lanes[axis];
  };
  set(hn::IfThenElse(backward, extent.origin_low, extent.origin_high), bundles.near_origin);
  set(hn::IfThenElse(backward, extent.origin_high, extent.origin_low), bundles.far_origin);
  // Of numbers of one sign the greatest has the least inverse.
  const V4 low = box_terms(d, extent.origin_low, extent.direction_high).inverse;
  const V4 high = box_terms(d, extent.origin_low, extent.direction_low).inverse;
  set(low, bundles.inverse_low);
  set(high, bundles.inverse_high);
  const V4 size = hn::Max(hn::Abs(extent.origin_low), hn::Abs(extent.origin_high));
  set(hn::Mul(box_pad(d, size), hn::Max(hn::Abs(low), hn::Abs(high))), bundles.pad);
}

// Lanes of bundles, or one in all lanes: what the interval test needs of an axis.
template <class V>
struct BundleAxis {
  V near_origin, far_origin, inverse_low, inverse_high, pad;
};

// Lanes of boxes: the planes of an axis by which rays enter and leave.
template <class V>
struct Planes {
  V near, far;
};

// Narrows [near, far] to what some ray of a bundle may pass between the planes. The products of the
// distance to a plane and all inverses lie between those with the least and the greatest; each is
// within 5 ulp of the plane and 6 of the origin, over |direction|, of the true one; the first is
// built into the boxes, the pad is 7 of the greatest origin (docs/algorithm.md, "Packets").
template <class V>
HWY_INLINE void narrow(const BundleAxis<V>& b, const Planes<V>& planes, V& near, V& far) {
  const V to_near = hn::Sub(planes.near, b.near_origin);
  const V to_far = hn::Sub(planes.far, b.far_origin);
  const V entry = hn::Min(hn::Mul(to_near, b.inverse_low), hn::Mul(to_near, b.inverse_high));
  const V exit = hn::Max(hn::Mul(to_far, b.inverse_low), hn::Mul(to_far, b.inverse_high));
  near = hn::Max(near, hn::Sub(entry, b.pad));
  far = hn::Min(far, hn::Add(exit, b.pad));
}

// What some ray of bundle i may reach of as many boxes as there are lanes. `near`: where the first
// may enter.
template <std::size_t kCount, class PlanesOf>
HWY_INLINE hn::Mask<D> in_reach(const Bundles<kCount>& b, std::size_t i, const PlanesOf& planes,
                                V& near) {
  const D d;
  near = hn::Set(d, b.least_tau_min[i]);
  V far = hn::Set(d, b.greatest_tau_max[i]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto all = [&](const float(&rows)[3][kCount]) { return hn::Set(d, rows[axis][i]); };
    narrow({all(b.near_origin), all(b.far_origin), all(b.inverse_low), all(b.inverse_high),
            all(b.pad)},
           planes(axis), near, far);
  }
  return hn::Le(near, far);
}

// By which planes of a node the rays of an octant enter and leave, in floats from its first.
struct PlaneOffsets {
  std::size_t near[3], far[3];
  std::uint32_t backward;  // bit i: on axis i the rays run backward

  HWY_INLINE explicit PlaneOffsets(std::uint32_t bits) : backward(bits) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t lower = axis * bvh::kWidth;
      const std::size_t upper = lower + kUpperPlanes;
      const bool back = ((backward >> axis) & 1U) != 0;
      near[axis] = back ? upper : lower;
      far[axis] = back ? lower : upper;
    }
  }
};

// Bit i: some ray may enter child i, none before entry[i].
HWY_INLINE std::uint32_t children_in_reach(const bvh::Node& node, const PlaneOffsets& offsets,
                                           const Bundle& b, float* HWY_RESTRICT entry) {
  const D d;
  const float* rows = &node.lower[0][0];
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < bvh::kWidth; i += kLanes) {
    const auto planes = [&](std::size_t axis) {
      return Planes<V>{hn::Load(d, rows + offsets.near[axis] + i),
                       hn::Load(d, rows + offsets.far[axis] + i)};
    };
    V near;
    bits |= bits_of(d, in_reach(b, 0, planes, near)) << i;
    hn::Store(near, d, entry + i);
  }
  return bits;
}

// Bit i: some ray of bundle i may enter the child, the first of whose planes is given.
template <std::size_t kCount>
HWY_INLINE std::uint32_t bundles_entering(const float* child, const PlaneOffsets& offsets,
                                          const Bundles<kCount>& b) {
  static_assert(kCount == 4);
  const D4 d;
  V4 near = hn::LoadU(d, b.least_tau_min), far = hn::LoadU(d, b.greatest_tau_max);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto each = [&](const float(&rows)[3][kCount]) { return hn::LoadU(d, rows[axis]); };
    narrow({each(b.near_origin), each(b.far_origin), each(b.inverse_low), each(b.inverse_high),
            each(b.pad)},
           {hn::Set(d, child[offsets.near[axis]]), hn::Set(d, child[offsets.far[axis]])}, near,
           far);
  }
  return bits_of(d, hn::Le(near, far));
}

// The boxes of the triangles of a leaf, from the float copies, by the planes that the rays of an
// octant enter and leave by.
struct TriangleBoxes {
  V near[3][kParts], far[3][kParts];
  std::uint32_t lanes;

  HWY_INLINE TriangleBoxes(const Leaf& leaf, std::uint32_t backward)
      : lanes((1U << leaf.count) - 1) {
    const D d;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool back = ((backward >> axis) & 1U) != 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const auto corner = [&](std::size_t k) {
          return hn::LoadU(d, leaf.rows + (3 * k + axis) * leaf.count + part * kLanes);
        };
        const V copy = hn::Set(d, kBoxCopy);
        const V low = hn::Min(hn::Min(corner(0), corner(1)), corner(2));
        const V high = hn::Max(hn::Max(corner(0), corner(1)), corner(2));
        const V lower = hn::NegMulAdd(copy, hn::Abs(low), low);
        const V upper = hn::MulAdd(copy, hn::Abs(high), high);
        near[axis][part] = back ? upper : lower;
        far[axis][part] = back ? lower : upper;
      }
    }
  }

  // Bit k: some ray of bundle i may meet triangle k.
  template <std::size_t kCount>
  [[nodiscard]] HWY_INLINE std::uint32_t in_reach_of(const Bundles<kCount>& b,
                                                     std::size_t i) const {
    const D d;
    std::uint32_t bits = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const auto planes = [&](std::size_t axis) {
        return Planes<V>{near[axis][part], far[axis][part]};
      };
      V entry;
      bits |= bits_of(d, in_reach(b, i, planes, entry)) << (part * kLanes);
    }
    return bits & lanes;
  }
};

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
