// SPDX-License-Identifier: Apache-2.0
//
// The tree builder: structure on ordinary and degenerate input, determinism, stop and progress.
#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <vector>

#include "bvh/reinsertion.h"
#include "bvh/tree.h"
#include "pierce/error.h"
#include "support/bvh_sources.h"
#include "support/validate_tree.h"

namespace pierce::bvh {
namespace {

constexpr Quality kQualities[] = {Quality::Fast, Quality::Balanced, Quality::High,
                                  Quality::Compact};

BuildOptions with(Quality quality, unsigned threads = 0) {
  BuildOptions options;
  options.quality = quality;
  options.work.threads = threads;
  return options;
}

template <class T>
bool same_bytes(const HugeBuffer<T>& a, const HugeBuffer<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.bytes()) == 0);
}

bool same_bytes(const Tree& a, const Tree& b) {
  return a.root == b.root && same_bytes(a.nodes, b.nodes) && same_bytes(a.leaves, b.leaves) &&
         a.sah_cost == b.sah_cost;
}

TEST(BvhBuild, nothing_makes_an_empty_tree) {
  for (const Quality quality : kQualities) {
    const Generated source = random_soup(0);
    const Tree tree = build_tree(source, with(quality));
    EXPECT_EQ(tree.root, kNoChild);
    EXPECT_EQ(tree.bytes(), 0U);
    EXPECT_NO_THROW(validate_tree(tree, source));
  }
}

TEST(BvhBuild, one_triangle_is_a_leaf_root) {
  for (const Quality quality : kQualities) {
    const Generated source = random_soup(1);
    const Tree tree = build_tree(source, with(quality));
    ASSERT_TRUE(is_leaf(tree.root));
    EXPECT_EQ(leaf_count(tree.root), 1U);
    EXPECT_NO_THROW(validate_tree(tree, source));
  }
}

TEST(BvhBuild, trees_of_every_small_size_are_valid) {
  for (const Quality quality : kQualities) {
    for (std::uint32_t n = 1; n <= 70; ++n) {
      for (const Generated& source : all_sources(n)) {
        const Tree tree = build_tree(source, with(quality));
        EXPECT_NO_THROW(validate_tree(tree, source)) << source.name() << ", " << n;
      }
    }
  }
}

TEST(BvhBuild, large_trees_of_every_kind_are_valid) {
  for (const Quality quality : kQualities) {
    for (const Generated& source : all_sources(12000)) {
      const Tree tree = build_tree(source, with(quality));
      EXPECT_NO_THROW(validate_tree(tree, source)) << source.name();
      EXPECT_GT(tree.sah_cost, 0) << source.name();
    }
  }
}

TEST(BvhBuild, a_million_identical_triangles_make_full_leaves) {
  const Generated source = identical(1000000);
  const Tree tree = build_tree(source, with(Quality::Balanced));
  EXPECT_NO_THROW(validate_tree(tree, source));
  EXPECT_LT(static_cast<double>(tree.bytes()), 56e6);
}

TEST(BvhBuild, a_terrain_takes_at_most_56_bytes_a_triangle_and_12_if_compact) {
  const Generated source = grid(300);
  const Tree tree = build_tree(source, with(Quality::Balanced));
  EXPECT_LT(tree.bytes(), 56U * source.size());
  EXPECT_LT(build_tree(source, with(Quality::Compact)).bytes(), 12U * source.size());
}

TEST(BvhBuild, bytes_are_the_same_for_every_number_of_threads) {
  for (const Quality quality : kQualities) {
    for (const Generated& source : all_sources(20000)) {
      const Tree one = build_tree(source, with(quality, 1));
      EXPECT_TRUE(same_bytes(one, build_tree(source, with(quality, 2)))) << source.name();
    }
  }
}

TEST(BvhBuild, more_triangles_than_references_reach_are_refused_before_any_work) {
  for (const Quality quality : kQualities) {
    try {
      (void)build_tree(identical(4000000000U), with(quality));
      FAIL() << "did not throw";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::TooManyTriangles);
    }
  }
}

