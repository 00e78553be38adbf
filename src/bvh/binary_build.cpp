// SPDX-License-Identifier: Apache-2.0
#include "bvh/binary_build.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <vector>

#include "bvh/binning.h"
#include "bvh/partition.h"
#include "bvh/spatial_split.h"
#include "support/parallel.h"

namespace pierce::bvh {
namespace {

// Sizes at which the work is done differently. They depend on the input alone, so that the tree
// does, too.
constexpr std::uint32_t kParallelPartition = 1U << 18;  // all threads move the refs of one node
constexpr std::uint32_t kTask = 1U << 12;               // both children may be built at once
constexpr std::uint32_t kNodeChunk = 512;               // nodes that a task takes at a time

/// Progress is counted in passes over refs: so many are what a subtree of at most kTask takes.
constexpr std::uint64_t kTaskPasses = 20;

/// Spatial splits are tried where the boxes of the best object split share more than this part of
/// the scene's area (Stich et al.'s alpha).
constexpr float kOverlapWorthACut = 1e-5F;

/// A cut doubles refs, and boxes that share nothing end a search for any hit later than large ones:
/// it has to be so much better.
constexpr float kCutGain = 0.95F;

/// Of so little of their box's area refs are apart rather than together.
constexpr float kSparse = 0.25F;

/// Smaller nodes are not worth the search: fewer than this cut nothing that showed in the cost.
constexpr std::uint32_t kCutFrom = 128;

/// The refs of one node, and the stretch of the two buffers that belongs to it. There may be more
/// room than refs: that is what spatial splits may still use up.
struct Run {
  PrimitiveRef* refs;  // somewhere in `here`
  std::uint32_t count;
  PrimitiveRef* here;   // the stretch in the buffer of the refs
  PrimitiveRef* there;  // the stretch in the other buffer
  std::uint32_t room;
  std::uint32_t first;  // where the stretch begins in the buffers
};

/// The refs of a run that may become a leaf.
struct Gathering {
  Box box;
  float areas = 0;
  std::uint32_t count;

  explicit Gathering(const Run& run) : count(run.count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      box.grow(run.refs[i].box);
      areas += half_area(run.refs[i].box);
    }
  }
  /// Whether they are so far apart that a line which meets the box hardly meets one.
  [[nodiscard]] bool is_sparse() const { return count > 1 && areas < kSparse * half_area(box); }
};

/// What a parent must know of its child.
struct Subtree {
  Box box;
  std::uint32_t count = 0;  // primitives below
};

/// The two halves of a run that has been divided.
struct Halves {
  Run left, right;
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
  Builder(BinaryTree& tree, const Primitives& primitives, const BinaryBuildSettings& settings,
          BuildControl& control)
      : nodes_(tree.nodes),
        order_(tree.order),
        primitives_(primitives),
        settings_(settings),
        control_(control) {}

  void build_root(const Run& run) {
    if (settings_.spatial_splits) {
      Box box;
      for (std::uint32_t i = 0; i < run.count; ++i) box.grow(run.refs[i].box);
      overlap_worth_a_cut_ = kOverlapWorthACut * half_area(box);
    }
    build(0, run, 0);
  }

 private:
  Subtree build(std::uint32_t node, const Run& run, int depth) {
    if (run.count <= kTask) {
      NodeSource source(used_, run.room);
      const Subtree subtree = build_serial(node, run, depth, source);
      control_.advance(kTaskPasses * run.count);
      return subtree;
    }
    const Halves halves = divide(run, depth);
    control_.advance(run.count);
    const std::uint32_t left = used_.fetch_add(2, std::memory_order_relaxed);
    Subtree of_left, of_right;
    parallel::invoke([&] { of_left = build(left, halves.left, depth + 1); },
                     [&] { of_right = build(left + 1, halves.right, depth + 1); });
    return join(node, left, of_left, of_right);
  }

  Subtree build_serial(std::uint32_t node, const Run& run, int depth, NodeSource& source) {
    if (run.count <= settings_.stop_at) {
      const Gathering gathering(run);
      if (!gathering.is_sparse()) return build_leaf(node, run, gathering.box);
    }
    const Halves halves = divide(run, depth);
    const std::uint32_t left = source.take_pair();
    const Subtree of_left = build_serial(left, halves.left, depth + 1, source);
    const Subtree of_right = build_serial(left + 1, halves.right, depth + 1, source);
    return join(node, left, of_left, of_right);
  }

  Subtree join(std::uint32_t node, std::uint32_t left, const Subtree& of_left,
               const Subtree& of_right) {
    const Subtree both{merged(of_left.box, of_right.box), of_left.count + of_right.count};
    make_binary_parent(nodes_[node], both.box, left, both.count);
    return both;
  }

