// SPDX-License-Identifier: Apache-2.0
//
// HugeBuffer: alignment, moving, resizing.
#include <gtest/gtest.h>

#include <cstdint>
#include <new>
#include <utility>

#include "bvh/node.h"
#include "support/huge_buffer.h"

namespace pierce::bvh {
namespace {

bool is_aligned(const void* p, std::uintptr_t to) {
  return reinterpret_cast<std::uintptr_t>(p) % to == 0;
}

TEST(HugeBuffer, a_default_one_is_empty) {
  const HugeBuffer<int> buffer;
  EXPECT_EQ(buffer.size(), 0U);
  EXPECT_EQ(buffer.bytes(), 0U);
  EXPECT_EQ(buffer.data(), nullptr);
}

TEST(HugeBuffer, small_ones_are_aligned_to_a_cache_line_and_large_ones_to_a_huge_page) {
  for (const std::size_t size : {1U, 7U, 1000U}) {
    EXPECT_TRUE(is_aligned(HugeBuffer<char>(size).data(), 64));
    EXPECT_TRUE(is_aligned(HugeBuffer<Node>(size).data(), 64));
  }
  EXPECT_TRUE(is_aligned(HugeBuffer<char>(std::size_t{5} << 20).data(), std::size_t{2} << 20));
}

TEST(HugeBuffer, moving_hands_the_memory_over) {
  HugeBuffer<int> a(10);
  a[3] = 42;
  const int* data = a.data();
  HugeBuffer<int> b = std::move(a);
  EXPECT_EQ(b.data(), data);
  EXPECT_EQ(a.size(), 0U);  // NOLINT: moved-from is empty by contract
  a = std::move(b);
  EXPECT_EQ(a.data(), data);
  EXPECT_EQ(a[3], 42);
}

TEST(HugeBuffer, resizing_keeps_what_fits) {
  HugeBuffer<std::uint32_t> buffer(1000);
  for (std::uint32_t i = 0; i < 1000; ++i) buffer[i] = i;
  buffer.resize(3000000);
  ASSERT_EQ(buffer.size(), 3000000U);
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(buffer[i], i);
  buffer.resize(10);
  ASSERT_EQ(buffer.size(), 10U);
  for (std::uint32_t i = 0; i < 10; ++i) ASSERT_EQ(buffer[i], i);
  buffer.truncate(20);
  EXPECT_EQ(buffer.size(), 10U);
  buffer.truncate(4);
  EXPECT_EQ(buffer.bytes(), 16U);
  buffer.clear();
  EXPECT_EQ(buffer.size(), 0U);
}

TEST(HugeBuffer, an_impossible_size_throws) {
  EXPECT_THROW(HugeBuffer<Node>(~std::size_t{0} / 4), std::bad_alloc);
}

}  // namespace
}  // namespace pierce::bvh
