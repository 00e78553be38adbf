// SPDX-License-Identifier: Apache-2.0
//
// Scenes by all the ways that lead to the same answers: built, refitted, placed.
#include "campaign/check.h"

namespace pierce::campaign {
namespace {

template <class Real>
std::vector<MeshView<Real>> views_of(const std::vector<Mesh<Real>>& meshes) {
  std::vector<MeshView<Real>> views;
  for (const auto& mesh : meshes) views.push_back({mesh.vertices, mesh.triangles});
  return views;
}

template <class Real>
std::vector<Instance<Real>> instances_of(const Case<Real>& made, bool at_home) {
  std::vector<Instance<Real>> instances;
  for (const auto& [mesh, transform] : made.origin.placements) {
    const auto& source = made.origin.sources[mesh];
    instances.push_back({{source.vertices, source.triangles}, {}});
    if (!at_home) instances.back().transform = transform;
  }
  return instances;
}

template <class Real>
Scene<Real> begun(const Case<Real>& made, const std::vector<Mesh<Real>>& own, Quality quality) {
  BuildOptions options{
      .quality = quality, .masks = made.geometry_masks, .work = {.threads = made.build_threads}};
  // Half of the instances share their meshes' trees.
  if ((made.origin.placements.size() + static_cast<std::size_t>(quality)) % 2 == 0)
    options.flatten_limit = 0;
  if (!made.origin.placements.empty()) {
    const auto instances = instances_of(made, made.origin.placed_later);
    return Scene<Real>::build(std::span<const Instance<Real>>(instances), options);
  }
  const auto views = views_of(own.empty() ? made.meshes : own);
  return Scene<Real>::build(std::span<const MeshView<Real>>(views), options);
}

}  // namespace

template <class Real>
Built<Real>::Built(const Case<Real>& made, Quality quality)
    : name("quality " + std::to_string(int(quality))),
      own(made.origin.before),
      scene(begun(made, own, quality)) {
  const unsigned threads = made.build_threads;
  if (!made.origin.placements.empty()) {
    const auto instances = instances_of(made, false);
    if (made.origin.placed_later) {
      scene.refit(std::span<const Instance<Real>>(instances), {.threads = threads});
    }
  } else if (!own.empty() && made.origin.in_place) {
    for (std::size_t g = 0; g < own.size(); ++g) {
      std::copy(made.meshes[g].vertices.begin(), made.meshes[g].vertices.end(),
                own[g].vertices.begin());
    }
    scene.refit({.threads = threads});
  } else if (!own.empty()) {
    const auto views = views_of(made.meshes);
    scene.refit(std::span<const MeshView<Real>>(views), {.threads = threads});
  }
}

template struct Built<float>;
template struct Built<double>;

}  // namespace pierce::campaign
