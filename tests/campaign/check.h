// SPDX-License-Identifier: Apache-2.0
//
// Asks the library all that a case asks, in every way, and the campaign's own oracle once.
#pragma once

#include "campaign/case.h"
#include "campaign/tally.h"
#include "pierce/scene.h"

namespace pierce::campaign {

/// All of it. Differences go to the tally.
void check(const AnyCase& any, Tally& tally);

/// The scene of a case.
template <class Real>
struct Built {
  std::vector<MeshView<Real>> views;
  Scene<Real> scene;
  std::string name;  // of the quality

  static std::vector<MeshView<Real>> views_of(const Case<Real>& made) {
    std::vector<MeshView<Real>> views;
    for (const auto& mesh : made.meshes) views.push_back({mesh.vertices, mesh.triangles});
    return views;
  }
  Built(const Case<Real>& made, Quality quality)
      : views(views_of(made)),
        scene(Scene<Real>::build(
            views,
            {.quality = quality, .threads = made.build_threads, .masks = made.geometry_masks})),
        name("quality " + std::to_string(int(quality))) {}
};

template <class Real>
using Scenes = std::vector<Built<Real>>;

/// What the scene says of itself, and whether its meshes are closed.
template <class Real>
void check_info(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                Tally& tally);
/// Hits and crossings, single and batch.
template <class Real>
void check_rays(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                Tally& tally);
/// Where the next ray starts.
template <class Real>
void check_starts(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                  Tally& tally);
/// Nearest points.
template <class Real>
void check_nearest(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                   Tally& tally);
/// Locations, signed distances, grids.
template <class Real>
void check_inside(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                  Tally& tally);

}  // namespace pierce::campaign
