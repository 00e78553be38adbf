// SPDX-License-Identifier: Apache-2.0
//
// Hit points and normals, and which of two hits comes first.
#include <string>

#include "predicate/place.h"
#include "scene/rays/after.h"
#include "scene/rays/place_columns.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/first_offender.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

std::string name(const TriangleRef& ref) {
  return "triangle " + std::to_string(ref.triangle) + " of geometry " +
         std::to_string(ref.geometry);
}

[[noreturn]] void refuse_hit(const TriangleRef& ref, const std::string& ray,
                             std::uint64_t index = Error::kNoIndex, std::uint64_t count = 1) {
  throw Error(ErrorCode::InvalidArgument,
              ray + " does not hit " + name(ref) + "; give a hit that this scene found for it",
              index, count);
}

[[noreturn]] void refuse_triangle(const TriangleRef& ref, const std::string& of,
                                  std::uint64_t index = Error::kNoIndex, std::uint64_t count = 1) {
  throw Error(ErrorCode::InvalidArgument,
              "bad triangle" + of + ": there is no " + name(ref) + "; name one of the scene", index,
              count);
}

template <class Real>
scene::After hit_of(const scene::Geometries<Real>& geometries, const Ray<Real>& ray,
                    const TriangleRef& ref) {
  scene::After hit;
  predicate::LadderCounts counts;
  if (!scene::find_hit(geometries, scene::line_of(ray), ref, hit, counts)) {
    refuse_hit(ref, "the ray's line");
  }
  return hit;
}

template <class Real>
predicate::TriangleD triangle_of(const scene::Geometries<Real>& geometries,
                                 const TriangleRef& ref) {
  const std::uint32_t primitive = geometries.primitive(ref);
  if (primitive == kNone) refuse_triangle(ref, "");
  return geometries.triangle(primitive);
}

// `round(triangle)` of each triangle that is named.
template <class Real, class Named, class Round>
void for_triangles(const scene::Geometries<Real>& geometries, std::span<const Named> named,
                   std::span<Vec3<Real>> normals, const WorkOptions& work, const Round& round) {
  scene::validate_outputs("triangle", named.size(), normals.size());
  scene::FirstOffender bad;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    scene::StopPoll stop(work.stop);
    for (std::size_t i = begin; i < end; ++i) {
      stop.sometimes();
      normals[i] = scene::kNowhere<Real>;
      const TriangleRef ref = named[i];
      if (ref.triangle == kNone) continue;
      const std::uint32_t primitive = geometries.primitive(ref);
      if (primitive == kNone) {
        bad.note(i);
      } else {
        normals[i] = round(geometries.triangle(primitive));
      }
    }
  };
  scene::for_chunks(named.size(), work, scene::kRaysPerTask, chunk);
  if (bad.count() == 0) return;
  refuse_triangle(named[bad.first()],
                  ' ' + std::to_string(bad.first()) + scene::counted(bad.count()), bad.first(),
                  bad.count());
}

}  // namespace

template <class Real>
Vec3<Real> Scene<Real>::hit_point(const Ray<Real>& ray, const TriangleRef& hit) const {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  const scene::After found = hit_of(impl_->geometries, ray, hit);
  return environment.made(predicate::round_point<Real>(scene::line_of(ray), found.hit.triangle));
}

template <class Real>
void Scene<Real>::hit_points(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                             std::span<Vec3<Real>> points, const WorkOptions& work) const {
  const FloatEnvironment environment;
  scene::validate_outputs("ray", rays.size(), points.size());
  scene::validate_hits(rays.size(), hits.size());
  const scene::Geometries<Real>& geometries = impl_->geometries;
  scene::FirstOffender bad;
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    scene::StopPoll stop(work.stop);
    predicate::LadderCounts counts;
    for (std::size_t i = begin; i < end; ++i) {
      stop.sometimes();
      points[i] = scene::kNowhere<Real>;
      if (hits[i].triangle == kNone) continue;
      scene::After found;
      if (scene::is_valid(rays[i]) &&
          scene::find_hit(geometries, scene::line_of(rays[i]), hits[i], found, counts)) {
        points[i] = predicate::round_point<Real>(scene::line_of(rays[i]), found.hit.triangle);
      } else {
        bad.note(i);
      }
    }
  };
  scene::for_chunks(rays.size(), work, scene::kRaysPerTask, chunk);
  if (bad.count() == 0) return;
  refuse_hit(hits[bad.first()], "ray " + std::to_string(bad.first()) + scene::counted(bad.count()),
             bad.first(), bad.count());
}

