// SPDX-License-Identifier: Apache-2.0
//
// The quick road into filter space, for float scenes that are only scaled and not moved: powers of
// two all the way, so nothing is rounded (save into the subnormals: 2^-150, far below every bound's
// floor).
#if defined(PIERCE_KERNELS_ROAD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_ROAD_INL_H_
#undef PIERCE_KERNELS_ROAD_INL_H_
#else
#define PIERCE_KERNELS_ROAD_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "kernels/bounds.h"
#include "kernels/kernel.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// The range as filter_ray.h sets it, all four numbers at once.
HWY_INLINE void set_range_quickly(const Ray<float>& r, double tau_scale, FilterRay& ray) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  alignas(32) static constexpr double kPads[4] = {-kTauPad, kTauPad, kTauPad, -kTauPad};
  const auto limit = hn::Set(d, static_cast<double>(bvh::kTauLimit));
  const auto t = hn::InterleaveLower(d, hn::Set(d, static_cast<double>(r.t_min)),
                                     hn::Set(d, static_cast<double>(r.t_max)));
  const auto tau = hn::Mul(t, hn::Set(d, tau_scale));
  const auto clamped = hn::Min(hn::Max(tau, hn::Neg(limit)), limit);  // min, max, min, max
  for (std::size_t i = 0; i < 4; i += hn::Lanes(d)) {
    hn::StoreU(hn::DemoteTo(df, hn::Add(clamped, hn::LoadU(d, kPads + i))), df, &ray.tau_min + i);
  }
}

// False if the ray is not for this road: its origin is far away, or its direction's size is
// extreme.
HWY_INLINE bool quick_road(float scale, const Ray<float>& r, FilterRay& ray) {
  const hn::CappedTag<float, 4> d4;
  const float size =
      std::max({std::fabs(r.direction.x), std::fabs(r.direction.y), std::fabs(r.direction.z)});
  const float reach =
      std::max({std::fabs(r.origin.x), std::fabs(r.origin.y), std::fabs(r.origin.z)}) * scale;
  const std::uint32_t biased =
      std::bit_cast<std::uint32_t>(size) >> 23;  // 2^(biased - 127) <= size
  if (!(reach <= bvh::kNearOrigin) || biased - 8 > 238) return false;
  const float shrink = std::bit_cast<float>((254 - biased) << 23);
  const float grow = std::bit_cast<float>(biased << 23);
  // A lane too many each, which is in the ray.
  hn::Store(hn::Mul(hn::LoadU(d4, &r.origin.x), hn::Set(d4, scale)), d4, ray.origin);
  hn::Store(hn::Mul(hn::LoadU(d4, &r.direction.x), hn::Set(d4, shrink)), d4, ray.direction);
  set_range_quickly(r, static_cast<double>(scale) * static_cast<double>(grow), ray);
  ray.exact = true;
  return true;
}

// A ray is eight floats in a row.
static_assert(sizeof(Ray<float>) == 8 * sizeof(float) &&
              offsetof(Ray<float>, direction) == 3 * sizeof(float) &&
              offsetof(Ray<float>, t_min) == 6 * sizeof(float));

inline bool all_quick(float scale, const Ray<float>* rays, std::size_t count) {
  // A lane of each half of a ray: ox oy oz dx, dy dz t t.
  const hn::CappedTag<float, 4> d;
  const auto factor = hn::Set(d, scale);
  alignas(16) static constexpr float kNone4[4] = {1, 1, 1, 0};
  const auto origin_only = hn::Load(d, kNone4);
  auto farthest = hn::Zero(d);
  bool sizes = true;
  for (std::size_t i = 0; i < count; ++i) {
    const Ray<float>& r = rays[i];
    farthest = hn::Max(farthest, hn::Abs(hn::LoadU(d, &r.origin.x)));
    const float size =
        std::max({std::fabs(r.direction.x), std::fabs(r.direction.y), std::fabs(r.direction.z)});
    sizes &= (std::bit_cast<std::uint32_t>(size) >> 23) - 8 <= 238;
  }
  const auto reach = hn::Mul(hn::Mul(farthest, factor), origin_only);
  return sizes && hn::AllTrue(d, hn::Le(reach, hn::Set(d, bvh::kNearOrigin)));
}

inline std::size_t quick_roads(float scale, const Ray<float>* rays, std::size_t count,
                               FilterRay* out) {
  std::size_t i = 0;
  while (i < count && quick_road(scale, rays[i], out[i])) ++i;
  return i;
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
