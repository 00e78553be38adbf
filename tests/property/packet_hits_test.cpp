// SPDX-License-Identifier: Apache-2.0
//
// Rays of a float scene that run alike are finished by the kernel itself, in rows of sixteen: their
// numbers, their names, and what lies behind the last of them.
#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/intersect.h"
#include "pierce/scene.h"
#include "support/compare_scene.h"

namespace pierce {
namespace {

// The plane z = x (1 + 2^-23), in one triangle. A ray along z that starts at x = 1.5 meets it half
// way between two floats.
class PacketHits : public testing::Test {
 protected:
  static constexpr float kSlope = 0x1.000002p0F;
  const std::vector<Vec3<float>> kPlane = {{0, -8, 0}, {0, 8, 0}, {2, 0, 2 * kSlope}};
  const std::vector<Vec3<float>> kBeyond = {{0, -8, 4}, {0, 8, 4}, {2, 0, 4}, {0, 0, 5}};
  const std::vector<Triangle> kOne = {{0, 1, 2}};
  const std::vector<Triangle> kTwo = {{0, 1, 2}, {1, 2, 3}};
  // The second mesh is the first to be hit.
  const std::vector<MeshView<float>> kMeshes = {{kBeyond, kTwo}, {kPlane, kOne}};

  static std::vector<Ray<float>> parallel_rays(std::uint32_t count, float x) {
    std::vector<Ray<float>> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
      rays.push_back({{x, static_cast<float>(i) / 1024 - 0.125F, 0}, {0, 0, 1}});
    }
    return rays;
  }
};

TEST_F(PacketHits, half_way_between_two_floats_goes_to_the_even_one) {
  const auto scene = Scene<float>::build(kMeshes);
  const auto rays = parallel_rays(256, 1.5F);
  std::vector<Hit<float>> hits(rays.size());
  scene.closest_hits(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    auto exact = intersect(rays[i], kPlane[0], kPlane[1], kPlane[2]);
    ASSERT_TRUE(exact.has_value());
    exact->geometry = 1;
    ASSERT_TRUE(show::same_bits(*exact, hits[i])) << i;
    ASSERT_EQ(hits[i].t, 0x1.800004p0F) << i;
  }
}

TEST_F(PacketHits, bear_the_names_that_single_rays_get) {
  const auto scene = Scene<float>::build(kMeshes);
  for (const float x : {0.3F, 0.7F, 1.1F, 1.9F}) {
    auto rays = parallel_rays(256, x);
    for (std::size_t i = 0; i < rays.size(); i += 3)
      rays[i].t_min = 3;  // these meet the first mesh
    std::vector<Hit<float>> hits(rays.size());
    scene.closest_hits(rays, hits);
    std::size_t of_first = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto single = scene.closest_hit(rays[i]).value_or(Hit<float>{});
      ASSERT_TRUE(show::same_bits(single, hits[i])) << i;
      of_first += hits[i].geometry == 0 ? 1 : 0;
    }
    EXPECT_GT(of_first, 0U);
  }
}

TEST_F(PacketHits, nothing_is_written_behind_the_last_ray) {
  const auto scene = Scene<float>::build(kMeshes);
  const Hit<float> mark{.t = -7, .u = -7, .v = -7, .w = -7, .geometry = 7, .triangle = 7};
  for (const std::uint32_t count : {1U, 3U, 15U, 16U, 17U, 33U, 63U, 64U, 65U, 250U, 256U, 271U}) {
    const auto rays = parallel_rays(count, 1.25F);
    std::vector<Hit<float>> hits(count + 64, mark);
    std::vector<std::uint8_t> any(count + 64, 7);
    scene.closest_hits(rays, std::span(hits).first(count));
    scene.any_hits(rays, std::span(any).first(count));
    for (std::uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(hits[i].geometry, 1U) << count << ' ' << i;
      ASSERT_EQ(any[i], 1) << count << ' ' << i;
    }
    for (std::uint32_t i = count; i < count + 64; ++i) {
      ASSERT_TRUE(show::same_bits(hits[i], mark)) << count << ' ' << i;
      ASSERT_EQ(any[i], 7) << count << ' ' << i;
    }
  }
}

}  // namespace
}  // namespace pierce
