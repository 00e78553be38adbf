// SPDX-License-Identifier: Apache-2.0
//
// Refit: the same structure around moved corners.
#include <gtest/gtest.h>

#include <cstring>

#include "bvh/tree.h"
#include "support/bvh_sources.h"
#include "support/validate_tree.h"

namespace pierce::bvh {
namespace {

constexpr Quality kQualities[] = {Quality::Fast, Quality::Balanced, Quality::High,
                                  Quality::Compact};

/// The source with every corner moved by up to 0.01, each triangle its own way.
Generated moved(const Generated& source) {
  return {source.name(), source.size(), [&source](std::uint32_t i) {
            const Vec3<double> by = random_point(i, 0.01);
            const Corners t = source.corners(i);
            return Corners{sum(t.a, by), sum(t.b, by), sum(t.c, by)};
          }};
}

Tree build_with(const Generated& source, Quality quality) {
  BuildOptions options;
  options.quality = quality;
  return build_tree(source, options);
}

TEST(BvhRefit, a_refitted_tree_is_valid_for_the_moved_triangles) {
  for (const Quality quality : kQualities) {
    for (const std::uint32_t n : {1U, 5U, 9U, 100U, 20000U}) {
      for (const Generated& source : all_sources(n)) {
        const Generated after = moved(source);
        Tree tree = build_with(source, quality);
        refit(tree, after, {.threads = 2});
        EXPECT_NO_THROW(validate_tree(tree, after)) << source.name() << ", " << n;
      }
    }
  }
}

TEST(BvhRefit, a_refit_to_unmoved_triangles_changes_nothing) {
  const Generated source = random_soup(20000);
  const Tree before = build_with(source, Quality::Balanced);
  Tree after = build_with(source, Quality::Balanced);
  refit(after, source, {.threads = 1});
  EXPECT_EQ(std::memcmp(before.nodes.data(), after.nodes.data(), before.nodes.bytes()), 0);
  EXPECT_EQ(std::memcmp(before.leaves.data(), after.leaves.data(), before.leaves.bytes()), 0);
  EXPECT_EQ(before.sah_cost, after.sah_cost);
}

TEST(BvhRefit, a_refit_costs_more_than_a_build_when_neighbours_part) {
  const Generated source = random_soup(20000);
  const Generated scattered("scattered", source.size(), [](std::uint32_t i) {
    const Vec3<double> a = random_point(1000000ULL + i, 0.9);
    return Corners{a, sum(a, {0.01, 0, 0}), sum(a, {0, 0.01, 0})};
  });
  Tree tree = build_with(source, Quality::Balanced);
  refit(tree, scattered, {.threads = 0});
  EXPECT_NO_THROW(validate_tree(tree, scattered));
  EXPECT_GT(tree.sah_cost, 5 * build_with(scattered, Quality::Balanced).sah_cost);
}

TEST(BvhRefit, an_empty_tree_stays_empty) {
  Tree tree;
  refit(tree, random_soup(0), {.threads = 0});
  EXPECT_EQ(tree.root, kNoChild);
}

}  // namespace
}  // namespace pierce::bvh
