// SPDX-License-Identifier: Apache-2.0
//
// What a scene keeps of the meshes it was built from, where that is not the caller's: the
// transformed vertices of instances, meshes that it took over, copies of arrays that did not lie
// right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pierce/mesh.h"
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

  explicit PlacedMeshes(std::vector<Mesh<Real>> meshes);
  /// Of instances whose vertices are transformed when they are asked for, save those of `baked`,
  /// one mesh each. There are no views.
  PlacedMeshes(std::span<const Instance<Real>> instances, std::vector<Mesh<Real>> baked)
      : instances_(instances.begin(), instances.end()), owned_(std::move(baked)) {}
  /// Throws Error if indices do not fit, see view_or_copy, or (Stopped).
  PlacedMeshes(std::span<const MeshArrays<Real>> meshes, const WorkOptions& work);

  /// None if the scene was not built from arrays.
  [[nodiscard]] std::span<const MeshArrays<Real>> arrays() const { return arrays_; }
  /// None if the scene was not built from instances.
  [[nodiscard]] std::span<const Instance<Real>> instances() const { return instances_; }
  /// Whether the meshes were taken over.
  [[nodiscard]] bool owns_all() const {
    return !owned_.empty() && arrays_.empty() && instances_.empty();
  }
  /// One mesh each, in order, good for as long as this lives, moved or not. The identity's is the
  /// caller's.
  [[nodiscard]] std::span<const MeshView<Real>> views() const { return views_; }
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  std::vector<Instance<Real>> instances_;
  std::vector<MeshArrays<Real>> arrays_;
  std::vector<Mesh<Real>> owned_;  // one each; what is viewed where the caller has it is empty here
  std::vector<MeshView<Real>> views_;
};

/// The vertices of an instance, transformed. `number`: what the instance is called in an Error,
/// which is thrown as PlacedMeshes says.
template <class Real>
std::vector<Vec3<Real>> transformed_vertices(const Instance<Real>& instance, std::size_t number,
                                             const WorkOptions& work);
/// Throws Error (InvalidArgument) about the first transform that is not finite.
template <class Real>
void validate_transforms(std::span<const Instance<Real>> instances);

}  // namespace pierce::scene
