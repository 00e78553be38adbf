// SPDX-License-Identifier: Apache-2.0
//
// The kernels' transforms into filter space, held against FilterSpace::transform bit by bit, and
// the look at a batch's rays against the definition of a valid ray. Numbers of every style, in
// scenes of every style.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "kernels/kernel.h"
#include "scene/validate_input.h"
#include "space/filter_ray.h"
#include "space/filter_space.h"
#include "support/hard_numbers.h"

namespace pierce {
namespace {

using hard::Rng;
using hard::Style;

template <class Real>
Vec3<Real> point(Rng& rng, Style style) {
  return {hard::number<Real>(rng, style), hard::number<Real>(rng, style),
          hard::number<Real>(rng, style)};
}

template <class Real>
Ray<Real> hard_ray(Rng& rng, Style style) {
  Ray<Real> ray{point<Real>(rng, style), point<Real>(rng, style)};
  if (rng.coin()) ray.direction = point<Real>(rng, Style::Unit);
  if (rng.below(4) == 0) ray.direction.y = rng.coin() ? Real(0) : Real(-0.0);
  if (rng.coin()) ray.t_min = hard::number<Real>(rng, style);
  if (rng.coin()) ray.t_max = hard::number<Real>(rng, style);
  if (rng.below(4) == 0) ray.t_min = -std::numeric_limits<Real>::infinity();
  return ray;
}

// What a kernel may use of it.
std::array<std::uint32_t, 11> bits(const space::FilterRay& ray) {
  std::array<std::uint32_t, 11> all{};
  const float used[10] = {ray.origin[0],    ray.origin[1],    ray.origin[2], ray.direction[0],
                          ray.direction[1], ray.direction[2], ray.tau_min,   ray.tau_max,
                          ray.tau_first,    ray.tau_last};
  std::memcpy(all.data(), used, sizeof(used));
  all[10] = ray.exact ? 1 : 0;
  return all;
}

space::FilterSpace hard_space(Rng& rng, Style style) {
  const Vec3<double> p = point<double>(rng, style), q = point<double>(rng, style);
  return {{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
          {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
}

template <class Real>
void compare_affine(const kernels::Kernel& kernel, std::uint64_t& taken) {
  Rng rng(7, 0);
  for (int i = 0; i < 20000; ++i) {
    const Style style = hard::kAllStyles[rng.below(hard::kAllStyles.size())];
    const space::FilterSpace space = hard_space(rng, style);
    const space::AffineMap affine_map = space.affine_map(rng.coin());
    if (!affine_map.usable) continue;
    const Ray<Real> ray = hard_ray<Real>(rng, style);
    if (!scene::is_valid(ray)) continue;
    space::FilterRay wide;
    const bool there = kernel.of<Real>().transform_affine(affine_map, &ray, 1, &wide) == 1;
    if constexpr (std::is_same_v<Real, double>) {
      ASSERT_EQ(kernel.rays_mapped(affine_map, &ray, 1), there) << kernel.name << " case " << i;
    }
    if (!there) continue;
    ++taken;
    const space::TransformedRay transformed =
        space.transform(predicate::to_double(ray, Range::Closed));
    ASSERT_TRUE(transformed.origin_kept && !transformed.exactly && !transformed.misses);
    ASSERT_EQ(bits(wide), bits(space::filter_ray(transformed, affine_map.copies_exact)))
        << kernel.name << " case " << i;
  }
}

TEST(RayTransforms, the_affine_one_is_the_general_one_bit_by_bit) {
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    std::uint64_t floats = 0, doubles = 0;
    compare_affine<float>(*kernel, floats);
    compare_affine<double>(*kernel, doubles);
    if (std::string_view(kernel->name) == "plain") continue;
    EXPECT_GT(floats, 2000U);
    EXPECT_GT(doubles, 2000U);
  }
}

// Its ends, computed in float, are on the right sides of the true ones, and within an ulp of those
// computed in double.
bool has_range_of(const space::FilterRay& ray, const space::FilterRay& general,
                  const space::TransformedRay& transformed) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const auto near = [](float x, float y) {
    return std::nextafter(x, -kInf) <= y && y <= std::nextafter(x, kInf);
  };
  const double first = transformed.tau_min, last = transformed.tau_max;
  return static_cast<double>(ray.tau_min) < first && first < static_cast<double>(ray.tau_first) &&
         static_cast<double>(ray.tau_last) < last && last < static_cast<double>(ray.tau_max) &&
         near(ray.tau_min, general.tau_min) && near(ray.tau_max, general.tau_max) &&
         near(ray.tau_first, general.tau_first) && near(ray.tau_last, general.tau_last);
}

TEST(RayTransforms, scaling_is_the_general_one_bit_by_bit) {
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    Rng rng(8, 0);
    std::uint64_t taken = 0;
    for (int i = 0; i < 20000; ++i) {
      // A box about the origin is only scaled.
      const double reach = std::ldexp(1 + rng.unit(), rng.between(-90, 90));
      const space::FilterSpace space({-reach, -reach, -reach}, {reach, reach, reach});
      const Style style = hard::kTameStyles[rng.below(hard::kTameStyles.size())];
      Ray<float> ray = hard_ray<float>(rng, style);
      const auto to_scene = static_cast<float>(reach);
      if (rng.coin()) ray.origin = {to_scene, -to_scene / 3, to_scene / 7};
      if (!scene::is_valid(ray)) continue;
      space::FilterRay wide;
      const bool within = kernel->rays_within(kernels::scaled_limits(space.float_scale()), &ray, 1);
      const bool there = kernel->transform_scaled(space.float_scale(), &ray, 1, &wide) == 1;
      ASSERT_EQ(within, there) << kernel->name << " case " << i;
      if (!there) continue;
      ++taken;
      const space::TransformedRay transformed =
          space.transform(predicate::to_double(ray, Range::Closed));
      space::FilterRay general = space::filter_ray(transformed, true);
      ASSERT_TRUE(has_range_of(wide, general, transformed)) << kernel->name << " case " << i;
      std::copy(&wide.tau_min, &wide.tau_min + 4, &general.tau_min);
      ASSERT_EQ(bits(wide), bits(general)) << kernel->name << " case " << i;
    }
    if (std::string_view(kernel->name) == "plain") continue;
    EXPECT_GT(taken, 5000U);
  }
}

TEST(RayTransforms, a_batch_is_mapped_iff_all_its_rays_are) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Rng rng(10, 0);
  std::uint64_t yes = 0, no = 0;
  for (int i = 0; i < 4000; ++i) {
    const space::FilterSpace space({900, -2100, 30}, {1100 + rng.unit(), -1900, 31});
    const space::AffineMap map = space.affine_map(false);
    std::vector<Ray<double>> rays(1 + rng.below(40));
    for (Ray<double>& ray : rays) ray = {{1000, -2000 + rng.unit(), 31}, {rng.unit(), -1, 0}};
    // One number of one ray is what is taken only just, or not.
    static constexpr double kNumbers[] = {
        kInf,     -kInf,     kNaN,     -kNaN,    0,
        -0.0,     0x1p-1074, 0x1p-401, 0x1p-400, 0x1.fffffffffffffp400,
        -0x1p401, 4200,      4201,     -4200,    4300,
        5e300};
    Ray<double>& odd = rays[rng.below(rays.size())];
    (&odd.origin.x)[rng.below(8)] = kNumbers[rng.below(std::size(kNumbers))];
    if (rng.coin()) odd.direction = {0, 0, kNumbers[rng.below(std::size(kNumbers))]};
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      if (std::string_view(kernel->name) == "plain") continue;
      std::vector<space::FilterRay> out(rays.size());
      const bool all = kernel->doubles.transform_affine(map, rays.data(), rays.size(),
                                                        out.data()) == rays.size();
      ASSERT_EQ(kernel->rays_mapped(map, rays.data(), rays.size()), all)
          << kernel->name << " case " << i;
      (all ? yes : no) += 1;
    }
  }
  if (yes + no == 0) return;  // there is but the plain kernel
  EXPECT_GT(yes, 500U);
  EXPECT_GT(no, 500U);
}

