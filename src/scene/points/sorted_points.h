// SPDX-License-Identifier: Apache-2.0
//
// A batch of points in an order in which those go together that look the same way past the same
// triangles.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/points/axis_points.h"
#include "scene/points/point_source.h"
#include "support/for_chunks.h"
#include "support/progress.h"

namespace pierce::scene {

// Points that are sorted together: enough that neighbours are near, few enough to keep in memory.
inline constexpr std::size_t kPointsPerBlock = std::size_t{1} << 20;
inline constexpr std::size_t kPointsPerTask = 4096;

// Entries of the order: what to sort by, and the number of the point.
inline constexpr std::uint32_t kLooksNowhere = 7;  // instead of a direction: its ray meets nothing

struct SortedPoint {
  std::uint32_t number;  ///< in its block
  bool looks;            ///< false: its ray meets nothing, and it lies on nothing
  AxisDirection along;

  explicit SortedPoint(std::uint64_t entry)
      : number(static_cast<std::uint32_t>(entry)),
        looks(static_cast<std::uint32_t>(entry >> 32) >> kWayShift != kLooksNowhere),
        along(direction_of(static_cast<std::uint32_t>(entry >> 32))) {}
};

inline std::uint64_t sorted_entry(const AxisSpace& space, Look look, const Vec3<double>& point,
                                  std::size_t number) {
  AxisDirection along;
  const std::uint32_t key = space.direction(point, look, along) ? space.sort_key(point, along)
                                                                : kLooksNowhere << kWayShift;
  return std::uint64_t{key} << 32 | number;
}

/// Has the space sort within the box of some points.
template <class Real>
void sort_within(const PointSource<Real>& points, std::size_t first, std::size_t count,
                 AxisSpace& space) {
  Vec3<Real> lower = points[first], upper = lower;
  for (std::size_t i = first + 1; i < first + count; ++i) {
    const Vec3<Real> p = points[i];
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  space.sort_within(predicate::to_double(lower), predicate::to_double(upper));
}

/// Block by block: `start(first, count)`; on threads `answer(first, entries)` with entries of the
/// order (SortedPoint); `finish(first, count)`.
template <class Real, class Start, class Answer, class Finish>
void for_sorted_points(const PointSource<Real>& points, AxisSpace& space, Look look,
                       const WorkOptions& work, const Start& start, const Answer& answer,
                       const Finish& finish) {
  const WorkOptions quiet{.threads = work.threads, .stop = work.stop};
  std::vector<std::uint64_t> order, scratch;
  for (std::size_t first = 0; first < points.size(); first += kPointsPerBlock) {
    const std::size_t size = std::min(points.size() - first, kPointsPerBlock);
    start(first, size);
    order.resize(size);
    sort_within(points, first, size, space);
    for_chunks(size, quiet, kPointsPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        order[i] = sorted_entry(space, look, predicate::to_double(points[first + i]), i);
      }
    });
    sort_by_key(order, scratch);
    const auto of_all = [&points](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(points.size());
    };
    WorkOptions part = quiet;  // its progress counted over the whole
    part.progress = part_of(work.progress, of_all(first), of_all(first + size));
    for_chunks(size, part, kPointsPerTask, [&](std::size_t begin, std::size_t end) {
      answer(first, std::span<const std::uint64_t>(order).subspan(begin, end - begin));
    });
    finish(first, size);
  }
}

}  // namespace pierce::scene
