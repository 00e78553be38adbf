// SPDX-License-Identifier: Apache-2.0
//
// Passages of rays along a coordinate axis: up to sixteen points that look the same way traverse
// the tree together. A node's eight boxes, and a leaf's eight triangles, are held against the
// points' common rectangle; a triangle that is left is held against all points at once.
//
// Key: k is the axis, i and j the two that follow it in turn; q, r, s are a triangle's corners as
// seen from a point. The sides of the shadow are q_i r_j - q_j r_i and so on; with all three of one
// sign for sure the line goes through the triangle, with two of opposite signs it does not. What is
// neither, and what is not surely before or behind the point, the resolver decides. The bound of a
// side: docs/algorithm.md, "Along an axis".
#if defined(PIERCE_KERNELS_AXIS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_AXIS_INL_H_
#undef PIERCE_KERNELS_AXIS_INL_H_
#else
#define PIERCE_KERNELS_AXIS_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "kernels/points/axis.h"
#include "kernels/rays/single-inl.h"
#include "predicate/bounds.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

using bounds::kAxisFloor;
using bounds::kAxisInput;
using bounds::kAxisMore;
using bounds::kAxisSquare;

using PointsD = hn::CappedTag<float, kAxisPoints>;
using PointsV = hn::Vec<PointsD>;
using PointsM = hn::Mask<PointsD>;
// A packet that is wider than this part of a box is held against it point by point.
inline constexpr float kWide = 0.25F;

inline constexpr std::uint32_t kPointLanes = static_cast<std::uint32_t>(hn::MaxLanes(PointsD{}));

// The rectangle of a packet, and where its axes are in a node and in a leaf block.
struct AxisFrame {
  std::uint32_t i, j, k;
  V lower_i, upper_i, lower_j, upper_j;
  V limit;  // along the axis: what ends before it is not met
  bool forward;

  explicit HWY_INLINE AxisFrame(const AxisPacket& packet)
      : i((packet.axis + 1) % 3),
        j((packet.axis + 2) % 3),
        k(packet.axis),
        lower_i(hn::Set(D(), packet.lower[i])),
        upper_i(hn::Set(D(), packet.upper[i])),
        lower_j(hn::Set(D(), packet.lower[j])),
        upper_j(hn::Set(D(), packet.upper[j])),
        limit(hn::Set(D(), packet.forward ? packet.lower[k] : packet.upper[k])),
        forward(packet.forward) {}

  /// Lanes whose box [lower, upper] some ray of the packet may meet.
  HWY_INLINE hn::Mask<D> meets(V lower_at_i, V upper_at_i, V lower_at_j, V upper_at_j, V lower_at_k,
                               V upper_at_k) const {
    const auto on_i = hn::And(hn::Le(lower_at_i, upper_i), hn::Ge(upper_at_i, lower_i));
    const auto on_j = hn::And(hn::Le(lower_at_j, upper_j), hn::Ge(upper_at_j, lower_j));
    const auto on_k = forward ? hn::Ge(upper_at_k, limit) : hn::Le(lower_at_k, limit);
    return hn::And(hn::And(on_i, on_j), on_k);
  }
};

// Bit i: the packet's rectangle meets child i.
HWY_INLINE std::uint32_t met_children(const bvh::Node& node, const AxisFrame& frame) {
  const D d;
  std::uint32_t bits = 0;
  for (int lane = 0; lane < bvh::kWidth; lane += kLanes) {
    const auto plane = [&](const float(&row)[bvh::kWidth]) { return hn::Load(d, row + lane); };
    bits |= bits_of(d, frame.meets(plane(node.lower[frame.i]), plane(node.upper[frame.i]),
                                   plane(node.lower[frame.j]), plane(node.upper[frame.j]),
                                   plane(node.lower[frame.k]), plane(node.upper[frame.k])))
            << lane;
  }
  return bits;
}

// Bit i: the packet's rectangle is not small beside child i, so that perhaps no point meets it.
HWY_INLINE std::uint32_t small_children(const bvh::Node& node, const AxisFrame& frame) {
  const D d;
  std::uint32_t bits = 0;
  for (int lane = 0; lane < bvh::kWidth; lane += kLanes) {
    const auto plane = [&](const float(&row)[bvh::kWidth]) { return hn::Load(d, row + lane); };
    const auto is_wide = [&](std::uint32_t axis, V lower, V upper) {
      const V extent = hn::Sub(plane(node.upper[axis]), plane(node.lower[axis]));
      return hn::Gt(hn::Sub(upper, lower), hn::Mul(hn::Set(d, kWide), extent));
    };
    bits |= bits_of(d, hn::Or(is_wide(frame.i, frame.lower_i, frame.upper_i),
                              is_wide(frame.j, frame.lower_j, frame.upper_j)))
            << lane;
  }
  return bits;
}

// A box by its ends across the axis and along it.
struct AxisBox {
  float lower_i, upper_i, lower_j, upper_j, lower_k, upper_k;

