// SPDX-License-Identifier: Apache-2.0
#include "bvh/binary_build.h"

#include <algorithm>
#include <cstddef>

namespace pierce::bvh {
namespace {

constexpr int kBins = 16;
constexpr std::uint32_t kReportAt = 4096;
constexpr std::uint32_t kStopAt = 1;  // refs of a node that is not split further

/// Leaf blocks that n primitives need: the heuristic counts tests, and a test takes eight.
float blocks(std::uint32_t n) { return static_cast<float>((n + kWidth - 1) / kWidth); }

struct Bins {
  Float4 offset, scale;

  explicit Bins(const Box& centres) : offset(centres.lower) {
    const Float4 extent = centres.upper - centres.lower;
    for (int k = 0; k < 3; ++k) {
      scale[k] = extent[k] > 1e-30F ? static_cast<float>(kBins) * 0.9999F / extent[k] : 0.0F;
    }
    scale[3] = 0.0F;
  }
  [[nodiscard]] int index(Float4 centre2, int axis) const {
    return static_cast<int>((centre2[axis] - offset[axis]) * scale[axis]);
  }
};

struct Split {
  int axis = -1;
  int bin = 0;  // the first bin of the right side
};

Split best_split(const PrimitiveRef* refs, std::uint32_t count, const Bins& bins) {
  Box box[3][kBins];
  std::uint32_t filled[3][kBins] = {};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Float4 centre2 = refs[i].centre2();
    for (int axis = 0; axis < 3; ++axis) {
      const int bin = bins.index(centre2, axis);
      box[axis][bin].grow(refs[i].box);
      ++filled[axis][bin];
    }
  }

  Split best;
  float best_cost = 0;
  for (int axis = 0; axis < 3; ++axis) {
    float right_cost[kBins];
    Box right;
    std::uint32_t right_count = 0;
    for (int b = kBins - 1; b > 0; --b) {
      right.grow(box[axis][b]);
      right_count += filled[axis][b];
      right_cost[b] = right_count != 0 ? half_area(right) * blocks(right_count) : 0.0F;
    }
    Box left;
    std::uint32_t left_count = 0;
    for (int b = 1; b < kBins; ++b) {
      left.grow(box[axis][b - 1]);
      left_count += filled[axis][b - 1];
      if (left_count == 0 || left_count == count) continue;
      const float cost = half_area(left) * blocks(left_count) + right_cost[b];
      if (best.axis < 0 || cost < best_cost) {
        best_cost = cost;
        best = {axis, b};
      }
    }
  }
  return best;
}

class Builder {
 public:
  Builder(HugeBuffer<PrimitiveRef>& refs, BinaryTree& tree, BuildControl& control)
      : refs_(refs), nodes_(tree.nodes), control_(control) {}

  Forest build(std::uint32_t node, std::uint32_t begin, std::uint32_t end, int depth) {
    const std::uint32_t count = end - begin;
    if (count <= kStopAt) {
      Box box;
      for (std::uint32_t i = begin; i < end; ++i) box.grow(refs_[i].box);
      return make_binary_leaf(nodes_[node], box, begin, count);
    }
    const std::uint32_t middle = divide(begin, end, depth);
    const std::uint32_t left = used_;
    used_ += 2;
    const Forest left_forest = build(left, begin, middle, depth + 1);
    const Forest right_forest = build(left + 1, middle, end, depth + 1);
    if (count > kReportAt) {
      for (const Forest* forest : {&left_forest, &right_forest}) {
        if (forest->count <= kReportAt) control_.advance(forest->count);
      }
    }
    return join_forests(nodes_[node], left, left_forest, right_forest);
  }

 private:
  std::uint32_t divide(std::uint32_t begin, std::uint32_t end, int depth) {
    const std::uint32_t half = begin + (end - begin) / 2;
    if (depth >= kSahDepth) return half;
    Box centres;
    for (std::uint32_t i = begin; i < end; ++i) centres.grow(refs_[i].centre2());
    const Bins bins(centres);
    const Split split = best_split(&refs_[begin], end - begin, bins);
    if (split.axis < 0) return half;
    PrimitiveRef* middle = std::partition(
        &refs_[begin], refs_.data() + end,
        [&](const PrimitiveRef& ref) { return bins.index(ref.centre2(), split.axis) < split.bin; });
    return static_cast<std::uint32_t>(middle - refs_.data());
  }

  HugeBuffer<PrimitiveRef>& refs_;
  HugeBuffer<BinaryNode>& nodes_;
  BuildControl& control_;
  std::uint32_t used_ = 1;
};

}  // namespace

BinaryTree build_binary(HugeBuffer<PrimitiveRef>& refs, BuildControl& control) {
  BinaryTree tree;
  const auto count = static_cast<std::uint32_t>(refs.size());
  tree.nodes = HugeBuffer<BinaryNode>(2 * refs.size());
  tree.root = Builder(refs, tree, control).build(0, 0, count, 0);
  return tree;
}

}  // namespace pierce::bvh
