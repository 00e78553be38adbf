// SPDX-License-Identifier: Apache-2.0
//
// A scene whose vertices have moved: all that hangs on positions is made anew; the structure of the
// search tree stays as long as it is worth it.
#include <string>
#include <utility>

#include "scene/scene_impl.h"
#include "support/float_environment.h"

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

// Triangles have parted from those that were their neighbours when the tree was built: rays would
// meet twice as much as then.
bool is_worn(const bvh::Tree& tree, double built_cost) { return tree.sah_cost > 2 * built_cost; }

WorkOptions without_progress(const WorkOptions& work) {
  WorkOptions silent = work;
  silent.progress = nullptr;
  return silent;
}

}  // namespace

template <class Real>
void Scene<Real>::Impl::refit(std::span<const MeshView<Real>> meshes,
                              scene::PlacedMeshes<Real> moved, const WorkOptions& work) {
  validate_counts<Real>(geometries.meshes(), meshes);
  if (two_level != nullptr) {  // they share nothing any more, or part in other ways
    become(build(meshes, std::move(moved), options_of(work)));
    return;
  }
  const BuildOptions options = options_of(work);
  scene::Geometries<Real> anew(meshes, options);
  if (tree.layout == bvh::Layout::Compact) anew.expect_no_copies();
  auto unknown = std::make_unique<scene::LazySurface>();
  auto unmade = std::make_unique<LazyUnique>();
  auto unfilled = std::make_unique<scene::LazyFill<Real>>();
  WorkOptions fit = work;
  if (work.progress) {  // the end is told when it is known to be the end
    fit.progress = [&work](double fraction) {
      if (fraction < 1) work.progress(fraction);
    };
  }
  // What may end half way (by a stop, or by what the caller's progress throws) works on a copy.
  const bool may_end = work.stop != nullptr || work.progress != nullptr;
  double cost = built_cost;
  const auto fit_or_build = [&](bvh::Tree& fitted, const scene::Geometries<Real>& over) {
    bvh::refit(fitted, over, fit);
    if (!is_worn(fitted, cost)) return;
    fitted = tree_over(over, quality, without_progress(work));
    cost = fitted.sah_cost;
  };
  if (may_end) {
    bvh::Tree fitted = tree.copy(work);
    fit_or_build(fitted, anew);
    if (work.progress) work.progress(1);
    scene::StopPoll(work.stop).now();
    tree = std::move(fitted);
  }
  // From here on nothing fails, but for want of memory once all is in order.
  geometries = std::move(anew);
  placed = std::move(moved);
  surface = std::move(unknown);
  unique = std::move(unmade);
  fill = std::move(unfilled);
  if (!may_end) {
    fit_or_build(tree, geometries);
  } else if (tree.layout == bvh::Layout::Compact) {
    tree.primitives = &geometries;
  }
  built_cost = cost;
}

// Trees of meshes are made anew: their vertices may have moved, too. If anything throws, the scene
// is as it was.
template <class Real>
void Scene<Real>::Impl::place_anew(std::span<const Instance<Real>> instances,
                                   const WorkOptions& work) {
  std::vector<MeshView<Real>> meshes;
  for (const Instance<Real>& instance : instances) meshes.push_back(instance.mesh);
  validate_counts<Real>(geometries.meshes(), meshes);
  std::unique_ptr<Impl> anew = share(instances, options_of(work));
  if (anew == nullptr) {
    scene::PlacedMeshes<Real> moved(instances, options_of(work));
    const std::span<const MeshView<Real>> views = moved.views();
    anew = build(views, std::move(moved), options_of(work));
  }
  become(std::move(anew));
}

template <class Real>
BuildOptions Scene<Real>::Impl::options_of(const WorkOptions& work) const {
  return {.quality = quality, .masks = geometries.masks(), .work = work};
}

template <class Real>
void Scene<Real>::Impl::become(std::unique_ptr<Impl> other) {
  *this = std::move(*other);
  if (tree.layout == bvh::Layout::Compact) tree.primitives = &geometries;
}

