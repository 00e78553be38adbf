// SPDX-License-Identifier: Apache-2.0
//
// What a walk sees of a leaf is the same in both layouts, byte by byte.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "bvh/leaf_access.h"
#include "bvh/leaf_block.h"
#include "bvh/tree.h"
#include "support/bvh_sources.h"

namespace pierce::bvh {
namespace {

class TwoTrees {
 public:
  explicit TwoTrees(const Primitives& source)
      : full_(build(source, {}, Layout::Full)), compact_(build(source, {}, Layout::Compact)) {}

  /// Compares all leaves below two references, one to each tree; returns how many triangles.
  std::size_t compare(std::uint32_t in_full, std::uint32_t in_compact) {
    if (is_leaf(in_full)) return compare_leaves(in_full, in_compact);
    std::size_t triangles = 0;
    for (int lane = 0; lane < kWidth && full_.nodes[in_full].child[lane] != kNoChild; ++lane) {
      triangles +=
          compare(full_.nodes[in_full].child[lane], compact_.nodes[in_compact].child[lane]);
    }
    return triangles;
  }
  std::size_t compare() { return compare(full_.root, compact_.root); }

 private:
  std::size_t compare_leaves(std::uint32_t in_full, std::uint32_t in_compact) {
    const std::uint32_t n = leaf_count(in_full);
    EXPECT_EQ(leaf_count(in_compact), n);
    const std::size_t bytes = leaf_units(Layout::Full, n) * std::size_t{kLeafUnit};
    const float* kept = leaf_block(full_, in_full, scratch_);
    EXPECT_NE(reinterpret_cast<const std::byte*>(kept), scratch_.bytes);
    const float* fetched = leaf_block(compact_, in_compact, scratch_);
    EXPECT_EQ(std::memcmp(kept, fetched, bytes), 0);
    const std::size_t numbers = n * sizeof(std::uint32_t);
    EXPECT_EQ(
        std::memcmp(leaf_numbers(full_, in_full), leaf_numbers(compact_, in_compact), numbers), 0);
    EXPECT_EQ(std::memcmp(leaf_numbers(full_, in_full), fetched + bvh::kLeafHead + 9 * n, numbers),
              0);
    return n;
  }

  Tree full_, compact_;
  LeafScratch scratch_;
};

TEST(BvhLeafAccess, a_compact_leaf_is_fetched_as_the_full_tree_keeps_it) {
  for (const std::uint32_t n : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 100U, 5000U}) {
    for (const Generated& source : all_sources(n)) {
      EXPECT_EQ(TwoTrees(source).compare(), source.size()) << source.name();
    }
  }
}

// Lanes beyond a leaf's triangles read them as floats, and subnormal ones are slow.
TEST(BvhLeafAccess, numbers_are_kept_as_floats_that_are_not_subnormal) {
  for (const std::uint32_t number : {0U, 1U, 1000U, (1U << 23) - 1, 1U << 23, (1U << 28) + 5}) {
    EXPECT_EQ(std::uint32_t{LeafNumber(number)}, number);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(LeafNumber(number)))) << number;
  }
}

TEST(BvhLeafAccess, only_a_compact_tree_looks_at_its_primitives_again) {
  const Generated source = random_soup(100);
  EXPECT_EQ(build(source, {}, Layout::Full).primitives, nullptr);
  EXPECT_EQ(build(source, {}, Layout::Compact).primitives, &source);
}

}  // namespace
}  // namespace pierce::bvh
