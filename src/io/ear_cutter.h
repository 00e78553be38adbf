// SPDX-License-Identifier: Apache-2.0
//
// EarCutter: the triangles of a polygon whose fan is not right.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "io/corner_tree.h"
#include "pierce/types.h"

namespace pierce::io {

/// The sign of the area of a triangle's shadow along an axis, exactly.
[[nodiscard]] int turn(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c,
                       std::uint8_t axis);

/// Cuts ears off: corners whose triangle lies within the polygon. One may serve many polygons.
class EarCutter {
 public:
  using Ears = std::vector<std::array<std::size_t, 3>>;

  /// Appends the triangles. Points are finite, four at least; `sign` is that of the area of their
  /// shadow along `axis`. False if there is no ear left: the border crosses itself. Takes time
  /// like n sqrt(n) at most.
  bool cut(std::span<const Vec3<double>> points, std::uint8_t axis, int sign, Ears& ears);

 private:
  static constexpr std::uint32_t kNone = CornerTree::kNone;

  struct Corner {
    std::uint32_t before, after;  // that are left
    // The first of those that it keeps from being ears: by where it is, by where an edge of it is.
    std::uint32_t waiting, touching;
    std::uint32_t asked;  // how often it was put into the queue
    bool gone;
  };
  struct Asked {
    std::uint32_t corner, times;
  };
  // A corner that waits for another one to go.
  struct Wait {
    std::uint32_t corner, next;
  };

  void ask(std::uint32_t i);
  [[nodiscard]] bool is_spike(std::uint32_t i) const;
  void remove(std::uint32_t i);
  [[nodiscard]] std::uint32_t next_corner();
  [[nodiscard]] int turn_at(std::uint32_t i) const;
  [[nodiscard]] bool enters(std::uint32_t k, const Vec3<double>& x, const Vec3<double>& y,
                            const Vec3<double>& z) const;
  [[nodiscard]] std::uint32_t blocker_of(std::uint32_t i) const;

  std::span<const Vec3<double>> points_;
  std::uint8_t axis_ = 0;
  int sign_ = 0;
  std::vector<Corner> corners_;
  std::deque<Asked> queue_;  // who may be an ear; neighbours of ears last, or slivers make a fan
  std::vector<Wait> waits_;
  std::vector<std::uint32_t> flat_;  // corners without area
  std::vector<ShadowPoint> shadows_;
  CornerTree tree_;  // of the corners that are left
};

}  // namespace pierce::io
