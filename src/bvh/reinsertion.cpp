// SPDX-License-Identifier: Apache-2.0
#include "bvh/reinsertion.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace pierce::bvh {
namespace {

/// The upper part has about two to the power of this nodes, but nothing below subtrees of fewer
/// than 2^kLeastWhole primitives. What is below moves as a whole. A larger part brought nothing:
/// what matters are the largest boxes.
constexpr int kUpperClass = 11;
constexpr int kLeastWhole = 4;

/// How many of these are taken out: the largest fifth. Neither all of them nor a second round
/// lowered the cost by as much as one per cent more.
constexpr std::size_t kPart = 5;

constexpr std::uint32_t kNobody = std::numeric_limits<std::uint32_t>::max();

/// A node of the upper part.
struct Upper {
  Box box;
  std::uint32_t parent = kNobody;
  std::uint32_t child[2] = {kNobody, kNobody};  // none: what is below moves as a whole
  std::uint32_t count = 0;                      // of the primitives below, at least half of it
};

class UpperTree {
 public:
  explicit UpperTree(const BinaryTree& tree)
      : tree_(tree),
        whole_class_(std::max(tree.nodes[0].size_class() - kUpperClass + 2, kLeastWhole)) {
    add(0, kNobody, 0);
  }

  /// Whether anything was put elsewhere.
  bool improve() {
    bool moved = false;
    for (const std::uint32_t node : largest()) moved |= reinsert(node);
    return moved;
  }

  /// False if it has become so deep that a traversal's stack might not do.
  [[nodiscard]] bool is_shallow() const { return is_shallow(0, 0); }

  /// Into the places that these nodes had.
  void write(BinaryTree& tree) {
    std::size_t next_pair = 0;
    write(tree, 0, 0, next_pair);
  }

 private:
  std::uint32_t add(std::uint32_t binary, std::uint32_t parent, int depth) {
    const BinaryNode& node = tree_.nodes[binary];
    const auto number = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({box_of(node), parent, {kNobody, kNobody}, 1U << node.size_class()});
    if (node.size_class() < whole_class_ || !node.has_children()) {
      // What is below was divided by planes down to kSahDepth, and then by count.
      height_.push_back(std::max(kSahDepth - depth, 0) + node.size_class() + 1);
      wholes_.push_back(node);
      nodes_[number].child[1] = static_cast<std::uint32_t>(wholes_.size() - 1);
      return number;
    }
    pairs_.push_back(node.first);
    const std::uint32_t left = add(node.first, number, depth + 1);
    const std::uint32_t right = add(node.first + 1, number, depth + 1);
    nodes_[number].child[0] = left;
    nodes_[number].child[1] = right;
    return number;
  }

  [[nodiscard]] bool is_whole(std::uint32_t n) const { return nodes_[n].child[0] == kNobody; }

  /// Numbers of the nodes with the largest boxes that have grandparents.
  [[nodiscard]] std::vector<std::uint32_t> largest() const {
    std::vector<std::uint32_t> numbers;
    numbers.reserve(nodes_.size());
    std::vector<float> areas(nodes_.size());
    for (std::uint32_t n = 1; n < nodes_.size(); ++n) {
      areas[n] = half_area(nodes_[n].box);
      if (nodes_[n].parent != 0) numbers.push_back(n);
    }
    const std::size_t most = numbers.size() / kPart;
    const auto larger = [&](std::uint32_t a, std::uint32_t b) {
      return areas[a] != areas[b] ? areas[a] > areas[b] : a < b;
    };
    std::partial_sort(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(most),
                      numbers.end(), larger);
    numbers.resize(most);
    return numbers;
  }

  /// The boxes from this node up.
  void refit_from(std::uint32_t n) {
    for (; n != kNobody; n = nodes_[n].parent) {
      Upper& node = nodes_[n];
      node.box = merged(nodes_[node.child[0]].box, nodes_[node.child[1]].box);
    }
  }

  void replace_child(std::uint32_t parent, std::uint32_t old_child, std::uint32_t child) {
    Upper& node = nodes_[parent];
    node.child[node.child[0] == old_child ? 0 : 1] = child;
    nodes_[child].parent = parent;
  }

