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

void write_full(std::byte* place, const Primitives& primitives, const std::uint32_t* numbers,
                std::uint32_t n) {
  float block[1 + 9 * kWidth];
  double edge = 0;
  for (std::uint32_t i = 0; i < n; ++i) {
    const Corners t = primitives.corners(numbers[i]);
    edge = std::max(edge, largest_edge(t));
    const Components components(t);
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

Frame frame_of(const Components* triangles, std::uint32_t n) {
  Frame frame{};
  double extent = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (std::uint32_t i = 0; i < n; ++i) {
      for (std::size_t k = axis; k < 9; k += 3) {
        lower = std::min(lower, triangles[i].of[k]);
        upper = std::max(upper, triangles[i].of[k]);
      }
    }
    frame.origin[axis] = round_down(lower);
    extent = std::max(extent, upper - static_cast<double>(frame.origin[axis]));
  }
  // Of 8 significant bits, so that any multiple up to 65535 is a float.
  frame.step = round_up_to(round_up(extent / static_cast<double>(kLastStep)), 8);
  return frame;
}

void write_compact(std::byte* place, const Primitives& primitives, const std::uint32_t* numbers,
                   std::uint32_t n) {
  Components triangles[kWidth] = {Components({}), Components({}), Components({}), Components({}),
                                  Components({}), Components({}), Components({}), Components({})};
  for (std::uint32_t i = 0; i < n; ++i) {
    triangles[i] = Components(primitives.corners(numbers[i]));
  }
  const Frame frame = frame_of(triangles, n);
  std::uint16_t rows[9 * kWidth];
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t k = 0; k < 9; ++k) {
      rows[k * n + i] = frame.nearest(triangles[i].of[k], k % 3);
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
  if (layout == Layout::Full) {
    write_full(place, primitives, numbers, n);
  } else {
    write_compact(place, primitives, numbers, n);
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
