// SPDX-License-Identifier: Apache-2.0
#include "bvh/binary_build.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

#include "bvh/binning.h"
#include "bvh/partition.h"

namespace pierce::bvh {
namespace {

// Sizes at which the work is done differently. They depend on the input alone, so that the tree
// does, too.
constexpr std::uint32_t kParallelPartition = 1U << 18;  // all threads move the refs of one node
constexpr std::uint32_t kTask = 1U << 12;               // both children may be built at once
constexpr std::uint32_t kNodeChunk = 512;               // nodes that a task takes at a time

/// A run of refs, and the same run of the other buffer to move them to.
struct Run {
  PrimitiveRef* refs;
  PrimitiveRef* other;
  std::uint32_t count;

  [[nodiscard]] Run part(std::uint32_t begin, std::uint32_t end) const {
    return {refs + begin, other + begin, end - begin};
  }
};

/// Pairs of nodes for one task, taken from the common store by the chunk.
class NodeSource {
 public:
  NodeSource(std::atomic<std::uint32_t>& used, std::uint32_t refs)
      : used_(used), chunk_(std::min(kNodeChunk, 2 * refs)) {}

  std::uint32_t take_pair() {
    if (next_ == end_) {
      next_ = used_.fetch_add(chunk_, std::memory_order_relaxed);
      end_ = next_ + chunk_;
    }
    next_ += 2;
    return next_ - 2;
  }

 private:
  std::atomic<std::uint32_t>& used_;
  std::uint32_t chunk_;
  std::uint32_t next_ = 0, end_ = 0;
};

class Builder {
 public:
  Builder(BinaryTree& tree, const BinaryBuildSettings& settings, BuildControl& control)
      : nodes_(tree.nodes), order_(tree.order), settings_(settings), control_(control) {}

  /// `first` is the place of the run in the final order.
  Forest build(std::uint32_t node, Run run, std::uint32_t first, int depth) {
    if (run.count <= kTask) {
      NodeSource source(used_, run.count);
      const Forest forest = build_serial(node, run, first, depth, source);
      control_.advance(run.count);
      return forest;
    }
    control_.poll();
    const std::uint32_t middle = divide(run, depth);
    const std::uint32_t left = used_.fetch_add(2, std::memory_order_relaxed);
    Forest left_forest, right_forest;
    tbb::parallel_invoke([&] { left_forest = build(left, run.part(0, middle), first, depth + 1); },
                         [&] {
                           right_forest = build(left + 1, run.part(middle, run.count),
                                                first + middle, depth + 1);
                         });
    return join_forests(nodes_[node], left, left_forest, right_forest);
  }

 private:
  Forest build_serial(std::uint32_t node, Run run, std::uint32_t first, int depth,
                      NodeSource& source) {
    if (run.count <= settings_.stop_at) return build_leaf(node, run, first);
    const std::uint32_t middle = divide(run, depth);
    const std::uint32_t left = source.take_pair();
    const Forest left_forest = build_serial(left, run.part(0, middle), first, depth + 1, source);
    const Forest right_forest =
        build_serial(left + 1, run.part(middle, run.count), first + middle, depth + 1, source);
    return join_forests(nodes_[node], left, left_forest, right_forest);
  }

  Forest build_leaf(std::uint32_t node, Run run, std::uint32_t first) {
    Box box;
    for (std::uint32_t i = 0; i < run.count; ++i) {
      box.grow(run.refs[i].box);
      order_[first + i] = run.refs[i].primitive();
    }
    return make_binary_leaf(nodes_[node], box, first, run.count);
  }

  /// Orders the run in two, not necessarily in the same buffer; returns the size of the left part.
  std::uint32_t divide(Run& run, int depth) {
    if (depth >= kSahDepth) return run.count / 2;
    const Split split = run.count > 2 * settings_.sample ? find_split_by_sample(run)
                                                         : find_split(run.refs, run.count, 1.0F);
    if (!split.found()) return run.count / 2;
    const std::uint32_t middle = run.count > kParallelPartition
                                     ? partition_parallel(run.refs, run.other, run.count, split)
                                     : partition(run.refs, run.other, run.count, split);
    std::swap(run.refs, run.other);
    return middle;
  }

  /// The plane for a large run does not need all of it: counts and areas of a sample of some
  /// thousands are good to a per cent, and the boxes of the tree are made bottom-up anyway.
  Split find_split_by_sample(const Run& run) {
    const std::uint32_t stride = run.count / settings_.sample;
    std::vector<PrimitiveRef> sample(settings_.sample);
    std::uint32_t random = 1;
    for (std::uint32_t i = 0; i < settings_.sample; ++i) {
      random = random * 1664525U + 1013904223U;  // so that no period of the mesh is met
      sample[i] = run.refs[i * stride + (random >> 8) % stride];
    }
    return find_split(sample.data(), settings_.sample, static_cast<float>(stride));
  }

  HugeBuffer<BinaryNode>& nodes_;
  HugeBuffer<std::uint32_t>& order_;
  const BinaryBuildSettings& settings_;
  BuildControl& control_;
  std::atomic<std::uint32_t> used_{1};
};

}  // namespace

BinaryTree build_binary(PrimitiveRef* refs, PrimitiveRef* scratch, std::uint32_t count,
                        const BinaryBuildSettings& settings, BuildControl& control) {
  BinaryTree tree;
  // At most 2 n - 1 nodes, and at most as many again in chunks that are not used up. What is not
  // used is never touched.
  tree.nodes = HugeBuffer<BinaryNode>(4 * std::size_t{count});
  tree.order = HugeBuffer<std::uint32_t>(count);
  Builder(tree, settings, control).build(0, {refs, scratch, count}, 0, 0);
  return tree;
}

}  // namespace pierce::bvh
