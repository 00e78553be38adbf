// SPDX-License-Identifier: Apache-2.0
//
// The transforms into filter space that nearly all rays take. By scaling, for float scenes that are
// only scaled and not moved: powers of two all the way, so nothing is rounded (save into the
// subnormals: 2^-150, far below every bound's floor). Affine, in double, for all others. None takes
// a ray that is not valid, so what one takes need not be validated.
#if defined(PIERCE_KERNELS_TRANSFORM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_TRANSFORM_INL_H_
#undef PIERCE_KERNELS_TRANSFORM_INL_H_
#else
#define PIERCE_KERNELS_TRANSFORM_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Whether a positive number is neither subnormal nor infinite.
HWY_INLINE bool is_normal(float x) { return (std::bit_cast<std::uint32_t>(x) >> 23) - 1 < 254; }

// The range as filter_ray.h sets it, all four numbers at once.
template <class Real>
HWY_INLINE void set_range_in_lanes(const Ray<Real>& r, double tau_scale, FilterRay& ray) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  constexpr double kPad = kTauPad, kFloor = kTauFloorKept;
  alignas(32) static constexpr double kPads[4] = {-kPad, kPad, kPad, -kPad};
  alignas(32) static constexpr double kFloors[4] = {-kFloor, kFloor, kFloor, -kFloor};
  const auto limit = hn::Set(d, static_cast<double>(space::kTauLimit));
  const auto t = hn::InterleaveLower(d, hn::Set(d, static_cast<double>(r.t_min)),
                                     hn::Set(d, static_cast<double>(r.t_max)));
  const auto tau = hn::Mul(t, hn::Set(d, tau_scale));
  const auto clamped = hn::Min(hn::Max(tau, hn::Neg(limit)), limit);  // min, max, min, max
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const auto pad =
        hn::MulAdd(hn::Abs(clamped), hn::LoadU(d, kPads + i), hn::LoadU(d, kFloors + i));
    hn::StoreU(hn::DemoteTo(df, hn::Add(clamped, pad)), df, &ray.tau_min + i);
  }
  ray.tau_scale = tau_scale;
}

// The same where tau is t times a float, which rounds nothing but what becomes subnormal.
HWY_INLINE void set_range_in_lanes(const Ray<float>& r, float tau_scale, FilterRay& ray) {
  const hn::CappedTag<float, 4> d;
  constexpr auto kPad = static_cast<float>(kTauPad), kFloor = static_cast<float>(kTauFloorKept);
  alignas(16) static constexpr float kPads[4] = {-kPad, kPad, kPad, -kPad};
  alignas(16) static constexpr float kFloors[4] = {-kFloor, kFloor, kFloor, -kFloor};
  const auto limit = hn::Set(d, space::kTauLimit);
  const auto last = hn::LoadU(d, &r.direction.y);
  const auto tau = hn::Mul(hn::ConcatUpperUpper(d, last, last), hn::Set(d, tau_scale));
  const auto clamped = hn::Min(hn::Max(tau, hn::Neg(limit)), limit);  // min, max, min, max
  const auto pad = hn::MulAdd(hn::Abs(clamped), hn::Load(d, kPads), hn::Load(d, kFloors));
  hn::StoreU(hn::Add(clamped, pad), d, &ray.tau_min);
  ray.tau_scale = static_cast<double>(tau_scale);
}

// Whether one of a ray's eight numbers is NaN; perhaps also if some are infinite that must not be,
// which the limits of magnitude tell.
template <class Real>
HWY_INLINE bool has_nan(const Ray<Real>& r) {
  const hn::CappedTag<Real, 4> d;
  std::uint32_t same = 0;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const auto both = hn::Add(hn::LoadU(d, &r.origin.x + i), hn::LoadU(d, &r.direction.y + i));
    same |= bits_of(d, hn::Eq(both, both)) << i;
  }
  return same != 15;
}

// The max-norm of the first three lanes, in all of them; NaN if one of them is. (As integers,
// magnitudes have their order, and NaNs are beyond all.)
template <class D4, class V4 = hn::Vec<D4>>
HWY_INLINE V4 max_norm_of_three(D4 d4, V4 v) {
  const hn::RebindToSigned<D4> di;
  alignas(16) static constexpr std::int32_t kMagnitudes[4] = {0x7fffffff, 0x7fffffff, 0x7fffffff,
                                                              0};
  const auto size = hn::And(hn::BitCast(di, v), hn::Load(di, kMagnitudes));
  const auto pairs = hn::Max(size, hn::Shuffle2301(size));
  return hn::BitCast(d4, hn::Max(pairs, hn::Shuffle1032(pairs)));
}

