// SPDX-License-Identifier: Apache-2.0
//
// The data sheet of the search tree: wide nodes and leaf blocks, in filter space.
//
// Filter space: the scene's box mapped by a translation and a power of two into [-1, 1]^3. All
// numbers here are floats in that space. Nothing in this file decides anything: boxes are rounded
// outward and triangles are copies rounded to nearest, good only to discard what cannot be hit.
//
// Node (256 bytes, 4 cache lines, aligned to 64):
//
// Planes are moved outward by kBoxPlane of themselves (predicate/bounds.h).
//
//   offset  0  lower x of the 8 children      96  upper x
//          32  lower y                       128  upper y
//          64  lower z                       160  upper z
//         192  child references              224  order, by octant
//
// Children are contiguous from lane 0; unused lanes have an empty box (lower = +kEmptyPlane, upper
// = -kEmptyPlane, which no ray can enter) and the reference kNoChild.
//
// order[o]: the lanes, three bits each from the lowest on, in the order in which rays of octant o
// (bit k set: the direction's component k is negative) meet them, the last first (child_order.h).
//
// The upper bits of order[k], k = 0, 1, 2: bit kAcrossBit + i is set if all triangles below child i
// stand across axis k: the three corners of each have the same coordinate there, exactly, as the
// scene has them. A ray that does not move along that axis hits none of them.
//
// Child reference (32 bits): an inner node is its index (bit 31 clear); a leaf has bit 31 set, bits
// 28..30 hold its number of triangles less one, bits 0..27 the offset of its block in units of
// kLeafUnit bytes from the start of the leaf memory.
//
// Leaf block of n triangles (1 <= n <= 8), 4 (10 n + 2) bytes, rounded up to a multiple of
// kLeafUnit:
//
//   E                    the largest |component| of b - a and c - a over the block, rounded up
//   reach                the largest |coordinate| of its corners, rounded up to a power of two
//   ax[n] ay[n] az[n]    corner a
//   bx[n] by[n] bz[n]    corner b
//   cx[n] cy[n] cz[n]    corner c
//   primitive[n]         LeafNumber: of the triangle, counted over all geometries
//
// so that row k of the block starts kLeafHead + k n floats in. Rows are read 8 wide, past their
// end; the leaf memory therefore ends in kLeafSlack unused bytes.
//
// Compact leaf block (Layout::Compact) of n triangles, 4 n bytes, rounded up likewise: primitive[n]
// and nothing else. Traversal expands it into the block above, in scratch memory (leaf_access.h).
#pragma once

#include <cstddef>
#include <cstdint>

namespace pierce::bvh {

inline constexpr int kWidth = 8;  // children of a node, triangles of a leaf
inline constexpr std::uint32_t kOctants = 8;
inline constexpr int kOrderBits = 3;
inline constexpr int kAcrossBit = kOrderBits * kWidth;
inline constexpr float kEmptyPlane = 1e30F;  // far beyond filter space, far from overflow
inline constexpr std::uint32_t kNoChild = 0x7fffffffU;  // never followed
inline constexpr std::uint32_t kLeafBit = 0x80000000U;
inline constexpr std::uint32_t kLeafUnit = 32;  // bytes: 28 bits of units reach 8 GiB
inline constexpr std::size_t kLeafSlack = 64;
inline constexpr std::uint32_t kLeafHead = 2;  // floats of a full block before its rows

/// A triangle's number as leaves have it. Where a leaf has few triangles, the last rows are read on
/// into these, and lanes that mean nothing calculate with them as floats. Plain numbers would be
/// subnormal ones, at which Intel's processors take 150 cycles an operation; these are about 1.
class LeafNumber {
 public:
  LeafNumber() = default;
  constexpr LeafNumber(std::uint32_t number) : bits_(number ^ kOne) {}
  constexpr operator std::uint32_t() const { return bits_ ^ kOne; }
  /// As they are compared in lanes.
  [[nodiscard]] constexpr std::uint32_t bits() const { return bits_; }

 private:
  static constexpr std::uint32_t kOne = 0x3f800000;  // the bits of 1.0F
  std::uint32_t bits_;
};
static_assert(sizeof(LeafNumber) == 4);

struct alignas(64) Node {
  float lower[3][kWidth];
  float upper[3][kWidth];
  std::uint32_t child[kWidth];
  std::uint32_t order[kOctants];
};
static_assert(sizeof(Node) == 256);

/// The children that stand across one of these axes, a bit each.
inline std::uint32_t children_across(const Node& node, std::uint32_t axes) {
  std::uint32_t children = 0;
  for (std::uint32_t k = 0; k < 3; ++k)
    children |= (node.order[k] >> kAcrossBit) & (0U - ((axes >> k) & 1U));
  return children;
}
/// Notes across which axes, a bit each, all below a child stands.
inline void set_across(Node& node, int lane, std::uint32_t axes) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t bit = 1U << (kAcrossBit + lane);
    node.order[k] = ((axes >> k) & 1U) != 0 ? node.order[k] | bit : node.order[k] & ~bit;
  }
}
/// What was noted of it.
inline std::uint32_t axes_across(const Node& node, int lane) {
  std::uint32_t axes = 0;
  for (std::uint32_t k = 0; k < 3; ++k) axes |= ((node.order[k] >> (kAcrossBit + lane)) & 1U) << k;
  return axes;
}
/// Across which axes all below the node stands.
inline std::uint32_t axes_across(const Node& node) {
  std::uint32_t axes = 7;
  for (int lane = 0; lane < kWidth; ++lane)
    if (node.child[lane] != kNoChild) axes &= axes_across(node, lane);
  return axes;
}

inline bool is_leaf(std::uint32_t ref) { return (ref & kLeafBit) != 0; }
inline std::uint32_t leaf_count(std::uint32_t ref) { return ((ref >> 28) & 7U) + 1; }
inline std::uint32_t leaf_offset(std::uint32_t ref) { return ref & 0x0fffffffU; }
inline std::uint32_t make_leaf(std::uint32_t offset, std::uint32_t count) {
  return kLeafBit | ((count - 1) << 28) | offset;
}

}  // namespace pierce::bvh
