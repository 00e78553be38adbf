// SPDX-License-Identifier: Apache-2.0
//
// What counts where hits are gone through one by one: after a hit, one for each t, those that a
// filter accepts. And hit points and normals. From the exact hits of a ray's line.
#pragma once

#include <algorithm>
#include <vector>

#include "campaign/hit_oracle.h"

namespace pierce::campaign {

/// A filter whose answers look arbitrary, but depend on what it is told alone. It refuses all,
/// accepts all, or does either now and then.
struct Whim {
  std::uint64_t salt = 0;
  unsigned refused = 0;  // of eight hits

  [[nodiscard]] bool accepts(std::uint64_t ray, const TriangleRef& ref) const {
    std::uint64_t x = salt ^ (ray * 0x9e3779b97f4a7c15u);
    x = (x ^ (std::uint64_t{ref.geometry} << 32 ^ ref.triangle)) * 0xbf58476d1ce4e5b9u;
    return ((x ^ (x >> 29)) * 0x94d049bb133111ebu >> 61) >= refused;
  }
};

/// What of QueryOptions a Question does not hold.
struct Steps {
  TriangleRef after = {};
  bool distinct = false;
  const Whim* filter = nullptr;
  std::uint64_t ray = 0;  // its number for the filter
};

struct Stepped {
  std::vector<ExactHit> hits, asked;  // those that count, those that the filter is asked about
};

/// The first `most` hits that count, of the line's hits in their order.
inline Stepped stepped(const std::vector<ExactHit>& line, const Question& question,
                       const Steps& steps, std::uint64_t most) {
  Stepped result;
  auto next = line.begin();
  const Ratio* passed = nullptr;  // at which nothing more counts
  if (steps.after.triangle != kNone) {
    while (next->ref != steps.after) ++next;
    if (steps.distinct) passed = &next->t;
    ++next;
  }
  for (; next != line.end() && result.hits.size() < most; ++next) {
    if (asked({*next}, question).empty() || (passed != nullptr && *passed == next->t)) continue;
    if (steps.filter != nullptr) {
      result.asked.push_back(*next);
      if (!steps.filter->accepts(steps.ray, next->ref)) continue;
    }
    result.hits.push_back(*next);
    if (steps.distinct) passed = &next->t;
  }
  return result;
}

template <class Real>
Vec3<Real> rounded_point(const Question& ray, const Ratio& t) {
  const auto at = [&](double o, double d) { return rounded<Real>(Ratio(o) + t * Ratio(d)); };
  return {at(ray.origin.x, ray.direction.x), at(ray.origin.y, ray.direction.y),
          at(ray.origin.z, ray.direction.z)};
}

/// (b - a) x (c - a) and its unit vector.
template <class Real>
struct Normals {
  Vec3<Real> normal, unit;

  explicit Normals(const Corners& corners) {
    Scale scale;
    scale.see(corners.a).see(corners.b).see(corners.c);
    const IntVec a = scale.integers(corners.a);
    const IntVec n = cross(scale.integers(corners.b) - a, scale.integers(corners.c) - a);
    const Int square = dot(n, n);
    const auto component = [&](const Int& x) { return rounded<Real>(scale.restore(x, 2)); };
    const auto part = [&](const Int& x) {
      const Real size = rounded_root<Real>(ratio(x * x, square));
      return x < 0 && size != 0 ? -size : size;
    };
    normal = {component(n.x), component(n.y), component(n.z)};
    unit = {0, 0, 0};
    if (square != 0) unit = {part(n.x), part(n.y), part(n.z)};
  }
};

}  // namespace pierce::campaign
