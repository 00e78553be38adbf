// SPDX-License-Identifier: Apache-2.0
//
// A scene whose vertices have moved: all that hangs on positions is made anew, the structure of the
// search tree stays.
#include <string>
#include <utility>

#include "scene/scene_impl.h"

namespace pierce {
namespace {

template <class Real>
void validate_counts(std::span<const MeshView<Real>> before,
                     std::span<const MeshView<Real>> after) {
  if (before.size() != after.size()) {
    throw Error(ErrorCode::SizeMismatch,
                "refit to " + std::to_string(after.size()) + " meshes of a scene built from " +
                    std::to_string(before.size()) + "; give as many, or build a new scene");
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (before[i].triangles.size() == after[i].triangles.size()) continue;
    throw Error(ErrorCode::SizeMismatch, "refit of geometry " + std::to_string(i) + " to " +
                                             std::to_string(after[i].triangles.size()) +
                                             " triangles, but it was built of " +
                                             std::to_string(before[i].triangles.size()) +
                                             "; give as many, or build a new scene");
  }
}

}  // namespace

template <class Real>
void Scene<Real>::refit(std::span<const MeshView<Real>> meshes, unsigned threads) {
  validate_counts<Real>(impl_->geometries.meshes(), meshes);
  BuildOptions options;
  options.threads = threads;
  scene::Geometries<Real> moved(meshes, options);
  if (impl_->tree.layout == bvh::Layout::Compact) moved.expect_no_copies();
  auto surface = std::make_unique<scene::LazySurface>();
  // From here on nothing fails.
  impl_->geometries = std::move(moved);
  impl_->surface = std::move(surface);
  bvh::refit(impl_->tree, impl_->geometries, threads);
}

template <class Real>
void Scene<Real>::refit(MeshView<Real> mesh, unsigned threads) {
  refit(std::span<const MeshView<Real>>(&mesh, 1), threads);
}

template <class Real>
void Scene<Real>::refit(unsigned threads) {
  refit(impl_->geometries.meshes(), threads);
}

template void Scene<float>::refit(std::span<const MeshView<float>>, unsigned);
template void Scene<double>::refit(std::span<const MeshView<double>>, unsigned);
template void Scene<float>::refit(MeshView<float>, unsigned);
template void Scene<double>::refit(MeshView<double>, unsigned);
template void Scene<float>::refit(unsigned);
template void Scene<double>::refit(unsigned);

}  // namespace pierce
