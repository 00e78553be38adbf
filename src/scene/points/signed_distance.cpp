// SPDX-License-Identifier: Apache-2.0
//
// Signed distances: where the point lies, and how far the surface is.
#include <cstdint>
#include <vector>

#include "scene/points/point_source.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

constexpr std::size_t kDistancesPerTask = 256;

}  // namespace

template <class Real>
Real Scene<Real>::signed_distance(const Vec3<Real>& point, const LocateOptions& options) const {
  const FloatEnvironment environment;
  const Location location = locate(point, options);
  typename Impl::Counts counts;
  const scene::StopPoll stop(options.work.stop);
  const Real distance = impl_->nearest(point, kInfinity<Real>, stop, counts).distance;
  return environment.made(with_sign(distance, location));
}

template <class Real>
void Scene<Real>::signed_distances(const Rows<const Real>& rows, const Rows<Real>& distances,
                                   const LocateOptions& options) const {
  const FloatEnvironment environment;
  const scene::PointSource<Real> points(rows);
  scene::validate_outputs("point", points.size(), distances.count);
  const scene::OutputRows<Real> out(distances, points.size(), "point", "distances");
  std::vector<Location> locations(points.size());
  // Of the time, locating takes a small part.
  constexpr double kLocating = 0.1;
  LocateOptions locating = options;
  WorkOptions measuring{.threads = options.work.threads, .stop = options.work.stop};
  locating.work.progress = part_of(options.work.progress, 0, kLocating);
  measuring.progress = part_of(options.work.progress, kLocating, 1);
  locate(rows, Rows<std::int8_t>{reinterpret_cast<std::int8_t*>(locations.data()), points.size()},
         locating);
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    const scene::StopPoll stop(options.work.stop);
    for (std::size_t i = begin; i < end; ++i) {
      const Real distance = impl_->nearest(points[i], kInfinity<Real>, stop, counts).distance;
      out.set(i, with_sign(distance, locations[i]));
    }
    sum.add(counts);
  };
  scene::for_chunks(points.size(), measuring, kDistancesPerTask, chunk);
}

template <class Real>
void Scene<Real>::signed_distances(std::span<const Vec3<Real>> points, std::span<Real> distances,
                                   const LocateOptions& options) const {
  signed_distances(rows(points), rows(distances), options);
}

template float Scene<float>::signed_distance(const Vec3<float>&, const LocateOptions&) const;
template double Scene<double>::signed_distance(const Vec3<double>&, const LocateOptions&) const;
template void Scene<float>::signed_distances(const Rows<const float>&, const Rows<float>&,
                                             const LocateOptions&) const;
template void Scene<float>::signed_distances(std::span<const Vec3<float>>, std::span<float>,
                                             const LocateOptions&) const;
template void Scene<double>::signed_distances(const Rows<const double>&, const Rows<double>&,
                                              const LocateOptions&) const;
template void Scene<double>::signed_distances(std::span<const Vec3<double>>, std::span<double>,
                                              const LocateOptions&) const;

}  // namespace pierce
