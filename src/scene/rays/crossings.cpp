// SPDX-License-Identifier: Apache-2.0
//
// How often rays pass through the surface, and where points lie: the queries that count passages.
#include <algorithm>

#include "bvh/point_traversal.h"
#include "scene/rays/one_by_one.h"
#include "scene/rays/passage_counter.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

class CrossingsWriter {
 public:
  CrossingsWriter(const CrossingsArrays& arrays, std::size_t rays)
      : crossings_(arrays.crossings.data()),
        count_(arrays.count, rays, "ray", "count"),
        signed_count_(arrays.signed_count, rays, "ray", "signed_count"),
        on_surface_(arrays.origin_on_surface, rays, "ray", "origin_on_surface") {
    if (!arrays.crossings.empty()) {
      scene::validate_outputs("ray", rays, arrays.crossings.size());
    }
  }

  void operator()(std::size_t first, std::span<const Crossings> results) const {
    if (crossings_ != nullptr) std::copy(results.begin(), results.end(), crossings_ + first);
    count_.write(first, results, [](const Crossings& c) { return c.count; });
    signed_count_.write(first, results, [](const Crossings& c) { return c.signed_count; });
    on_surface_.write(first, results, [](const Crossings& c) {
      return static_cast<std::uint8_t>(c.origin_on_surface ? 1 : 0);
    });
  }

 private:
  Crossings* crossings_;
  scene::OutputRows<std::uint32_t> count_;
  scene::OutputRows<std::int32_t> signed_count_;
  scene::OutputRows<std::uint8_t> on_surface_;
};

}  // namespace

template <class Real>
bool Scene<Real>::Impl::on_surface(const Vec3<double>& point, const scene::Sight& sight) const {
  const Vec3<double> p = geometries.space().map(point);
  return traverse_box(p, p, [&](std::uint32_t primitive) {
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
  scene::validate_passages(options);
  if (!scene::is_valid_or_throw(ray, options.invalid)) return {};
  typename Impl::Counts counts;
  scene::PassageCounter<Real> counter(impl_->geometries, {}, counts.ladder);
  return impl_->crossings(ray, scene::sight_of(impl_->geometries, options), counter, counts);
}

template <class Real>
void Scene<Real>::crossings(const RayArrays<Real>& rays, const CrossingsArrays& results,
                            const BatchOptions& options) const {
  const FloatEnvironment environment;
  scene::validate_passages(options);
  const scene::RaySource<Real> source(rays);
  const CrossingsWriter writer(results, source.size());
  scene::answer_one_by_one<scene::PassageCounter<Real>, Crossings>(
      *impl_, source, options,
      [this](const Ray<Real>& ray, const scene::Sight& sight, auto& counter, auto& counts) {
        return impl_->crossings(ray, sight, counter, counts);
      },
      writer);
}

template <class Real>
void Scene<Real>::crossings(std::span<const Ray<Real>> rays, std::span<Crossings> results,
                            const BatchOptions& options) const {
  scene::validate_outputs("ray", rays.size(), results.size());
  crossings(RayArrays<Real>::of(rays), CrossingsArrays{.crossings = results}, options);
}

template bool Scene<float>::Impl::on_surface(const Vec3<double>&, const scene::Sight&) const;
template Crossings Scene<float>::Impl::crossings(const Ray<float>&, const scene::Sight&,
                                                 scene::PassageCounter<float>&, Counts&) const;
template Crossings Scene<float>::crossings(const Ray<float>&, const QueryOptions&) const;
template void Scene<float>::crossings(const RayArrays<float>&, const CrossingsArrays&,
                                      const BatchOptions&) const;
template void Scene<float>::crossings(std::span<const Ray<float>>, std::span<Crossings>,
                                      const BatchOptions&) const;
template bool Scene<double>::Impl::on_surface(const Vec3<double>&, const scene::Sight&) const;
template Crossings Scene<double>::Impl::crossings(const Ray<double>&, const scene::Sight&,
                                                  scene::PassageCounter<double>&, Counts&) const;
template Crossings Scene<double>::crossings(const Ray<double>&, const QueryOptions&) const;
template void Scene<double>::crossings(const RayArrays<double>&, const CrossingsArrays&,
                                       const BatchOptions&) const;
template void Scene<double>::crossings(std::span<const Ray<double>>, std::span<Crossings>,
                                       const BatchOptions&) const;

}  // namespace pierce
