// SPDX-License-Identifier: Apache-2.0
#include "bvh/leaf_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bvh/box.h"
#include "bvh/leaf_access.h"
#include "space/filter_ray.h"

namespace pierce::bvh {
namespace {

struct Components {
  double of[9];

  explicit Components(const Corners& t)
      : of{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z} {}
};

std::size_t numbers_offset(Layout layout, std::uint32_t n) {
  return layout == Layout::Full ? 4 * (std::size_t{kLeafHead} + 9 * n) : 0;
}

/// The corners of all triangles of a leaf, fetched in one go: they lie anywhere in the caller's
/// memory, and so their latencies overlap.
struct LeafCorners {
  Corners of[kWidth];

  LeafCorners(const Primitives& primitives, const std::uint32_t* numbers, std::uint32_t n) {
    primitives.gather(numbers, n, of);
  }
};

/// Of a triangle by its corners here.
Axes axes_across(const Components& t) {
  Axes axes = 0;
  for (std::uint32_t k = 0; k < 3; ++k)
    axes |= t.of[k] == t.of[3 + k] && t.of[k] == t.of[6 + k] ? 1U << k : 0;
  return axes;
}

/// Returns the axes across which all of them stand here.
Axes write_full(std::byte* place, const LeafCorners& corners, std::uint32_t n) {
  float block[kLeafHead + 9 * kWidth];
  double edge = 0, size = 0;
  Axes across = 7;
  for (std::uint32_t i = 0; i < n; ++i) {
    edge = std::max(edge, largest_edge(corners.of[i]));
    const Components components(corners.of[i]);
    across &= axes_across(components);
    for (std::uint32_t k = 0; k < 9; ++k) {
      block[kLeafHead + k * n + i] = static_cast<float>(components.of[k]);
      size = std::max(size, std::fabs(components.of[k]));
    }
  }
  block[0] = round_up(edge);
  block[1] = space::reach_of(round_up(size));  // no less than a copy, rounded to nearest
  std::memcpy(place, block, (kLeafHead + 9 * n) * sizeof(float));
  return across;
}

}  // namespace

double largest_edge(const Corners& t) {
  double largest = 0;
  const auto edge = [&](double from, double to) {
    const auto from_f = static_cast<double>(static_cast<float>(from));
    const auto to_f = static_cast<double>(static_cast<float>(to));
    largest = std::max({largest, std::abs(to - from), std::abs(to_f - from_f)});
  };
  for (const Vec3<double>& corner : {t.b, t.c}) {
    edge(t.a.x, corner.x);
    edge(t.a.y, corner.y);
    edge(t.a.z, corner.z);
  }
  return largest;
}

Axes write_leaf_block(Layout layout, std::byte* place, const Primitives& primitives,
                      const std::uint32_t* numbers, std::uint32_t n) {
  Axes across = 0;
  if (layout == Layout::Full) across = write_full(place, LeafCorners(primitives, numbers, n), n);
  const std::size_t used = numbers_offset(layout, n) + n * sizeof(LeafNumber);
  LeafNumber stored[kWidth];
  std::copy_n(numbers, n, stored);
  std::memcpy(place + numbers_offset(layout, n), stored, n * sizeof(LeafNumber));
  std::memset(place + used, 0, std::size_t{leaf_units(layout, n)} * kLeafUnit - used);
  for (std::uint32_t i = 0; i < n && across != 0; ++i)
    across &= primitives.across(numbers[i], across);
  return across;
}

void read_leaf_numbers(Layout layout, const std::byte* place, std::uint32_t n,
                       std::uint32_t* numbers) {
  LeafNumber stored[kWidth];
  std::memcpy(stored, place + numbers_offset(layout, n), n * sizeof(LeafNumber));
  std::copy_n(stored, n, numbers);
}

LeafContents read_leaf_block(const std::byte* place, std::uint32_t n) {
  LeafContents leaf{};
  leaf.count = n;
  read_leaf_numbers(Layout::Full, place, n, leaf.primitive);
  float block[kLeafHead + 9 * kWidth];
  std::memcpy(block, place, (kLeafHead + 9 * n) * sizeof(float));
  leaf.edge = block[0];
  leaf.reach = block[1];
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < 9; ++k) leaf.corner[i][k] = block[kLeafHead + k * n + i];
  }
  return leaf;
}

const float* fetch_leaf(const Tree& tree, std::uint32_t ref, LeafScratch& scratch) {
  const std::uint32_t n = leaf_count(ref);
  std::uint32_t numbers[kWidth];
  std::copy_n(leaf_numbers(tree, ref), n, numbers);
  write_leaf_block(Layout::Full, scratch.bytes, *tree.primitives, numbers, n);
  return reinterpret_cast<const float*>(scratch.bytes);
}

}  // namespace pierce::bvh
