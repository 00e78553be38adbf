// SPDX-License-Identifier: Apache-2.0
#include "bvh/leaf_block.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bvh/box.h"

namespace pierce::bvh {
namespace {

constexpr float kLastStep = 65535.0F;

struct Components {
  double of[9];

  explicit Components(const Corners& t)
      : of{t.a.x, t.a.y, t.a.z, t.b.x, t.b.y, t.b.z, t.c.x, t.c.y, t.c.z} {}
};

std::size_t numbers_offset(Layout layout, std::uint32_t n) {
  return layout == Layout::Full ? 4 * (std::size_t{1} + 9 * n) : 16 + std::size_t{18} * n;
}

/// The corners of all triangles of a leaf, fetched in one go: they lie anywhere in the caller's
/// memory, and so the waits for them overlap.
struct LeafCorners {
  Corners of[kWidth];

  LeafCorners(const Primitives& primitives, const std::uint32_t* numbers, std::uint32_t n) {
    for (std::uint32_t i = 0; i < n; ++i) of[i] = primitives.corners(numbers[i]);
  }
};

void write_full(std::byte* place, const LeafCorners& corners, std::uint32_t n) {
  float block[1 + 9 * kWidth];
  double edge = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    edge = std::max(edge, largest_edge(corners.of[i]));
    const Components components(corners.of[i]);
    for (std::uint32_t k = 0; k < 9; ++k) {
      block[1 + k * n + i] = static_cast<float>(components.of[k]);
    }
  }
  block[0] = round_up(edge);
  std::memcpy(place, block, (1 + 9 * n) * sizeof(float));
}

/// Where the steps of a compact block begin and how large they are.
struct Frame {
  float origin[3], step;

  /// The nearest step, as nearly as float tells: half a step and a rounding of a few 2^-25 off.
  [[nodiscard]] std::uint16_t nearest(double x, std::size_t axis) const {
    if (step == 0.0F) return 0;
    const double q = (x - static_cast<double>(origin[axis])) / static_cast<double>(step);
    return static_cast<std::uint16_t>(
        std::clamp(std::floor(q + 0.5), 0.0, static_cast<double>(kLastStep)));
  }
};

Frame frame_of(const LeafCorners& corners, std::uint32_t n) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double lower[3] = {kInfinity, kInfinity, kInfinity};
  double upper[3] = {-kInfinity, -kInfinity, -kInfinity};
  for (std::uint32_t i = 0; i < n; ++i) {
    const Components components(corners.of[i]);
    for (std::size_t k = 0; k < 9; ++k) {
      lower[k % 3] = std::min(lower[k % 3], components.of[k]);
      upper[k % 3] = std::max(upper[k % 3], components.of[k]);
    }
  }
  Frame frame{};
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    frame.origin[axis] = round_down(lower[axis]);
    extent = std::max(extent, upper[axis] - static_cast<double>(frame.origin[axis]));
  }
  // Of 8 significant bits, so that any multiple up to 65535 is a float.
  frame.step = round_up_to(round_up(extent / static_cast<double>(kLastStep)), 8);
  return frame;
}

void write_compact(std::byte* place, const LeafCorners& corners, std::uint32_t n) {
  const Frame frame = frame_of(corners, n);
  std::uint16_t rows[9 * kWidth];
  for (std::uint32_t i = 0; i < n; ++i) {
    const Components components(corners.of[i]);
    for (std::uint32_t k = 0; k < 9; ++k) {
      rows[k * n + i] = frame.nearest(components.of[k], k % 3);
    }
  }
  std::memcpy(place, frame.origin, sizeof frame.origin);
  std::memcpy(place + sizeof frame.origin, &frame.step, sizeof frame.step);
  std::memcpy(place + 16, rows, 9 * n * sizeof(std::uint16_t));
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

void write_leaf_block(Layout layout, std::byte* place, const Primitives& primitives,
                      const std::uint32_t* numbers, std::uint32_t n) {
  const LeafCorners corners(primitives, numbers, n);
  if (layout == Layout::Full) {
    write_full(place, corners, n);
  } else {
    write_compact(place, corners, n);
  }
  const std::size_t used = numbers_offset(layout, n) + n * sizeof(std::uint32_t);
  std::memcpy(place + numbers_offset(layout, n), numbers, n * sizeof(std::uint32_t));
  std::memset(place + used, 0, std::size_t{leaf_units(layout, n)} * kLeafUnit - used);
}

void read_leaf_numbers(Layout layout, const std::byte* place, std::uint32_t n,
                       std::uint32_t* numbers) {
  std::memcpy(numbers, place + numbers_offset(layout, n), n * sizeof(std::uint32_t));
}

LeafContents read_leaf_block(Layout layout, const std::byte* place, std::uint32_t n) {
  LeafContents leaf{};
  leaf.count = n;
  read_leaf_numbers(layout, place, n, leaf.primitive);
  if (layout == Layout::Full) {
    float block[1 + 9 * kWidth];
    std::memcpy(block, place, (1 + 9 * n) * sizeof(float));
    leaf.edge = block[0];
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::uint32_t k = 0; k < 9; ++k) leaf.corner[i][k] = block[1 + k * n + i];
    }
    return leaf;
  }
  float frame[4];  // origin, step
  std::uint16_t rows[9 * kWidth];
  std::memcpy(frame, place, sizeof frame);
  std::memcpy(rows, place + 16, 9 * n * sizeof(std::uint16_t));
  leaf.step = frame[3];
  leaf.edge = kLastStep * leaf.step;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < 9; ++k) {
      leaf.corner[i][k] = static_cast<float>(rows[k * n + i]) * leaf.step + frame[k % 3];
    }
  }
  return leaf;
}

}  // namespace pierce::bvh
