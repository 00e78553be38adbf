// SPDX-License-Identifier: Apache-2.0
//
// A ray as kernels take it, in float; and how it is made from one that double (or exact) arithmetic
// has brought to filter space. (In lanes: kernels/rays/transform-inl.h.)
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "exact/round_outward.h"
#include "pierce/options.h"
#include "predicate/bounds.h"
#include "space/filter_space.h"

namespace pierce::space {

/// A ray for the float rung. The true range lies within [tau_min, tau_max] and holds
/// [tau_first, tau_last].
struct alignas(16) FilterRay {
  float origin[4];  // x, y, z and a number that is not used
  float direction[4];
  float tau_min, tau_max;
  float tau_first, tau_last;
  bool exact;        // nothing was rounded: neither here nor in the leaves' copies
  Sides sides;       // others need not be told of
  bool masked;       // a certain hit counts only if the resolver says that the ray sees it
  float reach;       // a power of two, at least half the origin's max-norm
  double tau_scale;  // of an exact ray: tau = t * tau_scale, a power of two
};

/// One that was brought to a space which is not the scene's: its line, and the triangles that the
/// tree there has copies of, are not quite where they seem. They are off by no more than `blur`
/// together, in max-norm.
struct BlurredRay : FilterRay {
  float blur;
};

inline bool is_float(const Vec3<double>& p) {
  const auto same = [](double x) { return static_cast<double>(static_cast<float>(x)) == x; };
  return same(p.x) && same(p.y) && same(p.z);
}

/// The least power of two that is neither below `size` nor below kSmallestReach.
inline float reach_of(float size) {
  const auto bits = std::bit_cast<std::uint32_t>(std::max(size, bounds::kSmallestReach));
  return std::bit_cast<float>((bits + 0x7fffffU) & 0x7f800000U);
}

/// The reach of a ray with this origin, in max-norm, before it is rounded to float.
inline float reach_of_origin(float size) { return reach_of(size / kNearOrigin); }

/// No hit is certain any more: the resolver decides every triangle that is not discarded.
inline void doubt_all_hits(FilterRay& ray) {
  ray.tau_first = std::numeric_limits<float>::infinity();
}

inline FilterRay filter_ray(const TransformedRay& transformed, bool copies_exact) {
  FilterRay ray;
  ray.origin[0] = static_cast<float>(transformed.origin.x);
  ray.origin[1] = static_cast<float>(transformed.origin.y);
  ray.origin[2] = static_cast<float>(transformed.origin.z);
  ray.origin[3] = 0;
  ray.direction[0] = static_cast<float>(transformed.direction.x);
  ray.direction[1] = static_cast<float>(transformed.direction.y);
  ray.direction[2] = static_cast<float>(transformed.direction.z);
  ray.direction[3] = 1;
  const double first = transformed.tau_min, last = transformed.tau_max;
  ray.tau_min = static_cast<float>(first - transformed.tau_pad(first));
  ray.tau_max = static_cast<float>(last + transformed.tau_pad(last));
  ray.tau_first = static_cast<float>(first + transformed.tau_pad(first));
  ray.tau_last = static_cast<float>(last - transformed.tau_pad(last));
  const Vec3<double>& origin = transformed.origin;
  const double size = std::max({std::fabs(origin.x), std::fabs(origin.y), std::fabs(origin.z)});
  ray.reach = std::max(reach_of_origin(exact::round_up(size)), reach_of(transformed.reach));
  ray.exact = copies_exact && transformed.origin_kept && is_float(transformed.origin) &&
              is_float(transformed.direction);
  ray.sides = Sides::Both;
  ray.masked = false;
  ray.tau_scale = transformed.tau_scale;
  return ray;
}

}  // namespace pierce::space
