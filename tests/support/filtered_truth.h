// SPDX-License-Identifier: Apache-2.0
//
// What is true of a ray under the options of a query: the hits of all triangles, as the oracle
// finds them, with those taken away that the ray does not see.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "pierce/options.h"
#include "support/brute_force.h"

namespace pierce::oracle {

template <class Real>
class FilteredTruth {
 public:
  /// `masks`: one a mesh.
  FilteredTruth(std::span<const MeshView<Real>> meshes, std::vector<std::uint32_t> masks)
      : all_(meshes), masks_(std::move(masks)) {}

  /// As if max_hits were unlimited.
  std::vector<Hit<Real>> all_hits(const Ray<Real>& ray, const QueryOptions& options) const {
    std::vector<Hit<Real>> hits = all_.all_hits(ray, options.range);
    std::erase_if(hits, [&](const Hit<Real>& hit) {
      return !sees({hit.geometry, hit.triangle}, options) ||
             (options.sides == Sides::Front && hit.facing != Facing::Front) ||
             (options.sides == Sides::Back && hit.facing != Facing::Back);
    });
    return hits;
  }

  Crossings crossings(const Ray<Real>& ray, const QueryOptions& options) const {
    return all_.crossings(ray, options.sides,
                          [&](const TriangleRef& of) { return sees(of, options); });
  }

 private:
  bool sees(const TriangleRef& of, const QueryOptions& options) const {
    return of != options.skip && (masks_[of.geometry] & options.mask) != 0;
  }

  BruteForce<Real> all_;
  std::vector<std::uint32_t> masks_;
};

}  // namespace pierce::oracle