template <class Real>
Vec3<Real> Scene<Real>::normal(const TriangleRef& triangle) const {
  const FloatEnvironment environment;
  return environment.made(predicate::round_normal<Real>(triangle_of(impl_->geometries, triangle)));
}

template <class Real>
Vec3<Real> Scene<Real>::unit_normal(const TriangleRef& triangle) const {
  const FloatEnvironment environment;
  return environment.made(
      predicate::round_unit_normal<Real>(triangle_of(impl_->geometries, triangle)));
}

template <class Real>
void Scene<Real>::normals(std::span<const TriangleRef> triangles, std::span<Vec3<Real>> normals,
                          const WorkOptions& work) const {
  const FloatEnvironment environment;
  for_triangles(impl_->geometries, triangles, normals, work, predicate::round_normal<Real>);
}

template <class Real>
void Scene<Real>::normals(std::span<const Hit<Real>> hits, std::span<Vec3<Real>> normals,
                          const WorkOptions& work) const {
  const FloatEnvironment environment;
  for_triangles(impl_->geometries, hits, normals, work, predicate::round_normal<Real>);
}

template <class Real>
void Scene<Real>::unit_normals(std::span<const TriangleRef> triangles,
                               std::span<Vec3<Real>> normals, const WorkOptions& work) const {
  const FloatEnvironment environment;
  for_triangles(impl_->geometries, triangles, normals, work, predicate::round_unit_normal<Real>);
}

template <class Real>
void Scene<Real>::unit_normals(std::span<const Hit<Real>> hits, std::span<Vec3<Real>> normals,
                               const WorkOptions& work) const {
  const FloatEnvironment environment;
  for_triangles(impl_->geometries, hits, normals, work, predicate::round_unit_normal<Real>);
}

template <class Real>
std::strong_ordering Scene<Real>::compare_hits(const Ray<Real>& ray, const TriangleRef& first,
                                               const TriangleRef& second) const {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  const scene::After p = hit_of(impl_->geometries, ray, first);
  const scene::After q = hit_of(impl_->geometries, ray, second);
  predicate::LadderCounts counts;
  const auto order = predicate::decide_order(scene::line_of(ray), p.hit, q.hit, counts);
  return order != 0 ? order : p.primitive <=> q.primitive;
}

template Vec3<float> Scene<float>::hit_point(const Ray<float>&, const TriangleRef&) const;
template void Scene<float>::hit_points(std::span<const Ray<float>>, std::span<const Hit<float>>,
                                       std::span<Vec3<float>>, const WorkOptions&) const;
template Vec3<float> Scene<float>::normal(const TriangleRef&) const;
template Vec3<float> Scene<float>::unit_normal(const TriangleRef&) const;
template void Scene<float>::normals(std::span<const TriangleRef>, std::span<Vec3<float>>,
                                    const WorkOptions&) const;
template void Scene<float>::normals(std::span<const Hit<float>>, std::span<Vec3<float>>,
                                    const WorkOptions&) const;
template void Scene<float>::unit_normals(std::span<const TriangleRef>, std::span<Vec3<float>>,
                                         const WorkOptions&) const;
template void Scene<float>::unit_normals(std::span<const Hit<float>>, std::span<Vec3<float>>,
                                         const WorkOptions&) const;
template std::strong_ordering Scene<float>::compare_hits(const Ray<float>&, const TriangleRef&,
                                                         const TriangleRef&) const;
template Vec3<double> Scene<double>::hit_point(const Ray<double>&, const TriangleRef&) const;
template void Scene<double>::hit_points(std::span<const Ray<double>>, std::span<const Hit<double>>,
                                        std::span<Vec3<double>>, const WorkOptions&) const;
template Vec3<double> Scene<double>::normal(const TriangleRef&) const;
template Vec3<double> Scene<double>::unit_normal(const TriangleRef&) const;
template void Scene<double>::normals(std::span<const TriangleRef>, std::span<Vec3<double>>,
                                     const WorkOptions&) const;
template void Scene<double>::normals(std::span<const Hit<double>>, std::span<Vec3<double>>,
                                     const WorkOptions&) const;
template void Scene<double>::unit_normals(std::span<const TriangleRef>, std::span<Vec3<double>>,
                                          const WorkOptions&) const;
template void Scene<double>::unit_normals(std::span<const Hit<double>>, std::span<Vec3<double>>,
                                          const WorkOptions&) const;
template std::strong_ordering Scene<double>::compare_hits(const Ray<double>&, const TriangleRef&,
                                                          const TriangleRef&) const;

}  // namespace pierce