  HWY_INLINE AxisBox(const bvh::Node& node, std::uint32_t child, const AxisFrame& frame)
      : lower_i(node.lower[frame.i][child]),
        upper_i(node.upper[frame.i][child]),
        lower_j(node.lower[frame.j][child]),
        upper_j(node.upper[frame.j][child]),
        lower_k(node.lower[frame.k][child]),
        upper_k(node.upper[frame.k][child]) {}
  // Of a triangle's copy.
  HWY_INLINE AxisBox(const Candidate& triangle, const AxisFrame& frame) {
    const auto ends = [&](std::uint32_t axis, float& lower, float& upper) {
      const float* corner = triangle.copy + axis * triangle.stride;
      const std::uint32_t next = 3 * triangle.stride;
      lower = std::min({corner[0], corner[next], corner[2 * next]});
      upper = std::max({corner[0], corner[next], corner[2 * next]});
    };
    ends(frame.i, lower_i, upper_i);
    ends(frame.j, lower_j, upper_j);
    ends(frame.k, lower_k, upper_k);
  }
};

// Whether the ray of some point may meet the box.
HWY_INLINE bool some_point_meets(const AxisBox& box, const AxisFrame& frame,
                                 const AxisPacket& packet) {
  const PointsD d;
  for (std::uint32_t lane = 0; lane < packet.count; lane += kPointLanes) {
    const auto low = [&](std::uint32_t axis) { return hn::Load(d, packet.low[axis] + lane); };
    const auto high = [&](std::uint32_t axis) { return hn::Load(d, packet.high[axis] + lane); };
    const auto on_i = hn::And(hn::Le(hn::Set(d, box.lower_i), high(frame.i)),
                              hn::Ge(hn::Set(d, box.upper_i), low(frame.i)));
    const auto on_j = hn::And(hn::Le(hn::Set(d, box.lower_j), high(frame.j)),
                              hn::Ge(hn::Set(d, box.upper_j), low(frame.j)));
    const auto on_k = frame.forward ? hn::Ge(hn::Set(d, box.upper_k), low(frame.k))
                                    : hn::Le(hn::Set(d, box.lower_k), high(frame.k));
    if (!hn::AllFalse(d, hn::And(hn::And(on_i, on_j), on_k))) return true;
  }
  return false;
}

HWY_INLINE std::uint32_t met_triangles(const Leaf& leaf, const AxisFrame& frame) {
  const D d;
  std::uint32_t bits = 0;
  for (std::uint32_t lane = 0; lane < leaf.count; lane += kLanes) {
    const auto row = [&](std::uint32_t axis, std::uint32_t corner) {
      return hn::LoadU(d, leaf.rows + (3 * corner + axis) * leaf.count + lane);
    };
    const auto lowest = [&](std::uint32_t axis) {
      return hn::Min(hn::Min(row(axis, 0), row(axis, 1)), row(axis, 2));
    };
    const auto highest = [&](std::uint32_t axis) {
      return hn::Max(hn::Max(row(axis, 0), row(axis, 1)), row(axis, 2));
    };
    bits |= bits_of(d, frame.meets(lowest(frame.i), highest(frame.i), lowest(frame.j),
                                   highest(frame.j), lowest(frame.k), highest(frame.k)))
            << lane;
  }
  return bits & ((1U << leaf.count) - 1);  // what stands in the lanes beyond means nothing
}

// The three sides of a triangle's shadow as seen from lanes of points.
struct Sides {
  PointsV bc, ca, ab, error;

  /// `reach`: of the triangle's leaf and of the points.
  HWY_INLINE Sides(const Candidate& triangle, float reach, const AxisFrame& frame,
                   const AxisPacket& packet, std::uint32_t lane) {
    const PointsD d;
    const PointsV at_i = hn::Load(d, packet.point[frame.i] + lane);
    const PointsV at_j = hn::Load(d, packet.point[frame.j] + lane);
    const auto seen = [&](std::uint32_t axis, std::uint32_t corner, PointsV from) {
      return hn::Sub(hn::Set(d, triangle.copy[(3 * corner + axis) * triangle.stride]), from);
    };
    const PointsV qi = seen(frame.i, 0, at_i), qj = seen(frame.j, 0, at_j);
    const PointsV ri = seen(frame.i, 1, at_i), rj = seen(frame.j, 1, at_j);
    const PointsV si = seen(frame.i, 2, at_i), sj = seen(frame.j, 2, at_j);
    bc = product_minus(ri, sj, product(rj, si));
    ca = product_minus(si, qj, product(sj, qi));
    ab = product_minus(qi, rj, product(qj, ri));
    const PointsV m =
        hn::Max(hn::Max(hn::Max(hn::Abs(qi), hn::Abs(qj)), hn::Max(hn::Abs(ri), hn::Abs(rj))),
                hn::Max(hn::Abs(si), hn::Abs(sj)));
    // kAxisSquare m^2 + kAxisInput reach (m + kAxisMore reach) + kAxisFloor
    const float input = packet.exact ? 0.0F : kAxisInput * reach;
    const PointsV linear = hn::MulAdd(m, hn::Set(d, kAxisSquare), hn::Set(d, input));
    error = hn::MulAdd(m, linear, hn::Set(d, input * (kAxisMore * reach) + kAxisFloor));
  }