TEST(RayTransforms, a_batch_is_within_limits_iff_all_its_rays_are) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const kernels::RayLimits valid_rays{std::numeric_limits<float>::max(),
                                      std::numeric_limits<float>::denorm_min(),
                                      std::numeric_limits<float>::max()};
  Rng rng(9, 0);
  for (int i = 0; i < 3000; ++i) {
    std::vector<Ray<float>> rays(1 + rng.below(40));
    for (Ray<float>& ray : rays) ray = hard_ray<float>(rng, hard::kAllStyles[rng.below(14)]);
    if (rng.coin()) {
      const std::size_t place = rng.below(8);
      float* numbers = &rays[rng.below(rays.size())].origin.x;
      numbers[place] = std::array<float, 4>{kInf, -kInf, kNaN, -kNaN}[rng.below(4)];
    }
    if (rng.below(4) == 0) rays[rng.below(rays.size())].direction = {0, -0.0F, 0};
    bool valid = true;
    for (const Ray<float>& ray : rays) valid &= scene::is_valid(ray);
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      const bool within = kernel->rays_within(valid_rays, rays.data(), rays.size());
      if (std::string_view(kernel->name) == "plain") {
        EXPECT_FALSE(within);
      } else {
        ASSERT_EQ(within, valid) << kernel->name << " case " << i;
      }
    }
  }
}

// What lanes take is not validated any more.
template <class Real>
void spoil(const kernels::Kernel& kernel) {
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();
  const space::FilterSpace space({-3, -2, -1}, {3, 2, 1});
  const auto takes = [&](const Ray<Real>& ray) {
    space::FilterRay out;
    bool taken = kernel.of<Real>().transform_affine(space.affine_map(true), &ray, 1, &out) == 1;
    if constexpr (std::is_same_v<Real, float>) {
      taken |= kernel.transform_scaled(space.float_scale(), &ray, 1, &out) == 1;
    }
    return taken;
  };
  const Ray<Real> good{{1, 2, 3}, {-1, Real(0.5), 2}, -kInf, kInf};
  EXPECT_EQ(takes(good), std::string_view(kernel.name) != "plain");
  for (std::size_t place = 0; place < 8; ++place) {
    for (const Real bad : {kInf, -kInf, kNaN, -kNaN}) {
      Ray<Real> ray = good;
      (&ray.origin.x)[place] = bad;
      if (scene::is_valid(ray)) continue;
      EXPECT_FALSE(takes(ray)) << kernel.name << ", number " << place << ": " << bad;
    }
  }
  Ray<Real> still = good;
  still.direction = {0, Real(-0.0), 0};
  EXPECT_FALSE(takes(still)) << kernel.name;
}

TEST(RayTransforms, no_lanes_take_a_ray_that_is_not_valid) {
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    spoil<float>(*kernel);
    spoil<double>(*kernel);
  }
}

}  // namespace
}  // namespace pierce
