// SPDX-License-Identifier: Apache-2.0
//
// The box test: one ray against the eight boxes of a node (docs/algorithm.md, "The box test").
#if defined(PIERCE_KERNELS_BOX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_BOX_INL_H_
#undef PIERCE_KERNELS_BOX_INL_H_
#else
#define PIERCE_KERNELS_BOX_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "bvh/node.h"
#include "kernels/bounds.h"
#include "kernels/rays/leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Where in a node the planes are that a ray enters by, and leaves by, in bytes.
struct EntryPlanes {
  std::size_t near[3], far[3];
};

using V4 = hn::Vec<hn::CappedTag<float, 4>>;

// Numbers of a ray, one an axis, each wanted in all lanes. Where there are registers enough that is
// done once; else they are read from memory at each node anyway, and spread by the reading.
#if HWY_TARGET <= HWY_AVX3
class AxisTerms {
 public:
  HWY_INLINE explicit AxisTerms(V4 terms) {
    alignas(16) float of[4];
    hn::Store(terms, hn::CappedTag<float, 4>(), of);
    x_ = hn::Set(D(), of[0]);
    y_ = hn::Set(D(), of[1]);
    z_ = hn::Set(D(), of[2]);
  }
  [[nodiscard]] HWY_INLINE V x() const { return x_; }
  [[nodiscard]] HWY_INLINE V y() const { return y_; }
  [[nodiscard]] HWY_INLINE V z() const { return z_; }

 private:
  V x_, y_, z_;
};
#else
class AxisTerms {
 public:
  HWY_INLINE explicit AxisTerms(V4 terms) { hn::Store(terms, hn::CappedTag<float, 4>(), of_); }
  [[nodiscard]] HWY_INLINE V x() const { return hn::Set(D(), of_[0]); }
  [[nodiscard]] HWY_INLINE V y() const { return hn::Set(D(), of_[1]); }
  [[nodiscard]] HWY_INLINE V z() const { return hn::Set(D(), of_[2]); }

 private:
  alignas(16) float of_[4];
};
#endif

// What the box test needs of a ray: a plane is met at plane * inverse - origin * inverse, a pad
// earlier (entry) or later (exit).
template <bool kAhead>
struct AnyBoxRay {
  AxisTerms inverse;
  AxisTerms entry;  // -(origin * inverse) - pad
  AxisTerms exit;   // -(origin * inverse) + pad
  const EntryPlanes* planes;
};

using BoxRay = AnyBoxRay<false>;
// One that is_ahead. Distances along it can be compared as integers, which is sooner done: floats
// that are not negative keep their order, and those that are come before all others.
using AheadRay = AnyBoxRay<true>;

// Whether all hits of a ray have tau >= -2^-99 (docs/algorithm.md, "The box test").
HWY_INLINE bool is_ahead(const FilterRay& ray) {
  return ray.tau_min >= -static_cast<float>(kTauFloorKept);
}

inline constexpr std::size_t kUpperPlanes = 3 * bvh::kWidth;

// What rounding may move an origin of this magnitude by, in the box test.
template <class Tag, class Lanes>
HWY_INLINE Lanes box_pad(Tag d, Lanes origin_size, float floor = kBoxFloor) {
  return hn::MulAdd(hn::Set(d, kBoxOrigin), origin_size, hn::Set(d, floor));
}

// What of it is not relative: more if the ray is blurred, and a little more for the rounding.
template <class AnyRay>
HWY_INLINE float box_floor(const AnyRay& ray) {
  if constexpr (kIsBlurred<AnyRay>) return kBoxFloor + ray.blur * (1 + 0x1p-20F);
  return kBoxFloor;
}

// One over the direction, which is kept from zero. The only code that does it, but for ByScaling
// (straight-inl.h), which comes to the same.
template <class Tag, class Lanes = hn::Vec<Tag>>
HWY_INLINE Lanes inverse_slope(Tag d, Lanes direction) {
  const auto slope = hn::Or(hn::Max(hn::Abs(direction), hn::Set(d, kSmallestSlope)),
                            hn::And(direction, hn::Set(d, -0.0F)));
  return hn::Div(hn::Set(d, 1.0F), slope);
}

// Of lanes of rays (or of axes): what one axis of the box test needs, as in BoxRay. The only code
// where pads are made (docs/algorithm.md, "The box test").
template <class Lanes>
struct BoxTerms {
  Lanes inverse, entry, exit;
};

template <class Tag, class Lanes = hn::Vec<Tag>>
HWY_INLINE BoxTerms<Lanes> box_terms_of_inverse(Tag d, Lanes origin, Lanes inverse,
                                                float floor = kBoxFloor) {
  const auto middle = hn::Neg(hn::Mul(origin, inverse));
  const auto pad = hn::Mul(box_pad(d, hn::Abs(origin), floor), hn::Abs(inverse));
  return {inverse, hn::Sub(middle, pad), hn::Add(middle, pad)};
}

