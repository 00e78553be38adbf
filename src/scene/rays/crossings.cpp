// SPDX-License-Identifier: Apache-2.0
//
// How often rays pass through the surface, and where points lie: the queries that count passages.
#include "bvh/point_walk.h"
#include "scene/rays/one_by_one.h"
#include "scene/rays/passage_counter.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"

namespace pierce {

template <class Real>
bool Scene<Real>::Impl::on_surface(const Vec3<double>& point, const scene::Sight& sight) const {
  const Vec3<double> p = geometries.space().map(point);
  return bvh::walk_point(tree, p, [&](std::uint32_t primitive) {
    return primitive != sight.skip && sight.sees(geometries, primitive) &&
           predicate::decide_on_triangle(point, geometries.triangle(primitive));
  });
}

template <class Real>
Crossings Scene<Real>::Impl::crossings(const Ray<Real>& ray, const scene::Sight& sight,
                                       scene::PassageCounter<Real>& counter, Counts& counts) const {
  Crossings result;
  result.origin_on_surface = on_surface(predicate::to_double(ray.origin), sight);
  if (!tell_all(ray, Range::Closed, sight, counter, counts)) return result;
  counter.count(result);
  counts.hits += result.count;
  return result;
}

template <class Real>
Crossings Scene<Real>::crossings(const Ray<Real>& ray, const QueryOptions& options) const {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  typename Impl::Counts counts;
  scene::PassageCounter<Real> counter(impl_->geometries, {}, counts.ladder);
  return impl_->crossings(ray, scene::sight_of(impl_->geometries, options), counter, counts);
}

template <class Real>
void Scene<Real>::crossings(std::span<const Ray<Real>> rays, std::span<Crossings> results,
                            const BatchOptions& options) const {
  const FloatEnvironment environment;
  scene::answer_one_by_one<scene::PassageCounter<Real>>(
      *impl_, rays, results, options,
      [this](const Ray<Real>& ray, const scene::Sight& sight, auto& counter, auto& counts) {
        return impl_->crossings(ray, sight, counter, counts);
      });
}

template bool Scene<float>::Impl::on_surface(const Vec3<double>&, const scene::Sight&) const;
template Crossings Scene<float>::Impl::crossings(const Ray<float>&, const scene::Sight&,
                                                 scene::PassageCounter<float>&, Counts&) const;
template Crossings Scene<float>::crossings(const Ray<float>&, const QueryOptions&) const;
template void Scene<float>::crossings(std::span<const Ray<float>>, std::span<Crossings>,
                                      const BatchOptions&) const;
template bool Scene<double>::Impl::on_surface(const Vec3<double>&, const scene::Sight&) const;
template Crossings Scene<double>::Impl::crossings(const Ray<double>&, const scene::Sight&,
                                                  scene::PassageCounter<double>&, Counts&) const;
template Crossings Scene<double>::crossings(const Ray<double>&, const QueryOptions&) const;
template void Scene<double>::crossings(std::span<const Ray<double>>, std::span<Crossings>,
                                       const BatchOptions&) const;

}  // namespace pierce