  Subtree build_leaf(std::uint32_t node, const Run& run, const Box& box) {
    for (std::uint32_t i = 0; i < run.count; ++i) order_[run.first + i] = run.refs[i].primitive();
    make_binary_leaf(nodes_[node], box, run.first, run.count);
    return {box, run.count};
  }

  Halves divide(const Run& run, int depth) {
    if (depth >= kSahDepth) return divide_by_count(run);
    std::vector<PrimitiveRef> sample;
    const PrimitiveRef* refs = run.refs;
    std::uint32_t count = run.count;
    float weight = 1.0F;
    if (run.count > 2 * settings_.sample) {
      sample = take_sample(run);
      refs = sample.data();
      count = settings_.sample;
      weight = static_cast<float>(run.count) / static_cast<float>(count);
    }
    const Split split = find_split(refs, count, weight);
    const bool try_cutting = settings_.spatial_splits && run.count >= kCutFrom &&
                             run.count < run.room &&
                             (!split.found() || split.common_area > overlap_worth_a_cut_);
    if (try_cutting) {
      const SpatialSplit cut = find_spatial_split(refs, count, weight, primitives_);
      const float refs_after = weight * static_cast<float>(cut.sides.left + cut.sides.right);
      if (cut.found() && (!split.found() || cut.cost < kCutGain * split.cost) &&
          refs_after <= static_cast<float>(run.room)) {
        const std::optional<Sides> sides = partition(run.refs, run.count, cut, primitives_,
                                                     run.there, run.there + run.room, control_);
        if (sides) return halves_there(run, sides->left, sides->right);
      }
    }
    if (!split.found()) return divide_by_count(run);
    PrimitiveRef* end = run.there + run.room;
    const std::uint32_t left =
        run.count > kParallelPartition
            ? partition_parallel(run.refs, run.count, split, run.there, end, control_)
            : partition(run.refs, run.count, split, run.there, end);
    return halves_there(run, left, run.count - left);
  }

  /// The refs were moved to the two ends of the other stretch. Each half gets its share of the
  /// room.
  static Halves halves_there(const Run& run, std::uint32_t left, std::uint32_t right) {
    const std::uint64_t spare = run.room - left - right;
    const auto room = left + static_cast<std::uint32_t>(spare * left / (left + right));
    return {{run.there, left, run.there, run.here, room, run.first},
            {run.there + run.room - right, right, run.there + room, run.here + room,
             run.room - room, run.first + room}};
  }

  /// Where no plane helps, the refs stay where they are.
  static Halves divide_by_count(const Run& run) {
    const std::uint32_t half = run.count / 2;
    const auto room = static_cast<std::uint32_t>(run.refs - run.here) + half;
    return {{run.refs, half, run.here, run.there, room, run.first},
            {run.refs + half, run.count - half, run.here + room, run.there + room, run.room - room,
             run.first + room}};
  }

  /// The plane for a large run does not need all of it: counts and areas of a sample of some
  /// thousands are good to a per cent, and the boxes of the tree are made bottom-up anyway.
  [[nodiscard]] std::vector<PrimitiveRef> take_sample(const Run& run) const {
    const std::uint32_t stride = run.count / settings_.sample;
    std::vector<PrimitiveRef> sample(settings_.sample);
    std::uint32_t random = 1;
    for (std::uint32_t i = 0; i < settings_.sample; ++i) {
      random = random * 1664525U + 1013904223U;  // so that no period of the mesh is met
      sample[i] = run.refs[i * stride + (random >> 8) % stride];
    }
    return sample;
  }

  HugeBuffer<BinaryNode>& nodes_;
  HugeBuffer<std::uint32_t>& order_;
  const Primitives& primitives_;
  const BinaryBuildSettings& settings_;
  BuildControl& control_;
  float overlap_worth_a_cut_ = 0;
  std::atomic<std::uint32_t> used_{1};
};

}  // namespace

std::uint64_t binary_build_steps(std::uint32_t count) {
  const auto passes = static_cast<std::uint64_t>(std::bit_width(count / kTask));
  return count * (passes + kTaskPasses);
}

BinaryTree build_binary(PrimitiveRef* refs, PrimitiveRef* scratch, std::uint32_t count,
                        std::uint32_t capacity, const Primitives& primitives,
                        const BinaryBuildSettings& settings, BuildControl& control) {
  BinaryTree tree;
  // At most 2 n - 1 nodes for n refs, and at most as many again in chunks that are not used up.
  // What is not used is never touched.
  tree.nodes = HugeBuffer<BinaryNode>(4 * std::size_t{capacity});
  tree.order = HugeBuffer<std::uint32_t>(capacity);
  Builder(tree, primitives, settings, control)
      .build_root({refs, count, refs, scratch, capacity, 0});
  return tree;
}

}  // namespace pierce::bvh
