// SPDX-License-Identifier: Apache-2.0
#include "bvh/partition.h"

#include <algorithm>
#include <vector>

#include "support/parallel.h"

namespace pierce::bvh {
namespace {

constexpr std::uint32_t kBlock = 8192;

}  // namespace

std::uint32_t partition_parallel(const PrimitiveRef* from, std::uint32_t count, const Split& split,
                                 PrimitiveRef* left, PrimitiveRef* right,
                                 const BuildControl& control) {
  const std::uint32_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::uint32_t> left_of(blocks);  // in the block, then before the block
  parallel::for_each(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
    control.poll();
    const std::uint32_t begin = block * kBlock;
    const std::uint32_t end = std::min(begin + kBlock, count);
    std::uint32_t in_block = 0;
    for (std::uint32_t i = begin; i < end; ++i) in_block += split.is_left(from[i]) ? 1 : 0;
    left_of[block] = in_block;
  });
  std::uint32_t all_left = 0;
  for (std::uint32_t& of_block : left_of) {
    const std::uint32_t before = all_left;
    all_left += of_block;
    of_block = before;
  }
  PrimitiveRef* const right_begin = right - (count - all_left);
  parallel::for_each(std::uint32_t{0}, blocks, [&](std::uint32_t block) {
    control.poll();
    const std::uint32_t begin = block * kBlock;
    const std::uint32_t end = std::min(begin + kBlock, count);
    PrimitiveRef* place[2] = {right_begin + (begin - left_of[block]), left + left_of[block]};
    for (std::uint32_t i = begin; i < end; ++i) {
      *place[split.is_left(from[i]) ? 1 : 0]++ = from[i];
    }
  });
  return all_left;
}

}  // namespace pierce::bvh
