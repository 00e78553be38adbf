// SPDX-License-Identifier: Apache-2.0
//
// The points of a batch, wherever the caller has them.
#pragma once

#include <cstddef>
#include <span>

#include "pierce/arrays.h"
#include "scene/strided.h"

namespace pierce::scene {

template <class Real>
class PointSource {
 public:
  explicit PointSource(std::span<const Vec3<Real>> points)
      : size_(points.size()), points_(points.data()) {}
  /// Throws Error (InvalidArgument) if there are rows but no data.
  explicit PointSource(const Rows<const Real>& rows) : size_(rows.count), rows_(rows) {
    validate_rows(rows.data, rows.count, "points");
    const bool right = rows.stride == sizeof(Vec3<Real>) && rows.step == sizeof(Real);
    if (right && is_aligned(rows.data)) {
      points_ = reinterpret_cast<const Vec3<Real>*>(rows.data);
    }
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] Vec3<Real> operator[](std::size_t i) const {
    if (points_ != nullptr) return points_[i];
    Vec3<Real> point;
    rows_.template read<3>(i, 1, &point.x, sizeof point);
    return point;
  }

 private:
  std::size_t size_;
  const Vec3<Real>* points_ = nullptr;
  InputRows<Real> rows_;
};

}  // namespace pierce::scene
