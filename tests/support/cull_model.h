// SPDX-License-Identifier: Apache-2.0
//
// The leaf cull of src/kernels/rays/cull-inl.h for one lane, with every intermediate in sight: it
// tells the tests that attack the bounds how near a case comes to them. It proves nothing itself;
// every case it picks is then given to the real kernels.
#pragma once

#include <algorithm>
#include <cmath>

#include "bvh/box.h"
#include "bvh/leaf_block.h"
#include "kernels/bounds.h"
#include "predicate/types.h"
#include "space/filter_ray.h"

namespace pierce::attack {

struct F3 {
  float x, y, z;
};
inline F3 operator-(const F3& p, const F3& q) { return {p.x - q.x, p.y - q.y, p.z - q.z}; }
inline F3 float_copy(const Vec3<double>& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// One lane's numbers; u, v, w, t with the sign of den taken out.
struct CullModel {
  float e, den, u, v, w, tau, tau_err;

  CullModel(const predicate::RayD& ray, const predicate::TriangleD& triangle, bool fused,
            bool exact)
      : fused_(fused) {
    const float edge = exact::round_up(bvh::largest_edge({triangle.a, triangle.b, triangle.c}));
    const F3 a = float_copy(triangle.a);
    const F3 e1 = float_copy(triangle.b) - a;
    const F3 e2 = float_copy(triangle.c) - a;
    const F3 s = a - float_copy(ray.origin);
    const F3 d = float_copy(ray.direction);
    const F3 n = cross(e1, e2);
    const F3 r = cross(d, s);
    const float den_signed = dot(n, d);
    const float sign = std::copysign(1.0F, den_signed);
    const float reach =
        std::max(space::reach_of_origin(largest(float_copy(ray.origin))),
                 space::reach_of(std::max({largest(a), largest(float_copy(triangle.b)),
                                           largest(float_copy(triangle.c))})));
    e = edge * (kernels::kEdgeLinear * reach + kernels::kEdgeSquare * edge) +
        kernels::kEdgeFloor * (reach * reach);
    den = std::fabs(den_signed);
    u = -dot(r, e2) * sign;
    v = dot(r, e1) * sign;
    w = den - u - v;
    tau = dot(n, s) * sign * (1 / den);
    const float inexact = exact ? 0 : reach;
    const float far = kernels::kTauReach * largest(s) + kernels::kTauInput * inexact;
    const float rest = edge * edge * (kernels::kTauCube * edge + kernels::kTauSquare * inexact) +
                       kernels::kTauFloor;
    tau_err = (largest(n) * far + rest) * (1 / den);
  }

  [[nodiscard]] bool safe() const { return den > kernels::kSumFactor * e; }
  /// Over 1: discarded.
  [[nodiscard]] float outside() const {
    return std::max({-u / e, -v / e, -w / (kernels::kSumFactor * e)});
  }
  /// Over 1: found certain.
  [[nodiscard]] float inside() const {
    return std::min({u / e, v / e, w / (kernels::kSumFactor * e), den / (kernels::kSumFactor * e)});
  }

 private:
  [[nodiscard]] float product_plus(float p, float q, float rest) const {
    return fused_ ? std::fma(p, q, rest) : p * q + rest;
  }
  [[nodiscard]] F3 cross(const F3& p, const F3& q) const {
    return {product_plus(p.y, q.z, -(p.z * q.y)), product_plus(p.z, q.x, -(p.x * q.z)),
            product_plus(p.x, q.y, -(p.y * q.x))};
  }
  [[nodiscard]] float dot(const F3& p, const F3& q) const {
    return product_plus(p.x, q.x, product_plus(p.y, q.y, p.z * q.z));
  }
  static float largest(const F3& p) {
    return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  }

  bool fused_;
};

}  // namespace pierce::attack
