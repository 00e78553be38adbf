// SPDX-License-Identifier: Apache-2.0
//
// Where a batch's nearest points go.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "pierce/arrays.h"
#include "scene/strided.h"
#include "scene/validate_input.h"

namespace pierce::scene {

template <class Real>
class NearestWriter {
 public:
  /// Throws Error (SizeMismatch, InvalidArgument) unless what is wanted has a row for every point.
  NearestWriter(const NearestArrays<Real>& arrays, std::size_t points)
      : nearest_(arrays.nearest.data()),
        point_(arrays.point, points, "point", "point"),
        distance_(arrays.distance, points, "point", "distance"),
        u_(arrays.u, points, "point", "u"),
        v_(arrays.v, points, "point", "v"),
        w_(arrays.w, points, "point", "w"),
        geometry_(arrays.geometry, points, "point", "geometry"),
        triangle_(arrays.triangle, points, "point", "triangle"),
        feature_(arrays.feature, points, "point", "feature") {
    if (!arrays.nearest.empty()) validate_outputs("point", points, arrays.nearest.size());
  }

  void operator()(std::size_t first, std::span<const NearestPoint<Real>> results) const {
    using N = NearestPoint<Real>;
    if (nearest_ != nullptr) std::copy(results.begin(), results.end(), nearest_ + first);
    point_.write(first, results, [](const N& n) {
      constexpr Real kNowhere = std::numeric_limits<Real>::quiet_NaN();
      return n.triangle == kNone ? Vec3<Real>{kNowhere, kNowhere, kNowhere} : n.point;
    });
    distance_.write(first, results, [](const N& n) { return n.distance; });
    u_.write(first, results, [](const N& n) { return n.u; });
    v_.write(first, results, [](const N& n) { return n.v; });
    w_.write(first, results, [](const N& n) { return n.w; });
    geometry_.write(first, results, [](const N& n) { return n.geometry; });
    triangle_.write(first, results, [](const N& n) { return n.triangle; });
    feature_.write(first, results, [](const N& n) { return static_cast<std::uint8_t>(n.feature); });
  }

 private:
  NearestPoint<Real>* nearest_;
  OutputRows<Real> point_, distance_, u_, v_, w_;
  OutputIds geometry_, triangle_;
  OutputRows<std::uint8_t> feature_;
};

}  // namespace pierce::scene
