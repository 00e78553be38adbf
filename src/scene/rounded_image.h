// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "exact/affine.h"
#include "pierce/transform.h"
#include "pierce/types.h"

namespace pierce::scene {

/// Where the transform takes the point, each coordinate rounded once (pierce::transformed, without
/// its checks).
template <class Real>
Vec3<Real> rounded_image(const Transform<Real>& transform, const Vec3<Real>& p) {
  const auto& rows = transform.rows;
  return {exact::round_affine_fast(rows[0], p.x, p.y, p.z),
          exact::round_affine_fast(rows[1], p.x, p.y, p.z),
          exact::round_affine_fast(rows[2], p.x, p.y, p.z)};
}

}  // namespace pierce::scene