  /// Takes a node out and puts it in again at the best place; whether that is another one.
  bool reinsert(std::uint32_t n) {
    const std::uint32_t parent = nodes_[n].parent;
    if (parent == kNobody || parent == 0) return false;
    const std::uint32_t sibling = nodes_[parent].child[nodes_[parent].child[0] == n ? 1 : 0];
    const std::uint32_t grandparent = nodes_[parent].parent;
    replace_child(grandparent, parent, sibling);
    refit_from(grandparent);
    const std::uint32_t beside = best_sibling(nodes_[n].box, sibling);
    replace_child(nodes_[beside].parent, beside, parent);
    nodes_[parent].child[0] = beside;
    nodes_[parent].child[1] = n;
    nodes_[beside].parent = parent;
    refit_from(parent);
    return beside != sibling;
  }

  /// Beside which node the box enlarges the others least; `now` if none is better than that.
  [[nodiscard]] std::uint32_t best_sibling(const Box& box, std::uint32_t now) {
    const float own = half_area(box);
    std::uint32_t best = now;
    float best_cost = half_area(merged(nodes_[now].box, box));
    for (std::uint32_t n = nodes_[now].parent; n != kNobody; n = nodes_[n].parent) {
      best_cost += half_area(merged(nodes_[n].box, box)) - half_area(nodes_[n].box);
    }
    const auto costs_more = [](const Open& a, const Open& b) {
      return a.cost != b.cost ? a.cost > b.cost : a.node > b.node;
    };
    open_.clear();
    const float at_root = half_area(merged(nodes_[0].box, box)) - half_area(nodes_[0].box);
    for (const std::uint32_t child : nodes_[0].child) open_.push_back({at_root, child});
    std::make_heap(open_.begin(), open_.end(), costs_more);
    while (!open_.empty() && open_.front().cost + own < best_cost) {
      const Open next = open_.front();
      std::pop_heap(open_.begin(), open_.end(), costs_more);
      open_.pop_back();
      const Upper& node = nodes_[next.node];
      const float cost = next.cost + half_area(merged(node.box, box));
      if (cost < best_cost) {
        best_cost = cost;
        best = next.node;
      }
      if (is_whole(next.node)) continue;
      const float below = cost - half_area(node.box);
      if (below + own >= best_cost) continue;
      for (const std::uint32_t child : node.child) {
        open_.push_back({below, child});
        std::push_heap(open_.begin(), open_.end(), costs_more);
      }
    }
    return best;
  }

  [[nodiscard]] bool is_shallow(std::uint32_t n, int depth) const {
    if (depth >= kMaxDepth) return false;
    if (is_whole(n)) return depth + height_[nodes_[n].child[1]] <= kMaxDepth;
    return is_shallow(nodes_[n].child[0], depth + 1) && is_shallow(nodes_[n].child[1], depth + 1);
  }

  std::uint32_t write(BinaryTree& tree, std::uint32_t n, std::uint32_t place,
                      std::size_t& next_pair) {
    if (is_whole(n)) {
      tree.nodes[place] = wholes_[nodes_[n].child[1]];
      return nodes_[n].count;
    }
    const std::uint32_t pair = pairs_[next_pair++];
    set_box(tree.nodes[place], nodes_[n].box);
    tree.nodes[place].first = pair;
    const std::uint32_t left = write(tree, nodes_[n].child[0], pair, next_pair);
    const std::uint32_t right = write(tree, nodes_[n].child[1], pair + 1, next_pair);
    tree.nodes[place].choice = BinaryNode::size_bits(left + right);
    return left + right;
  }

  /// A node that may have a better place in or below it, and what is enlarged on the way there.
  struct Open {
    float cost;
    std::uint32_t node;
  };

  const BinaryTree& tree_;
  int whole_class_;  // subtrees of smaller classes move as a whole
  std::vector<Upper> nodes_;
  std::vector<BinaryNode> wholes_;    // as they were
  std::vector<int> height_;           // of these, at most
  std::vector<std::uint32_t> pairs_;  // where children of the others were
  std::vector<Open> open_;            // a heap
};

}  // namespace

void reinsert_largest(BinaryTree& tree, BuildControl& control) {
  control.poll();
  UpperTree upper(tree);
  if (upper.improve() && upper.is_shallow()) upper.write(tree);
}

}  // namespace pierce::bvh
