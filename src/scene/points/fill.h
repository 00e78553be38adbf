// SPDX-License-Identifier: Apache-2.0
//
// The fill of a scene's surface: another surface that ends at the very edges at which that one
// does, so that one less the other is closed. What a surface with holes winds around a point is
// then a whole number, counted by passages, plus what its fill winds, which is small and lies in
// the holes (docs/algorithm.md, "Winding numbers"). Made once, by whoever asks first.
#pragma once

#include <optional>
#include <vector>

#include "bvh/tree.h"
#include "kernels/points/winding.h"
#include "pierce/mesh.h"
#include "pierce/options.h"
#include "scene/geometries.h"
#include "support/lock.h"
#include "support/stop_poll.h"

namespace pierce::scene {

template <class Real>
struct Fill {
  Mesh<Real> mesh;  ///< corners are vertices of the scene; no triangle is without area
  Geometries<Real> geometries;
  bvh::Tree tree;
  kernels::WindingTree winding;
};

/// Throws Error (TooManyTriangles) if the vertices of all geometries together are 2^32 - 1 or more,
/// (Stopped).
template <class Real>
void make_fill(const Geometries<Real>& geometries, const WorkOptions& work, Fill<Real>& fill);

/// Thread-safe, as LazySurface is.
template <class Real>
class LazyFill {
 public:
  const Fill<Real>& of(const Geometries<Real>& geometries, const WorkOptions& work) {
    made_.call(
        [&] {
          const WorkOptions quiet{.threads = work.threads, .stop = work.stop};
          fill_.emplace();
          make_fill(geometries, quiet, *fill_);
        },
        [&] { StopPoll(work.stop).now(); });
    return *fill_;
  }

 private:
  parallel::Once made_;
  std::optional<Fill<Real>> fill_;
};

}  // namespace pierce::scene
