// SPDX-License-Identifier: Apache-2.0
//
// The origin of the next ray: of the points proposed near the hit, the first that is exactly right.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bvh/point_traversal.h"
#include "predicate/hit_point.h"
#include "scene/rays/after.h"
#include "scene/rays/start_points.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/first_offender.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

using predicate::HitPoint;
using Vec = Vec3<double>;

// Where a line and a triangle meet.
struct Meeting {
  HitPoint point;
  bool at_border;  // of the triangle: an edge or a vertex
};

// That of a hit; nothing if they do not meet.
template <class Real>
std::optional<Meeting> meeting(const scene::Geometries<Real>& geometries, const Ray<Real>& ray,
                               const Hit<Real>& hit, Side side) {
  const predicate::RayD line = scene::line_of(ray);
  predicate::LadderCounts counts;
  scene::After found;
  if (!scene::find_hit(geometries, line, hit, found, counts)) return std::nullopt;
  return Meeting{{line, found.hit.triangle, side}, found.hit.zeros != 0};
}

template <class Real>
[[noreturn]] void refuse(const Hit<Real>& hit, const std::string& ray,
                         std::uint64_t index = Error::kNoIndex, std::uint64_t count = 1) {
  throw Error(ErrorCode::InvalidArgument,
              ray + " does not hit triangle " + std::to_string(hit.triangle) + " of geometry " +
                  std::to_string(hit.geometry) + "; give a hit that this scene found for it",
              index, count);
}

// To one side of its plane or the other; zero if to none.
Vec turned(const Vec& normal, int side) {
  const double sign = side;
  return {sign * normal.x, sign * normal.y, sign * normal.z};
}

// A box around the hit point, as it was rounded, and s.
struct Around {
  Vec lower, upper;

  Around(const Vec& x, const Vec& s) {
    // What rounding was off by, and more.
    const double off = scene::max_norm(x) * 0x1p-80 + std::numeric_limits<double>::denorm_min();
    const auto low = [off](double p, double q) {
      return std::min(p - 0x1p-51 * std::fabs(p) - off, q);
    };
    const auto high = [off](double p, double q) {
      return std::max(p + 0x1p-51 * std::fabs(p) + off, q);
    };
    lower = {low(x.x, s.x), low(x.y, s.y), low(x.z, s.z)};
    upper = {high(x.x, s.x), high(x.y, s.y), high(x.z, s.z)};
  }
};

// The first start that will do, next to a point at which the ray hits this triangle.
template <class Real, class Impl>
std::optional<Vec3<Real>> start_at(const Impl& impl, const Ray<Real>& ray, const Hit<Real>& hit,
                                   const Meeting& meeting, Side side, scene::StopPoll& stop) {
  const HitPoint& point = meeting.point;
  const scene::Geometries<Real>& geometries = impl.geometries;
  const Vec normal = turned(scene::about_normal(point.triangle), point.way_side);
  // Before its first hit, a ray's own origin can be reached from it.
  const auto last = side == Side::Before ? std::optional(ray.origin) : std::nullopt;
  const scene::StartPoints<Real> starts(point, normal, last);
  const space::FilterSpace& space = geometries.space();
  // The normal of what is in the way between s and the ray; triangle number `open` is not. Of
  // several the first by number: whichever the tree names first, the answer is the same.
  const auto obstacle_before = [&](const Vec& s, std::uint32_t open) -> std::optional<Vec> {
    std::uint32_t first = kNone;
    const Around box(starts.hit(), s);
    impl.traverse_box(space.map(box.lower), space.map(box.upper), [&](std::uint32_t number) {
      stop.sometimes();
      if (number < first && number != open &&
          !predicate::decide_open(point, s, geometries.triangle(number))) {
        first = number;
      }
      return false;
    });
    if (first == kNone) return std::nullopt;
    const predicate::TriangleD other = geometries.triangle(first);
    return turned(scene::about_normal(other), predicate::decide_way(point, other));
  };
  const auto strictly = [&](const Vec3<Real>& start) -> std::optional<Vec> {
    const Vec s = predicate::to_double(start);
    if (predicate::decide_side(s, point.triangle) != point.way_side) return normal;
    return obstacle_before(s, geometries.primitive({hit.geometry, hit.triangle}));
  };
  const auto start = starts.first_free(strictly);
  if (start || !meeting.at_border) return start;
  // At an edge or a vertex the region may be hardly on that side, and roomy all the same.
  return starts.first_free(
      [&](const Vec3<Real>& other) { return obstacle_before(predicate::to_double(other), kNone); });
}

}  // namespace

template <class Real>
std::optional<Vec3<Real>> Scene<Real>::next_origin(const Ray<Real>& ray, const Hit<Real>& hit,
                                                   Side side) const {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  const auto met = meeting(impl_->geometries, ray, hit, side);
  if (!met) refuse(hit, "the ray");
  scene::StopPoll never;
  return environment.made(start_at(*impl_, ray, hit, *met, side, never));
}

template <class Real>
void Scene<Real>::next_origins(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                               Side side, std::span<std::optional<Vec3<Real>>> origins,
                               const BatchOptions& options) const {
  const FloatEnvironment environment;
  const scene::Geometries<Real>& geometries = impl_->geometries;
  scene::validate_outputs("ray", rays.size(), origins.size());
  scene::validate_options(geometries, rays.size(), options);
  if (options.invalid == InvalidRays::Throw) {
    scene::validate_rays(scene::RaySource<Real>(rays), options.work.stop);
  }
  scene::validate_hits(rays.size(), hits.size());
  scene::FirstOffender bad;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    scene::StopPoll stop(options.work.stop);
    for (std::size_t i = begin; i < end; ++i) {
      stop.now();
      origins[i].reset();
      if (hits[i].triangle == kNone || !scene::is_valid(rays[i])) continue;
      if (const auto met = meeting(geometries, rays[i], hits[i], side)) {
        origins[i] = start_at(*impl_, rays[i], hits[i], *met, side, stop);
      } else {
        bad.note(i);
      }
    }
  };
  constexpr std::size_t kRaysPerTask = 64;  // each takes some microseconds
  scene::for_chunks(rays.size(), options.work, kRaysPerTask, chunk);
  if (bad.count() == 0) return;
  refuse(hits[bad.first()], "ray " + std::to_string(bad.first()) + scene::counted(bad.count()),
         bad.first(), bad.count());
}

template std::optional<Vec3<float>> Scene<float>::next_origin(const Ray<float>&, const Hit<float>&,
                                                              Side) const;
template std::optional<Vec3<double>> Scene<double>::next_origin(const Ray<double>&,
                                                                const Hit<double>&, Side) const;
template void Scene<float>::next_origins(std::span<const Ray<float>>, std::span<const Hit<float>>,
                                         Side, std::span<std::optional<Vec3<float>>>,
                                         const BatchOptions&) const;
template void Scene<double>::next_origins(std::span<const Ray<double>>,
                                          std::span<const Hit<double>>, Side,
                                          std::span<std::optional<Vec3<double>>>,
                                          const BatchOptions&) const;

}  // namespace pierce
