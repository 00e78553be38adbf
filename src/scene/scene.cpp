// SPDX-License-Identifier: Apache-2.0
//
// Building a scene, and asking it about one ray.
#include "pierce/scene.h"

#include "predicate/settle.h"
#include "scene/fine_parts.h"
#include "scene/rays/counted_hits.h"
#include "scene/rays/ray_query.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"

namespace pierce {

template <class Real>
std::unique_ptr<typename Scene<Real>::Impl> Scene<Real>::Impl::build(
    std::span<const MeshView<Real>> meshes, scene::PlacedMeshes<Real> placed,
    const BuildOptions& options) {
  const FloatEnvironment environment;
  auto impl = std::make_unique<Impl>();
  impl->placed = std::move(placed);
  impl->geometries = scene::Geometries<Real>(meshes, options);
  if (options.quality == Quality::Compact) impl->geometries.expect_no_copies();
  impl->tree = tree_over(impl->geometries, options.quality, options.work);
  impl->quality = options.quality;
  impl->built_cost = impl->tree.sah_cost;
  impl->kernel = &kernels::active_kernel();
  impl->part(options.work);
  return impl;
}

template <class Real>
void Scene<Real>::Impl::part(const WorkOptions& work) {
  if (quality == Quality::Compact || tree.root == bvh::kNoChild) return;
  const auto parts = scene::fine_parts(tree);
  if (parts.empty()) return;
  auto found = std::make_unique<scene::TwoLevel<Real>>(
      geometries, parts, BuildOptions{.quality = quality, .work = work});
  if (!found->usable()) return;
  geometries.expect_other_spaces();
  two_level = std::move(found);
}

template <class Real>
std::unique_ptr<typename Scene<Real>::Impl> Scene<Real>::Impl::share(
    std::span<const Instance<Real>> instances, const BuildOptions& options) {
  scene::validate_transforms(instances);
  std::vector<Instance<Real>> placed(instances.begin(), instances.end());
  std::vector<Mesh<Real>> baked(instances.size());
  auto impl = std::make_unique<Impl>();
  impl->two_level = std::make_unique<scene::TwoLevel<Real>>(placed, baked, options);
  if (!impl->two_level->usable()) return nullptr;
  impl->geometries = impl->two_level->geometries(placed, options);
  impl->placed = scene::PlacedMeshes<Real>(instances, std::move(baked));
  impl->quality = options.quality;
  impl->built_cost = 0;
  impl->kernel = &kernels::active_kernel();
  return impl;
}

template <class Real>
std::unique_ptr<typename Scene<Real>::Impl> Scene<Real>::Impl::build(
    std::span<const Instance<Real>> instances, const BuildOptions& options) {
  if (scene::are_to_share(instances, options)) {
    if (auto impl = share(instances, options)) return impl;
  }
  scene::PlacedMeshes<Real> placed(instances, options);
  const std::span<const MeshView<Real>> views = placed.views();
  return build(views, std::move(placed), options);
}

template <class Real>
bvh::Tree Scene<Real>::Impl::tree_over(const scene::Geometries<Real>& geometries, Quality quality,
                                       const WorkOptions& work) {
  return bvh::build(geometries, {.quality = quality, .work = work},
                    quality == Quality::Compact ? bvh::Layout::Compact : bvh::Layout::Full);
}

template <class Real>
inline bool Scene<Real>::Impl::closest(const Ray<Real>& ray, Range range, const scene::Sight& sight,
                                       Hit<Real>& hit) const {
  scene::RayQuery<Real> query(*kernel, geometries, ray, range, sight);
  return query.closest(tree, two_level.get(), nullptr, hit);
}

template <class Real>
bool Scene<Real>::Impl::any(const Ray<Real>& ray, Range range, const scene::Sight& sight) const {
  scene::RayQuery<Real> query(*kernel, geometries, ray, range, sight);
  return query.any(tree, two_level.get());
}

template <class Real>
void Scene<Real>::Impl::Counts::add_to(Statistics& statistics) const {
  statistics.rays += rays;
  statistics.nodes += kernel.nodes;
  statistics.leaves += kernel.leaves;
  statistics.candidates += kernel.candidates;
  statistics.certified += ladder.certified;
  statistics.settled += ladder.settled;
  statistics.settled_big += ladder.settled_big;
  statistics.orders_certified += ladder.orders_certified;
  statistics.orders_settled += ladder.orders_settled;
  statistics.hits += hits;
  statistics.rounded_exactly += ladder.rounded_exactly;
  statistics.rays_placed_exactly += placed_exactly;
}

template <class Real>
Scene<Real>::Scene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
template <class Real>
Scene<Real>::Scene(Scene&&) noexcept = default;
template <class Real>
Scene<Real>& Scene<Real>::operator=(Scene&&) noexcept = default;
template <class Real>
Scene<Real>::~Scene() = default;

template <class Real>
Scene<Real> Scene<Real>::build(MeshView<Real> mesh, const BuildOptions& options) {
  return build(std::span<const MeshView<Real>>(&mesh, 1), options);
}

template <class Real>
Scene<Real> Scene<Real>::build(std::span<const MeshView<Real>> meshes,
                               const BuildOptions& options) {
  const FloatEnvironment environment;
  return Scene(Impl::build(meshes, {}, options));
}

template <class Real>
Scene<Real> Scene<Real>::build(std::span<const Instance<Real>> instances,
                               const BuildOptions& options) {
  const FloatEnvironment environment;
  return Scene(Impl::build(instances, options));
}

template <class Real>
Scene<Real> Scene<Real>::build(std::span<const MeshArrays<Real>> meshes,
                               const BuildOptions& options) {
  const FloatEnvironment environment;
  scene::PlacedMeshes<Real> placed(meshes, options.work);
  const std::span<const MeshView<Real>> views = placed.views();
  return Scene(Impl::build(views, std::move(placed), options));
}

template <class Real>
Scene<Real> Scene<Real>::build_owning(std::vector<Mesh<Real>> meshes, const BuildOptions& options) {
  const FloatEnvironment environment;
  scene::PlacedMeshes<Real> placed(std::move(meshes));
  const std::span<const MeshView<Real>> views = placed.views();
  return Scene(Impl::build(views, std::move(placed), options));
}

template <class Real>
std::optional<Hit<Real>> Scene<Real>::Impl::first_counted(const Ray<Real>& ray,
                                                          const QueryOptions& options) const {
  scene::validate_ray(ray);
  const scene::Sight sight = scene::sight_of(geometries, options);
  scene::validate_after(geometries, ray, options.after);
  Counts counts;
  const scene::Asked<Real> asked(geometries, ray, sight, options.after, options.distinct,
                                 counts.ladder);
  scene::CountedHits<Real> hits(*this, options, {}, counts);
  hits.start(asked, 0, false);
  return hits.next() ? std::optional(hits.hit()) : std::nullopt;
}

template <class Real>
std::optional<Hit<Real>> Scene<Real>::closest_hit(const Ray<Real>& ray) const {
  const FloatEnvironment environment;
  std::optional<Hit<Real>> found(std::in_place);  // filled in its place: a copy would have to wait
  const scene::Sight sight = scene::default_sight(impl_->geometries);
  if (!impl_->closest(ray, Range::Closed, sight, *found)) found.reset();
  return found;
}

template <class Real>
std::optional<Hit<Real>> Scene<Real>::closest_hit(const Ray<Real>& ray,
                                                  const QueryOptions& options) const {
  const FloatEnvironment environment;
  if (scene::is_bad_miss(ray, options)) [[unlikely]]
    return std::nullopt;
  if (scene::goes_step_by_step(options)) [[unlikely]]
    return impl_->first_counted(ray, options);
  const scene::Sight sight = scene::sight_of(impl_->geometries, options);
  std::optional<Hit<Real>> found(std::in_place);
  if (!impl_->closest(ray, options.range, sight, *found)) found.reset();
  return found;
}

template <class Real>
bool Scene<Real>::any_hit(const Ray<Real>& ray) const {
  const FloatEnvironment environment;
  return impl_->any(ray, Range::Closed, scene::default_sight(impl_->geometries));
}

template <class Real>
bool Scene<Real>::any_hit(const Ray<Real>& ray, const QueryOptions& options) const {
  const FloatEnvironment environment;
  if (scene::is_bad_miss(ray, options)) [[unlikely]]
    return false;
  if (scene::goes_step_by_step(options)) [[unlikely]]
    return impl_->first_counted(ray, options).has_value();
  return impl_->any(ray, options.range, scene::sight_of(impl_->geometries, options));
}

template <class Real>
SceneInfo Scene<Real>::info() const {
  const FloatEnvironment environment;
  SceneInfo info;
  info.triangles = impl_->geometries.size();
  for (const MeshView<Real>& mesh : impl_->geometries.meshes())
    info.vertices += mesh.vertices.size();
  for (std::uint32_t i = 0; i < impl_->geometries.size(); ++i) {
    info.degenerate += predicate::settle_has_area(impl_->geometries.triangle(i)) ? 0 : 1;
  }
  const auto add = [&info](const bvh::Tree& tree) {
    info.nodes += tree.nodes.size();
    info.leaves += tree.leaf_blocks;
  };
  add(impl_->tree);
  info.sah_cost = impl_->tree.sah_cost;
  info.bytes = impl_->tree.bytes() + impl_->placed.bytes() + sizeof(Impl);
  if (impl_->two_level != nullptr) {
    add(impl_->two_level->top());
    for (const auto& bottom : impl_->two_level->bottoms()) add(bottom->tree);
    if (impl_->geometries.shares_meshes()) info.sah_cost = impl_->two_level->top().sah_cost;
    info.bytes += impl_->two_level->bytes();
  }
  return info;
}

template class Scene<float>;
template class Scene<double>;

}  // namespace pierce