  HWY_INLINE PointsM all_above() const {
    return hn::And(hn::And(hn::Gt(bc, error), hn::Gt(ca, error)), hn::Gt(ab, error));
  }
  HWY_INLINE PointsM any_above() const {
    return hn::Or(hn::Or(hn::Gt(bc, error), hn::Gt(ca, error)), hn::Gt(ab, error));
  }
  HWY_INLINE Sides negated_sides() const {
    Sides other = *this;
    other.bc = hn::Neg(bc);
    other.ca = hn::Neg(ca);
    other.ab = hn::Neg(ab);
    return other;
  }
};

// One triangle against all points of the packet.
HWY_INLINE void count_passages(const Candidate& triangle, float reach, const AxisFrame& frame,
                               AxisPacket& packet, AxisResolver& resolver, KernelCounts* counts) {
  const PointsD d;
  const hn::Rebind<std::int32_t, PointsD> d_int;
  const float* corner_k = triangle.copy + frame.k * triangle.stride;
  const std::uint32_t next = 3 * triangle.stride;
  const float lowest_k = std::min({corner_k[0], corner_k[next], corner_k[2 * next]});
  const float highest_k = std::max({corner_k[0], corner_k[next], corner_k[2 * next]});
  const auto leaving = hn::Set(d_int, frame.forward ? 1 : -1);
  for (std::uint32_t lane = 0; lane < packet.count; lane += kPointLanes) {
    const Sides sides(triangle, reach, frame, packet, lane);
    const Sides opposite = sides.negated_sides();
    const PointsM apart = hn::And(sides.any_above(), opposite.any_above());
    const PointsM above = hn::Gt(hn::Set(d, lowest_k), hn::Load(d, packet.high[frame.k] + lane));
    const PointsM below = hn::Lt(hn::Set(d, highest_k), hn::Load(d, packet.low[frame.k] + lane));
    const PointsM ahead = frame.forward ? above : below;
    const PointsM behind = frame.forward ? below : above;
    const PointsM up = hn::And(sides.all_above(), ahead);
    const PointsM down = hn::And(opposite.all_above(), ahead);
    const auto passed = hn::Sub(hn::IfThenElseZero(hn::RebindMask(d_int, up), leaving),
                                hn::IfThenElseZero(hn::RebindMask(d_int, down), leaving));
    std::int32_t* winding = packet.winding + lane;
    hn::Store(hn::Add(hn::Load(d_int, winding), passed), d_int, winding);

    const PointsM settled = hn::Or(hn::Or(apart, behind), hn::Or(up, down));
    std::uint32_t open = bits_of(d, hn::Not(settled));
    if (packet.count - lane < kPointLanes) open &= (1U << (packet.count - lane)) - 1;
    for (; open != 0; open &= open - 1) {
      const std::uint32_t point = lane + static_cast<std::uint32_t>(std::countr_zero(open));
      if (counts != nullptr) ++counts->candidates;
      packet.winding[point] += resolver.passage(point, triangle);
    }
  }
}

inline void traverse_axis(const bvh::Tree& tree, AxisPacket& packet, AxisResolver& resolver,
                          KernelCounts* counts) {
  std::fill_n(packet.winding, kAxisPoints, 0);
  if (tree.root == bvh::kNoChild) return;
  const AxisFrame frame(packet);
  const NodeAddresses addresses(tree);
  MetTriangles met;
  bvh::LeafScratch scratch;
  // Of each, whether the packet is wide there.
  struct Entry {
    std::uint32_t ref;
    bool wide;
  };
  Entry stack[kStackSize];
  Entry* top = stack;
  *top++ = {tree.root, packet.count > 1};
  while (top != stack) {
    const auto [ref, wide] = *--top;
    if (!bvh::is_leaf(ref)) {
      if (counts != nullptr) ++counts->nodes;
      const bvh::Node& node = tree.nodes[ref];
      const std::uint32_t small = packet.count > 1 ? small_children(node, frame) : 0;
      for (std::uint32_t bits = met_children(node, frame); bits != 0; bits &= bits - 1) {
        const auto child = static_cast<std::uint32_t>(std::countr_zero(bits));
        const bool is_wide = ((small >> child) & 1U) != 0;
        if (is_wide && !some_point_meets({node, child, frame}, frame, packet)) continue;
        addresses.prefetch(node.child[child]);
        *top++ = {node.child[child], is_wide};
      }
      continue;
    }
    if (counts != nullptr) ++counts->leaves;
    const Leaf leaf(tree, ref, scratch);
    for (std::uint32_t bits = met_triangles(leaf, frame); bits != 0; bits &= bits - 1) {
      const Candidate triangle = leaf.candidate(static_cast<std::uint32_t>(std::countr_zero(bits)));
      if (wide && !some_point_meets({triangle, frame}, frame, packet)) continue;
      if (packet.repeats && !met.add(triangle.primitive)) continue;
      count_passages(triangle, std::max(leaf.reach, packet.reach), frame, packet, resolver, counts);
    }
  }
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
