// SPDX-License-Identifier: Apache-2.0
#include "scene/validate_input.h"

#include <cmath>
#include <string>
#include <string_view>

#include "scene/geometries.h"
#include "scene/points/point_source.h"
#include "scene/rays/after.h"
#include "scene/rays/ray_source.h"
#include "support/stop_poll.h"

namespace pierce::scene {
namespace {

template <class Real>
bool is_zero(const Vec3<Real>& p) {
  return p.x == 0 && p.y == 0 && p.z == 0;
}

// What is wrong with a ray that is not valid, and what to do.
template <class Real>
std::string_view complaint(const Ray<Real>& ray) {
  if (!is_finite(ray.origin)) return "its origin is not finite; give finite coordinates";
  if (!is_finite(ray.direction)) return "its direction is not finite; give finite components";
  if (is_zero(ray.direction)) return "its direction is zero; give it a component that is not";
  return "an end of its t range is NaN; use -inf or inf for no limit";
}

// Those of a list that are bad.
struct Offenders {
  std::size_t first = 0;
  std::size_t count = 0;
};

template <class Items, class IsGood>
Offenders offenders_of(const Items& items, const std::atomic<bool>* stop, const IsGood& is_good) {
  Offenders bad;
  const StopPoll poll(stop);
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i % 65536 == 0) poll.now();
    if (is_good(items[i])) [[likely]]
      continue;
    if (bad.count++ == 0) bad.first = i;
  }
  return bad;
}

}  // namespace

std::string counted(std::size_t count) {
  return count == 1 ? " (the only one)" : " (the first of " + std::to_string(count) + ")";
}

template <class Real>
void refuse(const Ray<Real>& ray) {
  throw Error(ErrorCode::InvalidRay, "bad ray: " + std::string(complaint(ray)));
}

template <class Real>
void validate_rays(const RaySource<Real>& rays, const std::atomic<bool>* stop) {
  const auto [first, bad] =
      offenders_of(rays, stop, [](const Ray<Real>& r) { return is_valid(r); });
  if (bad == 0) return;
  throw Error(ErrorCode::InvalidRay,
              "bad ray " + std::to_string(first) + counted(bad) + ": " +
                  std::string(complaint(rays[first])),
              first, bad);
}

namespace {

template <class Real>
bool is_valid_skip(const Geometries<Real>& geometries, const TriangleRef& skip) {
  return skip.triangle == kNone || geometries.primitive(skip) != kNone;
}

std::string complaint(const TriangleRef& skip) {
  return ": there is no triangle " + std::to_string(skip.triangle) + " of geometry " +
         std::to_string(skip.geometry) + "; name one of the scene, or none";
}

}  // namespace

void validate_outputs(const std::string& asked, std::size_t count, std::size_t outputs) {
  if (outputs == count) return;
  throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(count) + " " + asked +
                                           "s but room for " + std::to_string(outputs) +
                                           " results; make the spans equally long");
}

void validate_hits(std::size_t rays, std::size_t hits) {
  if (hits == rays) return;
  throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(rays) + " rays but " +
                                           std::to_string(hits) + " hits; give one a ray");
}

void validate_one_each(const std::string& asked, std::size_t count, std::size_t given,
                       const std::string& of) {
  if (given == 0 || given == count) return;
  throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(count) + " " + asked +
                                           "s but " + std::to_string(given) + " " + of +
                                           "; give none, or one a " + asked);
}

template <class Real>
void validate_skip(const Geometries<Real>& geometries, const TriangleRef& skip) {
  if (is_valid_skip(geometries, skip)) [[likely]]
    return;
  throw Error(ErrorCode::InvalidArgument, "bad triangle to skip" + complaint(skip));
}

template <class Real>
void validate_options(const Geometries<Real>& geometries, std::size_t rays,
                      const BatchOptions& options) {
  validate_one_each("ray", rays, options.skip.size(), "triangles to skip");
  validate_one_each("ray", rays, options.masks.size(), "masks");
  validate_one_each("ray", rays, options.after.size(), "triangles to go on after");
  const auto [first, bad] =
      offenders_of(options.skip, options.work.stop,
                   [&](const TriangleRef& skip) { return is_valid_skip(geometries, skip); });
  if (bad == 0) return;
  throw Error(ErrorCode::InvalidArgument,
              "bad triangle to skip, of ray " + std::to_string(first) + counted(bad) +
                  complaint(options.skip[first]),
              first, bad);
}

template <class Real>
void validate_batch(const Geometries<Real>& geometries, const RaySource<Real>& rays,
                    const BatchOptions& options) {
  validate_options(geometries, rays.size(), options);
  if (options.invalid == InvalidRays::Throw) validate_rays(rays, options.work.stop);
  validate_after(geometries, rays, options);
}

