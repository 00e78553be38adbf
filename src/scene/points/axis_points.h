// SPDX-License-Identifier: Apache-2.0
//
// Points on their way to the traversal along an axis: brought to filter space, told which way to
// look, sorted so that neighbours go together, and put into packets.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bvh/tree.h"
#include "kernels/points/axis.h"
#include "predicate/axis_passage.h"
#include "space/filter_space.h"

namespace pierce::scene {

using predicate::AxisDirection;

/// Which way a point looks.
enum class Look : std::uint8_t {
  NearestExit,  ///< along the axis that leaves the scene's box soonest
  Up,           ///< along +z
};

class AxisSpace {
 public:
  AxisSpace(const space::FilterSpace& space, const bvh::Tree& tree, bool exact, bool repeats)
      : space_(space), tree_(tree), exact_(exact), repeats_(repeats) {}

  /// The direction for a point; false if its ray meets no triangle and it lies on none, for sure.
  bool direction(const Vec3<double>& point, Look look, AxisDirection& along) const;

  /// Whether a point that looks along `along`, from wherever, may meet or lie on a triangle.
  [[nodiscard]] bool meets(const Vec3<double>& point, AxisDirection along) const;

  /// Whether the line along z through the point may touch a triangle.
  [[nodiscard]] bool line_meets(const Vec3<double>& point) const;

  /// Sorts by place within this box, in the scene's coordinates.
  void sort_within(const Vec3<double>& lower, const Vec3<double>& upper);

  /// A number that is close for points that look the same way past the same triangles.
  [[nodiscard]] std::uint32_t sort_key(const Vec3<double>& point, AxisDirection along) const;

  /// A packet of points that all look along `along`. At most kAxisPoints, at least one.
  void fill(std::span<const Vec3<double>> points, AxisDirection along,
            kernels::AxisPacket& packet) const;

  /// A packet of whole lines along +z through the points: about every triangle whose shadow they
  /// may touch the resolver is asked. Of each, line_meets must hold.
  void fill_lines(std::span<const Vec3<double>> points, kernels::AxisPacket& packet) const;

 private:
  const space::FilterSpace& space_;
  const bvh::Tree& tree_;
  bool exact_;
  bool repeats_;
  double sort_from_[3] = {-1, -1, -1};
  double sort_scale_[3] = {0.5, 0.5, 0.5};
};

/// The direction that a sort key stands for: its bits from kWayShift on, below 6.
inline constexpr std::uint32_t kWayShift = 24;
inline AxisDirection direction_of(std::uint32_t key) {
  const std::uint32_t way = key >> kWayShift;
  return {static_cast<std::uint8_t>(way / 2), way % 2 != 0};
}

/// Sorts by the upper 32 bits, of which only the lowest 28 may be set; equals by the lower ones,
/// which come in ascending order.
void sort_by_key(std::vector<std::uint64_t>& entries, std::vector<std::uint64_t>& scratch);

}  // namespace pierce::scene