// The power of two that a positive number's exponent stands for.
template <class V>
HWY_INLINE V power_of_two_below(V v) {
  const hn::DFromV<V> d;
  const hn::RebindToSigned<decltype(d)> di;
  return hn::BitCast(d, hn::And(hn::BitCast(di, v), hn::Set(di, 0x7f800000)));
}

// False if scaling does not serve: the ray's origin is far away, its direction's size is extreme,
// or it is not valid.
HWY_INLINE bool transform_scaled(float scale, const Ray<float>& r, FilterRay& ray) {
  const hn::CappedTag<float, 4> d4;
  const hn::RebindToSigned<decltype(d4)> di;
  // A lane too many each, which is in the ray.
  const auto origin = hn::LoadU(d4, &r.origin.x);
  const auto direction = hn::LoadU(d4, &r.direction.x);
  const auto size = max_norm_of_three(d4, direction);
  const float distance = hn::GetLane(max_norm_of_three(d4, origin)) * scale;
  // 2^(biased - 127) <= size
  const std::uint32_t biased = std::bit_cast<std::uint32_t>(hn::GetLane(size)) >> 23;
  // The power of two, and the one by which it becomes 1: the exponents' sum is 254.
  const auto grow = power_of_two_below(size);
  const auto shrink = hn::BitCast(d4, hn::Sub(hn::Set(di, 254 << 23), hn::BitCast(di, grow)));
  const float tau_scale = scale * hn::GetLane(grow);
  if (!(distance <= space::kKeptOrigin) || biased - 8 > 238 || !is_normal(tau_scale) ||
      std::isunordered(r.t_min, r.t_max))
    return false;
  hn::Store(hn::Mul(origin, hn::Set(d4, scale)), d4, ray.origin);
  hn::Store(hn::Mul(direction, shrink), d4, ray.direction);
  set_range_in_lanes(r, tau_scale, ray);
  ray.exact = true;
  ray.sides = Sides::Both;
  ray.masked = false;
  ray.reach = space::reach_of_origin(distance);
  return true;
}

inline std::size_t transform_scaled(float scale, const Ray<float>* rays, std::size_t count,
                                    FilterRay* out) {
  std::size_t i = 0;
  while (i < count && transform_scaled(scale, rays[i], out[i])) ++i;
  return i;
}

// The first three of four numbers: whether all are floats.
template <class D, class V>
HWY_INLINE bool three_are_floats(D d, const V (&parts)[4 / hn::MaxLanes(D())]) {
  const hn::Rebind<float, D> df;
  std::uint32_t same = 0;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const V part = parts[i / hn::Lanes(d)];
    same |= bits_of(d, hn::Eq(part, hn::PromoteTo(d, hn::DemoteTo(df, part)))) << i;
  }
  return (same & 7) == 7;
}

// FilterSpace::transform where the origin stays, nothing is extreme and the ray is valid. False if
// that is not so.
template <class Real>
HWY_INLINE bool transform_affine(const space::AffineMap& space, const Ray<Real>& r,
                                 FilterRay& ray) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  using VD = hn::Vec<decltype(d)>;
  constexpr std::size_t kPartsOfPoint = 4 / hn::MaxLanes(d);
  const double size = static_cast<double>(
      std::max({std::fabs(r.direction.x), std::fabs(r.direction.y), std::fabs(r.direction.z)}));
  const std::uint64_t biased =
      std::bit_cast<std::uint64_t>(size) >> 52;  // 2^(biased - 1023) <= size
  if (biased - (1023 - space::kMildExponent) > 2 * space::kMildExponent || has_nan(r)) return false;
  const auto shrink = hn::Set(d, std::bit_cast<double>((2046 - biased) << 52));
  const double grow = std::bit_cast<double>(biased << 52);
  const auto numbers = [&](const Real* from) {
    if constexpr (std::is_same_v<Real, double>) {
      return hn::LoadU(d, from);
    } else {
      return hn::PromoteTo(d, hn::LoadU(df, from));
    }
  };
  VD origin[kPartsOfPoint], direction[kPartsOfPoint];
  std::uint32_t near = 0;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    // A lane too many each, which is in the ray.
    VD& o = origin[i / hn::Lanes(d)];
    o = hn::Mul(hn::Sub(numbers(&r.origin.x + i), hn::LoadU(d, space.center + i)),
                hn::Set(d, space.scale));
    near |= bits_of(d, hn::Le(hn::Abs(o), hn::Set(d, static_cast<double>(space::kKeptOrigin))))
            << i;
    direction[i / hn::Lanes(d)] = hn::Mul(numbers(&r.direction.x + i), shrink);
  }
  if ((near & 7) != 7) return false;
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    hn::StoreU(hn::DemoteTo(df, origin[i / hn::Lanes(d)]), df, ray.origin + i);
    hn::StoreU(hn::DemoteTo(df, direction[i / hn::Lanes(d)]), df, ray.direction + i);
  }
  set_range_in_lanes(r, space.scale * grow, ray);
  // What was rounded down to a power of two counts as more.
  ray.reach = space::reach_of_origin(
      std::max({std::fabs(ray.origin[0]), std::fabs(ray.origin[1]), std::fabs(ray.origin[2])}) *
      (1 + 0x1p-23F));
  ray.sides = Sides::Both;
  ray.masked = false;
  ray.exact = space.copies_exact && three_are_floats(d, origin) && three_are_floats(d, direction);
  return true;
}

