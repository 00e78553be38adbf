// SPDX-License-Identifier: Apache-2.0
//
// Where a batch's hits go: into the caller's Hits where there are any, else by way of a tile into
// the caller's columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "kernels/kernel.h"
#include "pierce/arrays.h"
#include "scene/rays/place_columns.h"
#include "scene/strided.h"
#include "scene/validate_input.h"
#include "support/room.h"

namespace pierce::scene {

template <class Real>
class HitTiles {
 public:
  using Tile = Room<Hit<Real>, kernels::kBlockSize>;

  /// Throws Error (SizeMismatch, InvalidArgument) unless each column that is wanted has a row for
  /// every ray.
  HitTiles(const HitArrays<Real>& arrays, std::size_t rays)
      : hits_(arrays.hits.data()),
        t_(arrays.t, rays, "ray", "t"),
        u_(arrays.u, rays, "ray", "u"),
        v_(arrays.v, rays, "ray", "v"),
        w_(arrays.w, rays, "ray", "w"),
        geometry_(arrays.geometry, rays, "ray", "geometry"),
        triangle_(arrays.triangle, rays, "ray", "triangle"),
        facing_(arrays.facing, rays, "ray", "facing"),
        places_(arrays, rays) {
    if (!arrays.hits.empty()) validate_outputs("ray", rays, arrays.hits.size());
  }

  /// Where to put the hits of the rays from `first` on: in place, or in the tile.
  [[nodiscard]] Hit<Real>* room(std::size_t first, Tile& tile) const {
    return hits_ != nullptr ? hits_ + first : tile.data();
  }
  [[nodiscard]] const PlaceColumns<Real>& places() const { return places_; }
  /// The hits of the rays from `first` on, made in that room or elsewhere; places are for the
  /// caller to write.
  void write(std::size_t first, std::span<const Hit<Real>> hits) const {
    if (hits_ != nullptr && hits.data() != hits_ + first)
      std::copy(hits.begin(), hits.end(), hits_ + first);
    using H = Hit<Real>;
    t_.write(first, hits, [](const H& hit) { return hit.t; });
    u_.write(first, hits, [](const H& hit) { return hit.u; });
    v_.write(first, hits, [](const H& hit) { return hit.v; });
    w_.write(first, hits, [](const H& hit) { return hit.w; });
    geometry_.write(first, hits, [](const H& hit) { return hit.geometry; });
    triangle_.write(first, hits, [](const H& hit) { return hit.triangle; });
    facing_.write(first, hits, [](const H& hit) { return static_cast<std::uint8_t>(hit.facing); });
  }

 private:
  Hit<Real>* hits_;
  OutputRows<Real> t_, u_, v_, w_;
  OutputIds geometry_, triangle_;
  OutputRows<std::uint8_t> facing_;
  PlaceColumns<Real> places_;
};

}  // namespace pierce::scene