template <class Tag, class Lanes = hn::Vec<Tag>>
HWY_INLINE BoxTerms<Lanes> box_terms(Tag d, Lanes origin, Lanes direction,
                                     float floor = kBoxFloor) {
  return box_terms_of_inverse(d, origin, inverse_slope(d, direction), floor);
}

// Of rays of an octant (bit k: component k is negative).
inline constexpr auto kEntryPlanes = [] {
  std::array<EntryPlanes, bvh::kOctants> table{};
  for (std::size_t octant = 0; octant < table.size(); ++octant) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t lower = axis * bvh::kWidth * sizeof(float);
      const std::size_t upper = lower + kUpperPlanes * sizeof(float);
      const bool backward = ((octant >> axis) & 1U) != 0;
      table[octant].near[axis] = backward ? upper : lower;
      table[octant].far[axis] = backward ? lower : upper;
    }
  }
  return table;
}();

// By the signs of the first three lanes: zeros have one, too.
HWY_INLINE std::uint32_t octant_of(V4 direction) {
  const hn::RebindToSigned<hn::DFromV<V4>> di;
  return bits_of(di, hn::Lt(hn::BitCast(di, direction), hn::Zero(di))) & 7;
}

// `inverse`: of the ray's direction, as inverse_slope has it.
template <class Box, class AnyRay>
HWY_INLINE Box box_ray(const AnyRay& ray, V4 inverse) {
  const hn::CappedTag<float, 4> d4;
  const auto terms = box_terms_of_inverse(d4, hn::Load(d4, ray.origin), inverse, box_floor(ray));
  return {AxisTerms(terms.inverse), AxisTerms(terms.entry), AxisTerms(terms.exit),
          &kEntryPlanes[octant_of(hn::Load(d4, ray.direction))]};
}

template <class AnyRay>
HWY_INLINE V4 inverse_slope_of(const AnyRay& ray) {
  const hn::CappedTag<float, 4> d4;
  return inverse_slope(d4, hn::Load(d4, ray.direction));
}

template <class AnyRay>
HWY_INLINE BoxRay box_ray(const AnyRay& ray) {
  return box_ray<BoxRay>(ray, inverse_slope_of(ray));
}

// Calls `then(box)` with an AheadRay or a BoxRay.
template <class AnyRay, class Then>
HWY_INLINE auto with_box_ray(const AnyRay& ray, const Then& then) {
  return is_ahead(ray) ? then(box_ray<AheadRay>(ray, inverse_slope_of(ray))) : then(box_ray(ray));
}

// Bit i: the ray may enter child i within [tau_min, tau_max]; entry[i] is where.
template <bool kAhead>
HWY_INLINE std::uint32_t entered_children(const bvh::Node& node, const AnyBoxRay<kAhead>& ray,
                                          float tau_min, float tau_max, float* HWY_RESTRICT entry) {
  using Tag = std::conditional_t<kAhead, hn::RebindToSigned<D>, D>;
  const D d;
  const Tag as;
  const auto* planes = reinterpret_cast<const std::byte*>(&node.lower[0][0]);
  std::uint32_t bits = 0;
  stay_in_memory(ray);
  for (int i = 0; i < bvh::kWidth; i += kLanes) {
    const auto meet = [&](std::size_t at, V inverse, V middle) {
      const auto* plane = reinterpret_cast<const float*>(planes + at) + i;
      return hn::BitCast(as, hn::MulAdd(hn::Load(d, plane), inverse, middle));
    };
    const EntryPlanes& at = *ray.planes;
    const auto near_x = meet(at.near[0], ray.inverse.x(), ray.entry.x());
    const auto near_y = meet(at.near[1], ray.inverse.y(), ray.entry.y());
    const auto near_z = meet(at.near[2], ray.inverse.z(), ray.entry.z());
    const auto far_x = meet(at.far[0], ray.inverse.x(), ray.exit.x());
    const auto far_y = meet(at.far[1], ray.inverse.y(), ray.exit.y());
    const auto far_z = meet(at.far[2], ray.inverse.z(), ray.exit.z());
    const auto from_zero = [](float tau) { return kAhead ? std::max(tau, 0.0F) : tau; };
    const auto first = hn::BitCast(as, hn::Set(d, from_zero(tau_min)));
    const auto last = hn::BitCast(as, hn::Set(d, from_zero(tau_max)));
    const auto near = hn::Max(hn::Max(near_x, near_y), hn::Max(near_z, first));
    const auto far = hn::Min(hn::Min(far_x, far_y), hn::Min(far_z, last));
    hn::Store(hn::BitCast(d, near), d, entry + i);
    if constexpr (kAhead) {
      bits |= (bits_of(as, hn::Gt(near, far)) ^ ((1U << kLanes) - 1)) << i;
    } else {
      bits |= bits_of(as, hn::Le(near, far)) << i;
    }
  }
  return bits;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
