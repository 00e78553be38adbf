// SPDX-License-Identifier: Apache-2.0
#include "scene/file/check_tree.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <vector>

#include "bvh/leaf_access.h"
#include "bvh/leaf_block.h"
#include "support/parallel.h"

namespace pierce::scene {
namespace {

using bvh::kNoChild;
using bvh::kWidth;
using bvh::Node;

constexpr std::size_t kNodesPerTask = 16384;

// The lanes that four places of an order name, a bit each.
constexpr std::size_t kHalfOrder = std::size_t{1} << (4 * bvh::kOrderBits);
using LanesNamed = std::array<std::uint8_t, kHalfOrder>;

LanesNamed lanes_named() {
  LanesNamed table{};
  for (std::size_t word = 0; word < kHalfOrder; ++word) {
    for (int place = 0; place < 4; ++place)
      table[word] |= static_cast<std::uint8_t>(1U << ((word >> (bvh::kOrderBits * place)) & 7U));
  }
  return table;
}

// Whether it names each of the eight lanes, and so each once.
bool is_order(std::uint32_t word, const LanesNamed& named) {
  return (named[word % kHalfOrder] | named[(word / kHalfOrder) % kHalfOrder]) == 0xff &&
         word < kHalfOrder * kHalfOrder;
}

bool is_empty_box(const Node& node, int lane) {
  bool empty = true;
  for (int k = 0; k < 3; ++k) {
    empty &= node.lower[k][lane] == bvh::kEmptyPlane && node.upper[k][lane] == -bvh::kEmptyPlane;
  }
  return empty;
}

bool is_leaf_there(const bvh::Tree& tree, std::uint32_t ref) {
  const std::size_t end =
      (std::size_t{bvh::leaf_offset(ref)} + bvh::leaf_units(tree.layout, bvh::leaf_count(ref))) *
      bvh::kLeafUnit;
  return end + bvh::kLeafSlack <= tree.leaves.size();
}

// Of each node the number of the one that refers to it, plus one; 0: none does.
using Parents = std::vector<std::atomic<std::uint32_t>>;

// What a node, or the nodes of a range, showed.
struct Seen {
  const char* fault = nullptr;  // the first one
  std::size_t inner = 0;        // references to nodes
};

Seen see_node(const bvh::Tree& tree, std::uint32_t number, const LanesNamed& named,
              Parents& parents) {
  const Node& node = tree.nodes[number];
  std::size_t inner = 0;
  for (int lane = 0; lane < kWidth; ++lane) {
    const std::uint32_t ref = node.child[lane];
    if (bvh::is_leaf(ref)) {
      if (!is_leaf_there(tree, ref)) return {"a leaf of the search tree is not there"};
    } else if (ref == kNoChild) {
      if (!is_empty_box(node, lane)) return {"a child that is not there has a box"};
    } else if (ref <= number || ref >= tree.nodes.size()) {
      return {"a node of the search tree is not there"};
    } else {
      parents[ref].store(number + 1, std::memory_order_relaxed);
      ++inner;
    }
  }
  constexpr std::uint32_t kOrderMask = (1U << bvh::kAcrossBit) - 1;
  for (const std::uint32_t order : node.order) {
    if (!is_order(order & kOrderMask, named)) {
      return {"a node has an order that leaves out a child"};
    }
  }
  return {nullptr, inner};
}

Seen see_nodes(const bvh::Tree& tree, Parents& parents) {
  const LanesNamed named = lanes_named();
  return parallel::reduce(
      std::size_t{0}, tree.nodes.size(), kNodesPerTask, Seen{},
      [&](std::size_t first, std::size_t last) {
        Seen all;
        for (std::size_t i = first; i != last && all.fault == nullptr; ++i) {
          const Seen one = see_node(tree, static_cast<std::uint32_t>(i), named, parents);
          all = {one.fault, all.inner + one.inner};
        }
        return all;
      },
      [](const Seen& left, const Seen& right) {
        return Seen{left.fault != nullptr ? left.fault : right.fault, left.inner + right.inner};
      });
}

// References are known to lead downwards.
const char* fault_of_structure(const Parents& parents, std::size_t inner) {
  std::vector<std::uint8_t> depth(parents.size());
  for (std::size_t i = 1; i < depth.size(); ++i) {
    const std::uint32_t parent = parents[i].load(std::memory_order_relaxed);
    if (parent == 0) return "a node of the search tree is never reached";
    if (depth[parent - 1] == bvh::kMaxDepth) return "the search tree is too deep";
    depth[i] = static_cast<std::uint8_t>(depth[parent - 1] + 1);
  }
  return inner + 1 == depth.size() ? nullptr : "a node of the search tree is reached twice";
}

template <class Body>
const char* first_fault(std::size_t count, const Body& body) {
  return parallel::reduce(
      std::size_t{0}, count, kNodesPerTask, static_cast<const char*>(nullptr),
      [&](std::size_t first, std::size_t last) -> const char* {
        for (std::size_t i = first; i != last; ++i) {
          if (const char* fault = body(static_cast<std::uint32_t>(i))) return fault;
        }
        return nullptr;
      },
      [](const char* left, const char* right) { return left != nullptr ? left : right; });
}

}  // namespace

const char* fault_of(const bvh::Tree& tree, std::uint32_t primitives) {
  if (tree.root == kNoChild) {
    const bool empty = primitives == 0 && tree.nodes.empty();
    return empty ? nullptr : "the search tree has no root";
  }
  if (primitives == 0) return "the search tree is over nothing";
  if (bvh::is_leaf(tree.root)) {
    if (!tree.nodes.empty()) return "the search tree has nodes and no root";
    return is_leaf_there(tree, tree.root) ? nullptr : "a leaf of the search tree is not there";
  }
  if (tree.root != 0 || tree.nodes.empty()) return "the search tree has another root";
  Parents parents(tree.nodes.size());
  const Seen seen = see_nodes(tree, parents);
  return seen.fault != nullptr ? seen.fault : fault_of_structure(parents, seen.inner);
}

const char* fault_of_leaves(const bvh::Tree& tree, std::uint32_t primitives) {
  const auto of = [&](std::uint32_t ref) -> const char* {
    if (!bvh::is_leaf(ref)) return nullptr;
    const bvh::LeafNumber* const numbers = bvh::leaf_numbers(tree, ref);
    const bool there = std::all_of(numbers, numbers + bvh::leaf_count(ref),
                                   [&](std::uint32_t number) { return number < primitives; });
    return there ? nullptr : "a leaf of the search tree names a triangle that is not there";
  };
  if (const char* fault = of(tree.root)) return fault;
  return first_fault(tree.nodes.size(), [&](std::uint32_t i) {
    const char* fault = nullptr;
    for (const std::uint32_t ref : tree.nodes[i].child) {
      if (fault == nullptr) fault = of(ref);
    }
    return fault;
  });
}

}  // namespace pierce::scene