template <class Real>
inline std::size_t transform_affine(const space::AffineMap& space, const Ray<Real>* rays,
                                    std::size_t count, FilterRay* out) {
  std::size_t i = 0;
  while (i < count && transform_affine(space, rays[i], out[i])) ++i;
  return i;
}

// A ray is eight numbers in a row: ox oy oz dx dy dz t_min t_max.
template <class Real>
inline constexpr bool kRayIsARow = sizeof(Ray<Real>) == 8 * sizeof(Real) &&
                                   offsetof(Ray<Real>, direction) == 3 * sizeof(Real) &&
                                   offsetof(Ray<Real>, t_min) == 6 * sizeof(Real);
static_assert(kRayIsARow<float> && kRayIsARow<double>);

inline bool rays_within(const RayLimits& limits, const Ray<float>* rays, std::size_t count) {
  const hn::CappedTag<float, 8> d;
  constexpr float kAny = std::numeric_limits<float>::infinity();
  const float o = limits.origin, g = limits.greatest, l = limits.least;
  alignas(64) const float most[8] = {o, o, o, g, g, g, kAny, kAny};
  std::uint32_t within = 0xff, directed = 1;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t small = 0, large = 0;
    for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) {
      const auto size = hn::Abs(hn::LoadU(d, &rays[i].origin.x + k));
      small |= bits_of(d, hn::Le(size, hn::Load(d, most + k))) << k;  // not if NaN
      large |= bits_of(d, hn::Ge(size, hn::Set(d, l))) << k;
    }
    within &= small;
    directed &= (large & 0x38) != 0 ? 1U : 0U;
  }
  return within == 0xff && directed != 0;
}

// Whether transform_affine takes all of them.
inline bool rays_mapped(const space::AffineMap& space, const Ray<double>* rays, std::size_t count) {
  const hn::CappedTag<double, 8> d;
  constexpr double kAny = std::numeric_limits<double>::infinity();
  // Sizes of directions: rounded down to a power of two they are mild.
  static_assert(space::kMildExponent == 400);
  constexpr double kLeast = 0x1p-400, kMost = 0x1.fffffffffffffp400;
  const auto o = static_cast<double>(space::kKeptOrigin);
  const double* const c = space.center;
  const double s = space.scale;
  alignas(64) const double middle[8] = {c[0], c[1], c[2], 0, 0, 0, 0, 0};
  alignas(64) const double factors[8] = {s, s, s, 1, 1, 1, 1, 1};
  alignas(64) const double limits[8] = {o, o, o, kMost, kMost, kMost, kAny, kAny};
  constexpr std::size_t kVectors = 8 / hn::MaxLanes(d);
  hn::Mask<decltype(d)> small[kVectors];
  for (auto& part : small) part = hn::FirstN(d, 8);
  std::uint32_t directed = 1;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t large = 0;
    for (std::size_t part = 0; part < kVectors; ++part) {
      const std::size_t k = part * hn::Lanes(d);
      const auto number = hn::LoadU(d, &rays[i].origin.x + k);
      const auto size =
          hn::Abs(hn::Mul(hn::Sub(number, hn::Load(d, middle + k)), hn::Load(d, factors + k)));
      small[part] = hn::And(small[part], hn::Le(size, hn::Load(d, limits + k)));  // not if NaN
      large |= bits_of(d, hn::Ge(size, hn::Set(d, kLeast))) << k;
    }
    directed &= (large & 0x38) != 0 ? 1U : 0U;
  }
  for (const auto& part : small) directed &= hn::AllTrue(d, part) ? 1U : 0U;
  return directed != 0;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
