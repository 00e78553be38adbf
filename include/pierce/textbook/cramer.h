// SPDX-License-Identifier: Apache-2.0
//
// Cramer's rule on the 3x3 system, with the sub-determinants shared, as Shirley's "Fundamentals of
// Computer Graphics" (from its first edition, 2002) teaches it.
//
//   o + t d = a + beta (b - a) + gamma (c - a), as a system with known columns a - b, a - c, d:
//
//     | a d g | | beta  |   | j |      a b c are the components of a - b,  d e f those of a - c,
//     | b e h | | gamma | = | k |      g h i of the direction,  j k l of a - o
//     | c f i | | t     |   | l |
//
//   M     =  a (ei - hf) + b (gf - di) + c (dh - eg)
//   beta  = (j (ei - hf) + k (gf - di) + l (dh - eg)) / M
//   gamma = (i (ak - jb) + h (jc - al) + g (bl - kc)) / M
//   t     = -(f (ak - jb) + e (jc - al) + d (bl - kc)) / M
//
// Cost: 24 multiplications, 3 divisions; 18 and 1 when t is already out of range. Nothing kept.
//
// What it gets wrong in floating point: every test compares a rounded quotient, so a ray through
// an edge can be called either way, and by both triangles at that edge the same wrong way. A
// nearly parallel ray whose M should be 0 gets a tiny M of any sign and is judged by noise.
#pragma once

#include <optional>

#include "pierce/textbook/common.h"

namespace pierce::textbook {

/// Tests t against the range first, then gamma in [0, 1], then beta in [0, 1 - gamma], and leaves
/// as soon as one fails. |M| = 0 is no hit.
template <class Scalar>
std::optional<TextbookHit<Scalar>> cramer(const Ray<Scalar>& ray, const Vec3<Scalar>& corner_a,
                                          const Vec3<Scalar>& corner_b,
                                          const Vec3<Scalar>& corner_c) {
  const auto& [a, b, c] = corner_a - corner_b;
  const auto& [d, e, f] = corner_a - corner_c;
  const auto& [g, h, i] = ray.direction;
  const auto& [j, k, l] = corner_a - ray.origin;

  const Scalar ei_hf = e * i - h * f, gf_di = g * f - d * i, dh_eg = d * h - e * g;
  const Scalar m = a * ei_hf + b * gf_di + c * dh_eg;
  if (m == 0) return std::nullopt;

  const Scalar ak_jb = a * k - j * b, jc_al = j * c - a * l, bl_kc = b * l - k * c;
  const Scalar t = -(f * ak_jb + e * jc_al + d * bl_kc) / m;
  if (!in_range(ray, t)) return std::nullopt;

  const Scalar gamma = (i * ak_jb + h * jc_al + g * bl_kc) / m;
  if (gamma < 0 || gamma > 1) return std::nullopt;

  const Scalar beta = (j * ei_hf + k * gf_di + l * dh_eg) / m;
  if (beta < 0 || beta > 1 - gamma) return std::nullopt;

  return TextbookHit<Scalar>{t, beta, gamma};
}

}  // namespace pierce::textbook
