// SPDX-License-Identifier: Apache-2.0
//
// What a ray sees: the options of a query in the scene's own numbers. Whoever decides about a
// triangle asks here whether the ray sees it at all; kernels only know the one that it skips.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pierce/options.h"
#include "predicate/decide.h"
#include "predicate/passage.h"
#include "scene/geometries.h"
#include "scene/validate_input.h"
#include "space/filter_ray.h"

namespace pierce::scene {

/// A hit of the ray's line that is not seen, nor what comes before it.
struct After {
  predicate::DecidedHit hit;
  std::uint32_t primitive = kNone;
};

struct Sight {
  std::uint32_t skip = kNone;  // a primitive
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;
  bool all_geometries = true;    // the mask hides none
  bool past_its_t = false;       // nor is what lies at the t of `after` seen
  const After* after = nullptr;  // kept by whoever asks

  /// Whether every triangle but `skip` is seen, from both sides and from the start. If not, no
  /// kernel may be certain of a hit in a space of its own.
  [[nodiscard]] bool unlimited() const {
    return all_geometries && sides == Sides::Both && after == nullptr;
  }
  /// Tells a ray in the scene's filter space what of this kernels can see to.
  void tell(space::FilterRay& ray) const {
    ray.sides = sides;
    ray.masked = !all_geometries;
    if (after != nullptr) space::doubt_all_hits(ray);
  }

  template <class Real>
  [[nodiscard]] bool sees(const Geometries<Real>& geometries, std::uint32_t primitive) const {
    return all_geometries || geometries.is_seen(primitive, mask);
  }
  [[nodiscard]] bool sees(Facing facing) const {
    return sides == Sides::Both || (sides == Sides::Front) == (facing == Facing::Front);
  }
  /// A hit that is decided, of a triangle whose geometry is seen.
  [[nodiscard]] bool sees(const predicate::RayD& ray, const predicate::DecidedHit& hit,
                          std::uint32_t primitive, predicate::LadderCounts& counts) const {
    return sees(hit.facing) && (after == nullptr || is_after(ray, hit, primitive, counts));
  }
  [[nodiscard]] bool sees(predicate::Passage passage) const {
    return sees(passage == predicate::Passage::Entering ? Facing::Front : Facing::Back);
  }

 private:
  [[nodiscard]] bool is_after(const predicate::RayD& ray, const predicate::DecidedHit& hit,
                              std::uint32_t primitive, predicate::LadderCounts& counts) const {
    if (primitive == after->primitive) return false;
    const auto order = predicate::decide_order(ray, hit, after->hit, counts);
    return order > 0 || (order == 0 && !past_its_t && primitive > after->primitive);
  }
};

/// Whether the first hit is one after another, or one that a filter accepts.
[[nodiscard]] inline bool goes_step_by_step(const QueryOptions& options) {
  return options.after.triangle != kNone || options.filter != nullptr;
}
[[nodiscard]] inline bool goes_step_by_step(const BatchOptions& options) {
  return !options.after.empty() || options.filter != nullptr;
}

/// `skip` is a primitive.
template <class Real>
Sight make_sight(const Geometries<Real>& geometries, std::uint32_t skip, Sides sides,
                 std::uint32_t mask) {
  return {skip, sides, mask, geometries.all_seen(mask), false, nullptr};
}

/// That of default options: of what can be seen at all, everything.
template <class Real>
Sight default_sight(const Geometries<Real>& geometries) {
  return make_sight(geometries, kNone, Sides::Both, kAllBits);
}

/// Of a single ray. Throws Error (InvalidArgument) if the triangle to skip does not exist.
template <class Real>
Sight sight_of(const Geometries<Real>& geometries, const QueryOptions& options) {
  std::uint32_t skip = kNone;
  if (options.skip.triangle != kNone) {
    validate_skip(geometries, options.skip);
    skip = geometries.primitive(options.skip);
  }
  return make_sight(geometries, skip, options.sides, options.mask);
}

/// Of a ray of a batch that has been validated.
template <class Real>
Sight sight_of(const Geometries<Real>& geometries, const BatchOptions& options, std::size_t ray) {
  return make_sight(geometries,
                    options.skip.empty() ? kNone : geometries.primitive(options.skip[ray]),
                    options.sides, options.masks.empty() ? options.mask : options.masks[ray]);
}

}  // namespace pierce::scene
