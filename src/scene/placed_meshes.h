// SPDX-License-Identifier: Apache-2.0
//
// Instances made into meshes: the transformed vertices of each, in memory of the scene's own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pierce/options.h"
#include "pierce/transform.h"

namespace pierce::scene {

template <class Real>
class PlacedMeshes {
 public:
  PlacedMeshes() = default;
  /// Throws Error (InvalidArgument) if a transform is not finite, (NonFiniteVertex) if a vertex
  /// that some triangle uses is too large once transformed; leaves vertices that are not finite
  /// themselves, and indices, to whoever looks at the meshes.
  PlacedMeshes(std::span<const Instance<Real>> instances, const BuildOptions& options);

  /// None if the scene was not built from instances.
  [[nodiscard]] std::span<const Instance<Real>> instances() const { return instances_; }
  /// One mesh an instance, good for as long as this lives, moved or not. The identity's is the
  /// caller's.
  [[nodiscard]] std::span<const MeshView<Real>> views() const { return views_; }
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  std::vector<Instance<Real>> instances_;
  std::vector<std::vector<Vec3<Real>>> vertices_;  // none for the identity
  std::vector<MeshView<Real>> views_;
};

}  // namespace pierce::scene
