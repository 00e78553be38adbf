// SPDX-License-Identifier: Apache-2.0
//
// Rays drawn at the places where inexact ray casters go wrong: through vertices, edges and points
// of faces, exactly where numbers allow it and then 0, 1 or 2 ulp beside; along edges, in planes,
// parallel to axes; starting on the surface; with ranges that end exactly at a hit.
#pragma once

#include <cstdint>

#include "pierce/types.h"

namespace pierce::tool {

template <class Real>
class HardRays {
 public:
  HardRays(MeshView<Real> mesh, std::uint64_t seed);

  /// A valid ray; the same one for the same mesh, seed and index.
  [[nodiscard]] Ray<Real> operator()(std::uint64_t index) const;

 private:
  MeshView<Real> mesh_;
  std::uint64_t seed_;
  Vec3<double> centre_;
  double radius_ = 0;  // half the largest side of the box
};

extern template class HardRays<float>;
extern template class HardRays<double>;

}  // namespace pierce::tool
