// SPDX-License-Identifier: Apache-2.0
#include "scene/points/axis_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bvh/box.h"
#include "bvh/point_traversal.h"
#include "space/filter_ray.h"

namespace pierce::scene {
namespace {

constexpr std::uint32_t kMortonBits = kWayShift / 2;  // an axis
constexpr std::uint32_t kDigitBits = 7;
constexpr std::uint32_t kDigits = 4;  // 28 bits: 24 of place, 3 of direction

struct InSpace {
  double at[3];

  explicit InSpace(const Vec3<double>& p) : at{p.x, p.y, p.z} {}
};

// Every second bit.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 8) & 0x00ff00ffU;
  x = (x | x << 4) & 0x0f0f0f0fU;
  x = (x | x << 2) & 0x33333333U;
  return (x | x << 1) & 0x55555555U;
}

// A float for any double: the ends of float's range stand for what is beyond.
double clamped(double x) {
  constexpr auto kMost = static_cast<double>(std::numeric_limits<float>::max());
  return std::clamp(x, -kMost, kMost);
}

}  // namespace

bool AxisSpace::direction(const Vec3<double>& point, Look look, AxisDirection& along) const {
  const InSpace p(space_.map(point));
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const double above = static_cast<double>(tree_.upper[axis]) - p.at[axis];
    const double below = p.at[axis] - static_cast<double>(tree_.lower[axis]);
    const bool may_be_below = look == Look::Up && axis == 2;
    if (above < -bvh::kPointPad || (below < -bvh::kPointPad && !may_be_below)) return false;
    if (above < nearest) {
      nearest = above;
      along = {axis, true};
    }
    if (below < nearest) {
      nearest = below;
      along = {axis, false};
    }
  }
  if (look == Look::Up) along = {2, true};
  return true;
}

bool AxisSpace::meets(const Vec3<double>& point, AxisDirection along) const {
  const InSpace p(space_.map(point));
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const bool from_below = axis == along.axis && along.forward;
    const bool from_above = axis == along.axis && !along.forward;
    const double lower = static_cast<double>(tree_.lower[axis]) - bvh::kPointPad;
    const double upper = static_cast<double>(tree_.upper[axis]) + bvh::kPointPad;
    if ((p.at[axis] < lower && !from_below) || (p.at[axis] > upper && !from_above)) return false;
  }
  return true;
}

bool AxisSpace::line_meets(const Vec3<double>& point) const {
  const InSpace p(space_.map(point));
  for (std::uint32_t axis = 0; axis < 2; ++axis) {
    if (p.at[axis] < static_cast<double>(tree_.lower[axis]) - bvh::kPointPad ||
        p.at[axis] > static_cast<double>(tree_.upper[axis]) + bvh::kPointPad) {
      return false;
    }
  }
  return true;
}

void AxisSpace::sort_within(const Vec3<double>& lower, const Vec3<double>& upper) {
  const InSpace low(space_.map(lower)), high(space_.map(upper));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    // What lies outside the tree's box is not sorted, or together with what lies at its border.
    const double from = std::max(low.at[axis], static_cast<double>(tree_.lower[axis]));
    const double extent = std::min(high.at[axis], static_cast<double>(tree_.upper[axis])) - from;
    sort_from_[axis] = from;
    sort_scale_[axis] = extent > 0x1p-1000 ? 1 / extent : 0;
  }
}

std::uint32_t AxisSpace::sort_key(const Vec3<double>& point, AxisDirection along) const {
  const InSpace p(space_.map(point));
  const auto cell = [&](std::uint32_t axis) {
    constexpr double kCells = 1U << kMortonBits;
    const double place = (p.at[axis] - sort_from_[axis]) * sort_scale_[axis] * kCells;
    return static_cast<std::uint32_t>(std::clamp(place, 0.0, kCells - 1));
  };
  const std::uint32_t way = 2U * along.axis + (along.forward ? 1U : 0U);
  return way << kWayShift | spread(cell((along.axis + 1U) % 3)) << 1 |
         spread(cell((along.axis + 2U) % 3));
}

void AxisSpace::fill(std::span<const Vec3<double>> points, AxisDirection along,
                     kernels::AxisPacket& packet) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // Copies of corners are rounded to nearest and rounding keeps the order, so that a point rounded
  // outward needs no more room than its own error and theirs before they were rounded.
  const double pad = exact_ ? 0 : bvh::kPointPad;
  packet.count = static_cast<std::uint32_t>(points.size());
  packet.axis = along.axis;
  packet.forward = along.forward;
  packet.exact = exact_;
  packet.repeats = repeats_;
  float size = 0;  // off the axis
  std::fill_n(packet.lower, 3, kInfinity);
  std::fill_n(packet.upper, 3, -kInfinity);
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    std::fill_n(packet.low[axis], kernels::kAxisPoints, kInfinity);
    std::fill_n(packet.high[axis], kernels::kAxisPoints, -kInfinity);
  }
  for (std::uint32_t i = 0; i < packet.count; ++i) {
    const InSpace p(space_.map(points[i]));
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const float low = exact::round_down(clamped(p.at[axis] - pad));
      const float high = exact::round_up(clamped(p.at[axis] + pad));
      packet.lower[axis] = std::min(packet.lower[axis], low);
      packet.upper[axis] = std::max(packet.upper[axis], high);
      const auto nearest = static_cast<float>(clamped(p.at[axis]));
      packet.point[axis][i] = nearest;
      packet.low[axis][i] = low;
      packet.high[axis][i] = high;
      if (axis != along.axis) {
        // A scene of doubles that are floats may be asked about a point that is none.
        size = std::max({size, std::fabs(low), std::fabs(high)});
        packet.exact &= static_cast<double>(nearest) == p.at[axis];
      }
    }
  }
  packet.reach = space::reach_of(size);
}

void AxisSpace::fill_lines(std::span<const Vec3<double>> points,
                           kernels::AxisPacket& packet) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  fill(points, {2, true}, packet);
  packet.lower[2] = -kInfinity;
  packet.upper[2] = kInfinity;
  std::fill_n(packet.low[2], packet.count, -kInfinity);
  std::fill_n(packet.high[2], packet.count, kInfinity);
}

void sort_by_key(std::vector<std::uint64_t>& entries, std::vector<std::uint64_t>& scratch) {
  constexpr std::uint32_t kBuckets = 1U << kDigitBits;
  if (entries.size() < kBuckets) {  // the lower bits are the points' numbers: no two are equal
    std::sort(entries.begin(), entries.end());
    return;
  }
  scratch.resize(entries.size());
  for (std::uint32_t digit = 0; digit < kDigits; ++digit) {
    const auto bucket = [digit](std::uint64_t entry) {
      return static_cast<std::uint32_t>(entry >> (32 + digit * kDigitBits)) & (kBuckets - 1);
    };
    std::array<std::size_t, kBuckets> next{};
    for (const std::uint64_t entry : entries) ++next[bucket(entry)];
    std::size_t first = 0;
    for (std::size_t& place : next) {
      const std::size_t count = place;
      place = first;
      first += count;
    }
    for (const std::uint64_t entry : entries) scratch[next[bucket(entry)]++] = entry;
    entries.swap(scratch);
  }
}

}  // namespace pierce::scene
