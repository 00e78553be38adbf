// SPDX-License-Identifier: Apache-2.0
//
// Which triangles may hold a point, or meet a small box: all of every leaf whose box does.
#pragma once

#include <cstdint>

#include "bvh/leaf_access.h"
#include "bvh/tree.h"
#include "predicate/bounds.h"

namespace pierce::bvh {

using bounds::kPointPad;

/// Calls `visit(primitive)` for every triangle of every leaf that is in children of which
/// `may_meet(node, child)` is true, until it returns true; returns whether it did. A triangle may
/// be visited twice.
template <class MayMeet, class Visit>
bool traverse_where(const Tree& tree, const MayMeet& may_meet, const Visit& visit) {
  if (tree.root == kNoChild) return false;
  std::uint32_t stack[8 * kMaxDepth];
  std::uint32_t* top = stack;
  *top++ = tree.root;
  while (top != stack) {
    const std::uint32_t ref = *--top;
    if (!is_leaf(ref)) {
      const Node& node = tree.nodes[ref];
      for (int child = 0; child < kWidth && node.child[child] != kNoChild; ++child) {
        if (may_meet(node, child)) *top++ = node.child[child];
      }
      continue;
    }
    const std::uint32_t count = leaf_count(ref);
    const LeafNumber* numbers = leaf_numbers(tree, ref);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (visit(numbers[i])) return true;
    }
  }
  return false;
}

/// The same where boxes may meet the box from `lower` to `upper`.
template <class Visit>
bool traverse_box(const Tree& tree, const Vec3<double>& lower, const Vec3<double>& upper,
                  const Visit& visit) {
  const double low[3] = {lower.x, lower.y, lower.z};
  const double high[3] = {upper.x, upper.y, upper.z};
  const auto may_meet = [&](const Node& node, int child) {
    for (int axis = 0; axis < 3; ++axis) {
      if (high[axis] < static_cast<double>(node.lower[axis][child]) - kPointPad ||
          low[axis] > static_cast<double>(node.upper[axis][child]) + kPointPad) {
        return false;
      }
    }
    return true;
  };
  return traverse_where(tree, may_meet, visit);
}

/// The same for a point.
template <class Visit>
bool traverse_point(const Tree& tree, const Vec3<double>& point, const Visit& visit) {
  return traverse_box(tree, point, point, visit);
}

}  // namespace pierce::bvh
