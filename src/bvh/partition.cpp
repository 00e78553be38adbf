// SPDX-License-Identifier: Apache-2.0
#include "bvh/partition.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <vector>

namespace pierce::bvh {
namespace {

constexpr std::uint32_t kBlock = 8192;

}  // namespace

std::uint32_t partition_parallel(const PrimitiveRef* from, PrimitiveRef* to, std::uint32_t count,
                                 const Split& split) {
  const std::uint32_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::uint32_t> left_of(blocks);  // in the block, then before the block
  tbb::parallel_for(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
    const std::uint32_t begin = block * kBlock;
    const std::uint32_t end = std::min(begin + kBlock, count);
    std::uint32_t left = 0;
    for (std::uint32_t i = begin; i < end; ++i) left += split.is_left(from[i]) ? 1 : 0;
    left_of[block] = left;
  });
  std::uint32_t all_left = 0;
  for (std::uint32_t& left : left_of) {
    const std::uint32_t before = all_left;
    all_left += left;
    left = before;
  }
  tbb::parallel_for(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
    const std::uint32_t begin = block * kBlock;
    const std::uint32_t end = std::min(begin + kBlock, count);
    PrimitiveRef* place[2] = {to + all_left + (begin - left_of[block]), to + left_of[block]};
    for (std::uint32_t i = begin; i < end; ++i) {
      *place[split.is_left(from[i]) ? 1 : 0]++ = from[i];
    }
  });
  return all_left;
}

}  // namespace pierce::bvh
