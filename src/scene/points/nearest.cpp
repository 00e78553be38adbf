// SPDX-License-Identifier: Apache-2.0
//
// The nearest point of the surface.
#include "kernels/points/nearest.h"

#include <algorithm>
#include <array>
#include <string>

#include "predicate/nearest.h"
#include "scene/points/nearest_resolver.h"
#include "scene/points/nearest_writer.h"
#include "scene/points/point_source.h"
#include "scene/points/two_level_nearest.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/finite.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

/// Points a task: as for rays, but each takes several times as long.
constexpr std::size_t kNearestPerTask = 256;

template <class Real>
void validate_radius(Real radius, const std::string& of, std::uint64_t index = Error::kNoIndex,
                     std::uint64_t count = 1) {
  if (radius >= 0) return;
  throw Error(ErrorCode::InvalidArgument,
              of + (is_nan(radius) ? " is not a number" : " is negative") +
                  "; give 0 or more, or infinity for no limit",
              index, count);
}

template <class Real>
void validate(const scene::PointSource<Real>& points, const NearestOptions<Real>& options) {
  scene::validate_one_each("point", points.size(), options.radii.size(), "radii");
  scene::validate_points(points, options.work.stop);
  validate_radius(options.radius, "the radius");
  for (std::size_t i = 0; i < options.radii.size(); ++i) {
    if (options.radii[i] >= 0) [[likely]]
      continue;
    const auto bad =
        std::count_if(options.radii.begin(), options.radii.end(), [](Real r) { return !(r >= 0); });
    validate_radius(options.radii[i], "the radius of point " + std::to_string(i), i,
                    static_cast<std::uint64_t>(bad));
  }
}

}  // namespace

template <class Real>
NearestPoint<Real> Scene<Real>::Impl::nearest(const Vec3<Real>& point, Real radius,
                                              const scene::StopPoll& stop, Counts& counts) const {
  stop.now();
  const Vec3<double> p = predicate::to_double(point);
  ++counts.rays;
  const kernels::FilterPoint filter{geometries.space().map(p), geometries.space().direction_of(p),
                                    geometries.space().map_length(static_cast<double>(radius))};
  scene::NearestResolver<Real> resolver(geometries, p, counts.ladder, stop);
  const kernels::Candidate winner =
      !geometries.shares_meshes()
          ? kernel->nearest(tree, filter, resolver, counts.kernel_counts())
          : scene::TwoLevelNearest<Real>(*two_level, geometries.space(), filter, resolver,
                                         counts.kernel_counts())
                .run();
  if (winner.primitive == kNone) return {};
  const predicate::NearTriangle& near = resolver.near(winner);
  if (!predicate::decide_within(p, near, static_cast<double>(radius), counts.ladder)) return {};
  NearestPoint<Real> result = predicate::round_nearest<Real>(p, near, counts.ladder);
  const TriangleRef ref = geometries.ref(winner.primitive);
  result.geometry = ref.geometry;
  result.triangle = ref.triangle;
  ++counts.hits;
  return result;
}

template <class Real>
std::optional<NearestPoint<Real>> Scene<Real>::nearest_point(const Vec3<Real>& point,
                                                             Real radius) const {
  const FloatEnvironment environment;
  scene::validate_point(point);
  validate_radius(radius, "the radius");
  typename Impl::Counts counts;
  const auto nearest = environment.made(impl_->nearest(point, radius, {}, counts));
  if (nearest.triangle == kNone) return std::nullopt;
  return nearest;
}

template <class Real>
void Scene<Real>::nearest_points(const Rows<const Real>& rows, const NearestArrays<Real>& nearest,
                                 const NearestOptions<Real>& options) const {
  const FloatEnvironment environment;
  const scene::PointSource<Real> points(rows);
  const scene::NearestWriter<Real> writer(nearest, points.size());
  validate(points, options);
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    const scene::StopPoll stop(options.work.stop);
    std::array<NearestPoint<Real>, kNearestPerTask> results;
    for (std::size_t i = begin; i < end; ++i) {
      const Real radius = options.radii.empty() ? options.radius : options.radii[i];
      results[i - begin] = impl_->nearest(points[i], radius, stop, counts);
    }
    writer(begin, std::span<const NearestPoint<Real>>(results).first(end - begin));
    sum.add(counts);
  };
  scene::for_chunks(points.size(), options.work, kNearestPerTask, chunk);
}

template <class Real>
void Scene<Real>::nearest_points(std::span<const Vec3<Real>> points,
                                 std::span<NearestPoint<Real>> nearest,
                                 const NearestOptions<Real>& options) const {
  scene::validate_outputs("point", points.size(), nearest.size());
  nearest_points(rows(points), NearestArrays<Real>{.nearest = nearest}, options);
}

template NearestPoint<float> Scene<float>::Impl::nearest(const Vec3<float>&, float,
                                                         const scene::StopPoll&, Counts&) const;
template NearestPoint<double> Scene<double>::Impl::nearest(const Vec3<double>&, double,
                                                           const scene::StopPoll&, Counts&) const;
template std::optional<NearestPoint<float>> Scene<float>::nearest_point(const Vec3<float>&,
                                                                        float) const;
template std::optional<NearestPoint<double>> Scene<double>::nearest_point(const Vec3<double>&,
                                                                          double) const;
template void Scene<float>::nearest_points(const Rows<const float>&, const NearestArrays<float>&,
                                           const NearestOptions<float>&) const;
template void Scene<float>::nearest_points(std::span<const Vec3<float>>,
                                           std::span<NearestPoint<float>>,
                                           const NearestOptions<float>&) const;
template void Scene<double>::nearest_points(const Rows<const double>&, const NearestArrays<double>&,
                                            const NearestOptions<double>&) const;
template void Scene<double>::nearest_points(std::span<const Vec3<double>>,
                                            std::span<NearestPoint<double>>,
                                            const NearestOptions<double>&) const;

}  // namespace pierce
