// SPDX-License-Identifier: Apache-2.0
//
// How often rays pass through the surface, and where points lie: the queries that count passages.
#include "bvh/point_walk.h"
#include "scene/for_chunks.h"
#include "scene/passage_counter.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"

namespace pierce {

template <class Real>
bool Scene<Real>::Impl::on_surface(const Vec3<double>& point, std::uint32_t skip) const {
  const Vec3<double> p = geometries.space().map(point);
  return bvh::walk_point(tree, p, [&](std::uint32_t primitive) {
    return primitive != skip &&
           predicate::decide_on_triangle(point, geometries.triangle(primitive));
  });
}

template <class Real>
Crossings Scene<Real>::Impl::crossings(const Ray<Real>& ray, std::uint32_t skip,
                                       scene::PassageCounter<Real>& counter, Counts& counts) const {
  Crossings result;
  result.origin_on_surface = on_surface(predicate::to_double(ray.origin), skip);
  scene::Road<Real> road(*kernel, geometries, ray, Range::Closed);
  ++counts.rays;
  counts.placed_exactly += road.exactly() ? 1 : 0;
  if (road.misses()) return result;
  counter.start(road.ray());
  kernel->all(tree, road.filter_ray(), skip, counter, counts.kernel_counts());
  counter.count(result);
  counts.hits += result.count;
  return result;
}

template <class Real>
Crossings Scene<Real>::crossings(const Ray<Real>& ray) const {
  scene::validate_ray(ray);
  typename Impl::Counts counts;
  scene::PassageCounter<Real> counter(impl_->geometries, counts.ladder);
  return impl_->crossings(ray, kNone, counter, counts);
}

template <class Real>
void Scene<Real>::crossings(std::span<const Ray<Real>> rays, std::span<Crossings> results,
                            const BatchOptions& options) const {
  scene::validate_sizes(rays.size(), results.size(), options);
  scene::validate_rays(rays);
  scene::CountSum<typename Impl::Counts> sum(options.statistics);
  scene::for_chunks(rays.size(), options, scene::kRaysPerTask,
                    [&](std::size_t begin, std::size_t end) {
                      auto counts = sum.start();
                      scene::PassageCounter<Real> counter(impl_->geometries, counts.ladder);
                      for (std::size_t i = begin; i < end; ++i) {
                        const std::uint32_t skip = scene::skip_of(impl_->geometries, options, i);
                        results[i] = impl_->crossings(rays[i], skip, counter, counts);
                      }
                      sum.add(counts);
                    });
}

template bool Scene<float>::Impl::on_surface(const Vec3<double>&, std::uint32_t) const;
template bool Scene<double>::Impl::on_surface(const Vec3<double>&, std::uint32_t) const;
template Crossings Scene<float>::Impl::crossings(const Ray<float>&, std::uint32_t,
                                                 scene::PassageCounter<float>&, Counts&) const;
template Crossings Scene<double>::Impl::crossings(const Ray<double>&, std::uint32_t,
                                                  scene::PassageCounter<double>&, Counts&) const;
template Crossings Scene<float>::crossings(const Ray<float>&) const;
template Crossings Scene<double>::crossings(const Ray<double>&) const;
template void Scene<float>::crossings(std::span<const Ray<float>>, std::span<Crossings>,
                                      const BatchOptions&) const;
template void Scene<double>::crossings(std::span<const Ray<double>>, std::span<Crossings>,
                                       const BatchOptions&) const;

}  // namespace pierce
