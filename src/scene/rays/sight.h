// SPDX-License-Identifier: Apache-2.0
//
// What a ray sees: the options of a query in the scene's own numbers. Whoever decides about a
// triangle asks here whether the ray sees it at all; kernels only know the one that it skips.
#pragma once

#include <cstddef>
#include <cstdint>

#include "pierce/options.h"
#include "predicate/passage.h"
#include "scene/geometries.h"
#include "scene/validate_input.h"

namespace pierce::scene {

struct Sight {
  std::uint32_t skip = kNone;  // a primitive
  Sides sides = Sides::Both;
  std::uint32_t mask = kAllBits;
  bool all_geometries = true;  // the mask hides none

  /// Whether every triangle but `skip` is seen, from both sides. If not, no kernel may be certain
  /// of a hit by itself.
  [[nodiscard]] bool unlimited() const { return all_geometries && sides == Sides::Both; }

  template <class Real>
  [[nodiscard]] bool sees(const Geometries<Real>& geometries, std::uint32_t primitive) const {
    return all_geometries || geometries.is_seen(primitive, mask);
  }
  [[nodiscard]] bool sees(Facing facing) const {
    return sides == Sides::Both || (sides == Sides::Front) == (facing == Facing::Front);
  }
  [[nodiscard]] bool sees(predicate::Passage passage) const {
    return sees(passage == predicate::Passage::Entering ? Facing::Front : Facing::Back);
  }
};

/// `skip` is a primitive.
template <class Real>
Sight make_sight(const Geometries<Real>& geometries, std::uint32_t skip, Sides sides,
                 std::uint32_t mask) {
  return {skip, sides, mask, geometries.all_seen(mask)};
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