template <class Options>
void validate_passages(const Options& options) {
  const char* given = goes_step_by_step(options) ? (options.filter ? "filter" : "after") : nullptr;
  if (options.distinct) given = "distinct";
  if (given == nullptr) return;
  throw Error(ErrorCode::InvalidArgument,
              std::string("crossings are asked with ") + given +
                  ", which is about hits; ask all_hits or count_hits, or leave it out");
}

template <class Real>
void validate_point(const Vec3<Real>& point) {
  if (is_finite(point)) [[likely]]
    return;
  throw Error(ErrorCode::InvalidPoint, "bad point: it is not finite; give finite coordinates");
}

template <class Real>
void validate_points(const PointSource<Real>& points, const std::atomic<bool>* stop) {
  const auto [first, bad] =
      offenders_of(points, stop, [](const Vec3<Real>& p) { return is_finite(p); });
  if (bad == 0) return;
  throw Error(ErrorCode::InvalidPoint,
              "bad point " + std::to_string(first) + counted(bad) +
                  ": it is not finite; give finite coordinates",
              first, bad);
}

template <class Real>
bool is_valid(const MeshView<Real>& mesh, const Triangle& t) {
  const std::size_t count = mesh.vertices.size();
  return t[0] < count && t[1] < count && t[2] < count && is_finite(mesh.vertices[t[0]]) &&
         is_finite(mesh.vertices[t[1]]) && is_finite(mesh.vertices[t[2]]);
}

template <class Real>
void validate_mesh(const MeshView<Real>& mesh, std::size_t geometry, std::size_t geometries) {
  std::size_t out_of_range = 0;
  std::size_t first_out_of_range = 0;
  std::size_t not_finite = 0;
  std::size_t first_not_finite = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (is_valid(mesh, t)) continue;
    const std::size_t count = mesh.vertices.size();
    if (t[0] >= count || t[1] >= count || t[2] >= count) {
      if (out_of_range++ == 0) first_out_of_range = i;
    } else {
      if (not_finite++ == 0) first_not_finite = i;
    }
  }
  const std::string where = geometries > 1 ? " of geometry " + std::to_string(geometry) : "";
  if (out_of_range != 0) {
    const Triangle& t = mesh.triangles[first_out_of_range];
    std::size_t corner = 0;
    while (t[corner] < mesh.vertices.size()) ++corner;
    throw Error(ErrorCode::IndexOutOfRange,
                "triangle " + std::to_string(first_out_of_range) + where + counted(out_of_range) +
                    ": names vertex " + std::to_string(t[corner]) + ", but there are only " +
                    std::to_string(mesh.vertices.size()) + "; correct the index",
                first_out_of_range, out_of_range);
  }
  if (not_finite != 0) {
    const Triangle& t = mesh.triangles[first_not_finite];
    std::size_t corner = 0;
    while (is_finite(mesh.vertices[t[corner]])) ++corner;
    throw Error(ErrorCode::NonFiniteVertex,
                "triangle " + std::to_string(first_not_finite) + where + counted(not_finite) +
                    ": its vertex " + std::to_string(t[corner]) +
                    " is not finite; remove the triangle or correct the vertex",
                first_not_finite, not_finite);
  }
}

template <class Real>
void validate_corner(const Vec3<Real>& corner, char name) {
  if (is_finite(corner)) [[likely]]
    return;
  throw Error(ErrorCode::NonFiniteVertex,
              std::string("corner ") + name + " is not finite; give finite coordinates");
}

template void refuse(const Ray<float>&);
template void refuse(const Ray<double>&);
template void validate_rays(const RaySource<float>&, const std::atomic<bool>*);
template void validate_rays(const RaySource<double>&, const std::atomic<bool>*);
template void validate_skip(const Geometries<float>&, const TriangleRef&);
template void validate_skip(const Geometries<double>&, const TriangleRef&);
template void validate_options(const Geometries<float>&, std::size_t, const BatchOptions&);
template void validate_options(const Geometries<double>&, std::size_t, const BatchOptions&);
template void validate_batch(const Geometries<float>&, const RaySource<float>&,
                             const BatchOptions&);
template void validate_batch(const Geometries<double>&, const RaySource<double>&,
                             const BatchOptions&);
template void validate_passages(const QueryOptions&);
template void validate_passages(const BatchOptions&);
template void validate_point(const Vec3<float>&);
template void validate_point(const Vec3<double>&);
template void validate_points(const PointSource<float>&, const std::atomic<bool>*);
template void validate_points(const PointSource<double>&, const std::atomic<bool>*);
template bool is_valid(const MeshView<float>&, const Triangle&);
template bool is_valid(const MeshView<double>&, const Triangle&);
template void validate_mesh(const MeshView<float>&, std::size_t, std::size_t);
template void validate_mesh(const MeshView<double>&, std::size_t, std::size_t);
template void validate_corner(const Vec3<float>&, char);
template void validate_corner(const Vec3<double>&, char);

}  // namespace pierce::scene