template <class Real>
void Scene<Real>::refit(std::span<const MeshView<Real>> meshes, const WorkOptions& work) {
  const FloatEnvironment environment;
  impl_->refit(meshes, {}, work);
}

template <class Real>
void Scene<Real>::refit(std::span<const Instance<Real>> instances, const WorkOptions& work) {
  const FloatEnvironment environment;
  BuildOptions options;
  options.work = work;
  if (impl_->geometries.shares_meshes()) {
    impl_->place_anew(instances, work);
    return;
  }
  scene::PlacedMeshes<Real> moved(instances, options);
  const std::span<const MeshView<Real>> views = moved.views();
  impl_->refit(views, std::move(moved), work);
}

template <class Real>
void Scene<Real>::refit(std::span<const MeshArrays<Real>> meshes, const WorkOptions& work) {
  const FloatEnvironment environment;
  scene::PlacedMeshes<Real> moved(meshes, work);
  const std::span<const MeshView<Real>> views = moved.views();
  impl_->refit(views, std::move(moved), work);
}

template <class Real>
void Scene<Real>::refit_owning(std::vector<Mesh<Real>> meshes, const WorkOptions& work) {
  scene::PlacedMeshes<Real> moved(std::move(meshes));
  const std::span<const MeshView<Real>> views = moved.views();
  impl_->refit(views, std::move(moved), work);
}

template <class Real>
void Scene<Real>::refit(MeshView<Real> mesh, const WorkOptions& work) {
  refit(std::span<const MeshView<Real>>(&mesh, 1), work);
}

template <class Real>
void Scene<Real>::refit(const WorkOptions& work) {
  if (const auto instances = impl_->placed.instances(); !instances.empty()) {
    refit(instances, work);
  } else if (const auto arrays = impl_->placed.arrays(); !arrays.empty()) {
    refit(arrays, work);
  } else if (!impl_->placed.owns_all()) {  // what the scene owns has not moved
    refit(impl_->geometries.meshes(), work);
  }
}

template void Scene<float>::Impl::refit(std::span<const MeshView<float>>,
                                        scene::PlacedMeshes<float>, const WorkOptions&);
template BuildOptions Scene<float>::Impl::options_of(const WorkOptions&) const;
template BuildOptions Scene<double>::Impl::options_of(const WorkOptions&) const;
template void Scene<float>::Impl::become(std::unique_ptr<Impl>);
template void Scene<double>::Impl::become(std::unique_ptr<Impl>);
template void Scene<float>::Impl::place_anew(std::span<const Instance<float>>, const WorkOptions&);
template void Scene<double>::Impl::place_anew(std::span<const Instance<double>>,
                                              const WorkOptions&);
template void Scene<double>::Impl::refit(std::span<const MeshView<double>>,
                                         scene::PlacedMeshes<double>, const WorkOptions&);
template void Scene<float>::refit(std::span<const MeshView<float>>, const WorkOptions&);
template void Scene<double>::refit(std::span<const MeshView<double>>, const WorkOptions&);
template void Scene<float>::refit(std::span<const Instance<float>>, const WorkOptions&);
template void Scene<double>::refit(std::span<const Instance<double>>, const WorkOptions&);
template void Scene<float>::refit(std::span<const MeshArrays<float>>, const WorkOptions&);
template void Scene<float>::refit_owning(std::vector<Mesh<float>>, const WorkOptions&);
template void Scene<float>::refit(MeshView<float>, const WorkOptions&);
template void Scene<double>::refit(std::span<const MeshArrays<double>>, const WorkOptions&);
template void Scene<double>::refit_owning(std::vector<Mesh<double>>, const WorkOptions&);
template void Scene<double>::refit(MeshView<double>, const WorkOptions&);
template void Scene<float>::refit(const WorkOptions&);
template void Scene<double>::refit(const WorkOptions&);

}  // namespace pierce
