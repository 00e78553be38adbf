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

/// The scene of a case, by way of what it was before.
template <class Real>
struct Built {
  std::string name;             // of the quality
  std::vector<Mesh<Real>> own;  // what is changed in place
  Scene<Real> scene;

  Built(const Case<Real>& made, Quality quality);
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
/// Hits one by one, hit points and normals.
template <class Real>
void check_steps(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
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
