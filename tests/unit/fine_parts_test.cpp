// SPDX-License-Identifier: Apache-2.0
//
// Which parts of a scene get spaces of their own: one for each heap of fine things far from the
// scene's centre, none where there is nothing so fine.
#include "scene/fine_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "support/rng.h"

namespace pierce::scene {
namespace {

using hard::Rng;
using Parts = std::vector<std::vector<std::uint32_t>>;

struct Soup {
  std::vector<Vec3<double>> vertices;
  std::vector<Triangle> triangles;

  // Triangles of this size within a cube of this width.
  void heap(Rng& rng, const Vec3<double>& middle, double width, double size, int count) {
    const auto near = [&](const Vec3<double>& p, double half) {
      return Vec3<double>{p.x + rng.within(half), p.y + rng.within(half), p.z + rng.within(half)};
    };
    for (int i = 0; i < count; ++i) {
      const Vec3<double> at = near(middle, width / 2);
      const auto first = static_cast<std::uint32_t>(vertices.size());
      for (int k = 0; k < 3; ++k) vertices.push_back(near(at, size / 2));
      triangles.push_back({first, first + 1, first + 2});
    }
  }
  [[nodiscard]] Parts parts() const {
    const MeshView<double> mesh{vertices, triangles};
    const Geometries<double> geometries(std::span(&mesh, 1), {});
    Parts parts = fine_parts(bvh::build(geometries, {}));
    std::vector<std::uint32_t> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    for (std::uint32_t i = 0; i < all.size(); ++i) EXPECT_EQ(all[i], i);
    EXPECT_EQ(all.size(), parts.empty() ? 0 : triangles.size());
    return parts;
  }
};

TEST(FineParts, what_is_not_fine_has_none) {
  Rng rng(1);
  Soup soup;
  soup.heap(rng, {0, 0, 0}, 1e7, 1e5, 3000);
  EXPECT_TRUE(soup.parts().empty());
}

TEST(FineParts, a_heap_is_one_part_wherever_it_lies) {
  for (const Vec3<double>& place : {Vec3<double>{0, 0, 5e6}, Vec3<double>{3e6, -2e6, 4e6}}) {
    Rng rng(2);
    Soup soup;
    soup.heap(rng, place, 1, 1e-3, 20000);
    soup.heap(rng, {0, 0, 0}, 1e7, 1e5, 3000);
    const Parts parts = soup.parts();
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].size(), 20000U);
    EXPECT_EQ(parts[0].back(), 19999U);
  }
}

TEST(FineParts, heaps_far_from_each_other_stay_apart) {
  Rng rng(3);
  Soup soup;
  soup.heap(rng, {0, 0, 5e6}, 1, 1e-3, 2000);
  soup.heap(rng, {2e4, 0, 5e6}, 1, 1e-3, 2000);
  soup.heap(rng, {0, 5e6, 0}, 1, 1e-3, 2000);
  soup.heap(rng, {0, 0, 0}, 1e7, 1e5, 3000);
  const Parts parts = soup.parts();
  ASSERT_EQ(parts.size(), 4U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(parts[static_cast<std::size_t>(i)].size(), 2000U);
}

}  // namespace
}  // namespace pierce::scene