TEST(BvhBuild, a_stopped_build_throws) {
  std::atomic<bool> stop = false;
  stop = true;
  BuildOptions options;
  options.work.stop = &stop;
  try {
    (void)build(random_soup(100), options);
    FAIL() << "did not throw";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Stopped);
  }
}

TEST(BvhBuild, a_build_stopped_from_its_own_progress_throws) {
  std::atomic<bool> stop = false;
  BuildOptions options;
  options.work.stop = &stop;
  options.work.progress = [&](double fraction) {
    if (fraction > 0.3) stop = true;
  };
  EXPECT_THROW((void)build(random_soup(200000), options), Error);
}

TEST(BvhBuild, progress_rises_from_0_to_1) {
  std::vector<double> seen;
  BuildOptions options;
  options.work.progress = [&](double fraction) { seen.push_back(fraction); };
  (void)build(random_soup(100000), options);
  ASSERT_GE(seen.size(), 3U);
  EXPECT_GE(seen.front(), 0.0);
  EXPECT_EQ(seen.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
}

// A row of unit cubes, and the tree over them that halves it again and again, but for two eighths
// that have changed places.
constexpr std::uint32_t kRow = 1024;

Box cube(std::uint32_t i) {
  if (i / 128 == 1) {
    i += 5 * 128;
  } else if (i / 128 == 6) {
    i -= 5 * 128;
  }
  const auto x = static_cast<float>(i);
  return {Float4{x, 0, 0, 0}, Float4{x + 1, 1, 1, 0}};
}

Box halve_row(BinaryTree& tree, std::uint32_t node, std::uint32_t first, std::uint32_t count,
              std::uint32_t& used) {
  if (count == 1) {
    make_binary_leaf(tree.nodes[node], cube(first), first * kWidth, kWidth);
    return cube(first);
  }
  const std::uint32_t left = used;
  used += 2;
  Box box = halve_row(tree, left, first, count / 2, used);
  box.grow(halve_row(tree, left + 1, first + count / 2, count / 2, used));
  make_binary_parent(tree.nodes[node], box, left, count * kWidth);
  return box;
}

// The sum of the areas of its parents; marks what its leaves hold.
double area_below(const BinaryTree& tree, std::uint32_t n, std::vector<int>& held) {
  const BinaryNode& node = tree.nodes[n];
  if (!node.has_children()) {
    EXPECT_EQ(node.leaf_count(), std::uint32_t{kWidth});
    EXPECT_EQ(node.lower[0], cube(node.first / kWidth).lower[0]);
    ++held[node.first / kWidth];
    return 0;
  }
  const Box both = merged(box_of(tree.nodes[node.first]), box_of(tree.nodes[node.first + 1]));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(node.lower[k], both.lower[k]);
    EXPECT_EQ(node.upper[k], both.upper[k]);
  }
  return static_cast<double>(half_area(both)) + area_below(tree, node.first, held) +
         area_below(tree, node.first + 1, held);
}

TEST(BvhBuild, what_was_put_far_away_is_put_where_it_belongs) {
  BinaryTree tree;
  tree.nodes = HugeBuffer<BinaryNode>(2 * kRow);
  std::uint32_t used = 1;
  halve_row(tree, 0, 0, kRow, used);
  std::vector<int> held(kRow, 0);
  const double before = area_below(tree, 0, held);
  const WorkOptions work;
  BuildControl control(work);
  reinsert_largest(tree, control);
  held.assign(kRow, 0);
  const double after = area_below(tree, 0, held);
  for (const int times : held) EXPECT_EQ(times, 1);
  // Of the row as it should be: ten levels of length 1024, and 1023 nodes.
  constexpr double kLeast = 10 * 2 * kRow + (kRow - 1);
  EXPECT_GT(before, kLeast + 4000);
  EXPECT_LT(after, 1.05 * kLeast);
}

}  // namespace
}  // namespace pierce::bvh
