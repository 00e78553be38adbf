// SPDX-License-Identifier: Apache-2.0
//
// Filter space: where the search tree lives. The scene's box mapped into [-1, 1]^3 by a translation
// and a power of two, so that every error bound of the float rung is a constant.
//
// A ray is brought here in double, its origin, if it is far away, moved along the ray to near the
// box (any point of the line does, so this costs no accuracy), its direction scaled by a power of
// two to a max-norm in [1, 2). Its parameter here is tau = t * 2^tau_exponent - tau_shift.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "pierce/types.h"
#include "predicate/bounds.h"
#include "predicate/types.h"

namespace pierce::space {

using bounds::kKeptOrigin;
using bounds::kNearOrigin;
using bounds::kTauLimit;

/// What is added to a tau, or taken off, before it is rounded to float.
inline double tau_pad(double tau, bool origin_kept) {
  return std::fabs(tau) * bounds::kTauPad +
         (origin_kept ? bounds::kTauFloorKept : bounds::kTauFloorMoved);
}

/// A ray in filter space, still in double. When `misses`, the line passes the scene's box by and
/// the rest is unspecified.
struct TransformedRay {
  Vec3<double> origin;      // max-norm at most kKeptOrigin; each component within 2^-53 of itself
                            // of the line's point; or, if it was moved, at most kNearOrigin, and
                            // within 2^-49 reach
  Vec3<double> direction;   // max-norm in [1, 2)
  double tau_min, tau_max;  // clamped to +-kTauLimit; exact, or as `tau` says
  double tau_shift;
  double tau_scale;  // 2^tau_exponent where that is a double, else 0
  int tau_exponent;
  float reach;       // of a moved origin, to cover its error; else 0
  bool origin_kept;  // the origin is the ray's own, mapped
  bool misses;
  bool exactly;  // by exact arithmetic: the origin is too far away for double

  /// tau for t, within 2^-50 of the true one, or 2^-52 of itself; clamped to +-kTauLimit.
  [[nodiscard]] double tau(double t) const;
  [[nodiscard]] double tau_pad(double tau) const { return space::tau_pad(tau, origin_kept); }
};

/// A filter space as the affine transform in double needs it (kernels/rays/transform-inl.h).
struct AffineMap {
  double center[4] = {0, 0, 0, 0};
  double scale = 0;  // a power of two
  bool usable = false;
  bool copies_exact = false;  // of the leaves (filter_ray.h)
};

/// What t is multiplied by where a ray goes to filter space with its origin where it is; 0 if that
/// may not be so.
double kept_tau_scale(const AffineMap& map, const Ray<double>& ray);

/// Scales and directions from 2^-kMildExponent to 2^kMildExponent are far from all limits, also
/// when two are multiplied.
inline constexpr int kMildExponent = 400;

class FilterSpace {
 public:
  FilterSpace() = default;
  /// The space for a box; an empty one (lower > upper) will do.
  FilterSpace(const Vec3<double>& lower, const Vec3<double>& upper);

  /// Within 2^-53 of the exact mapped value for points of the box.
  [[nodiscard]] Vec3<double> map(const Vec3<double>& p) const {
    return {(p.x - center_.x) * scale_ * scale_rest_, (p.y - center_.y) * scale_ * scale_rest_,
            (p.z - center_.z) * scale_ * scale_rest_};
  }

  /// The direction in which a point is seen from the centre, of max-norm 1; zero for the
  /// centre itself. Within 2^-40 for points at least 2^40 scene sizes away.
  [[nodiscard]] Vec3<double> direction_of(const Vec3<double>& p) const {
    // Halves, so that nothing overflows; what may underflow is then far below the rest.
    const Vec3<double> d{p.x * 0.5 - center_.x * 0.5, p.y * 0.5 - center_.y * 0.5,
                         p.z * 0.5 - center_.z * 0.5};
    const double size = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    return size > 0 ? Vec3<double>{d.x / size, d.y / size, d.z / size} : d;
  }

  /// A length, at least as long as the exact one (if less than the largest double or infinite).
  [[nodiscard]] double map_length(double length) const {
    return length * scale_ * scale_rest_ + 0x1p-1000;
  }

  /// Whether a float of the scene, none smaller than `smallest` in magnitude save 0, maps to a
  /// float exactly: only scaled, and not into the subnormals.
  [[nodiscard]] bool maps_floats_exactly(double smallest) const;

  /// The point whose exact image this is, where maps_floats_exactly holds.
  [[nodiscard]] Vec3<double> unmap_exact(float x, float y, float z) const {
    return {static_cast<double>(x) * unscale_, static_cast<double>(y) * unscale_,
            static_cast<double>(z) * unscale_};
  }

  /// What it multiplies by.
  [[nodiscard]] double unscale() const { return unscale_; }

  /// The scale as a float; NaN if that is not exact or the space is moved. Exact images of floats
  /// are then floats times this.
  [[nodiscard]] float float_scale() const { return float_scale_; }

  [[nodiscard]] AffineMap affine_map(bool copies_exact) const {
    return {{center_.x, center_.y, center_.z, 0},
            scale_,
            std::abs(exponent_) <= kMildExponent,
            copies_exact};
  }

  [[nodiscard]] TransformedRay transform(const predicate::RayD& ray) const;

 private:
  void transform_direction(const Vec3<double>& direction, TransformedRay& transformed) const;
  [[nodiscard]] bool move_origin(const predicate::RayD& ray, TransformedRay& transformed) const;
  void transform_exactly(const predicate::RayD& ray, TransformedRay& transformed) const;

  Vec3<double> center_{0, 0, 0};
  double scale_ = 1;  // 2^exponent_ = scale_ * scale_rest_: one double cannot hold 2^1074
  double scale_rest_ = 1;
  double unscale_ = 1;  // 2^-exponent_, where that is a double
  int exponent_ = 0;
  float float_scale_ = 1;
};

}  // namespace pierce::space
