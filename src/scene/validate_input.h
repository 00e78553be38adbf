// SPDX-License-Identifier: Apache-2.0
//
// The door of the library: what comes in is checked here, once, with an error that names the first
// offender, how many there are, and the cure.
#pragma once

#include <atomic>
#include <cstddef>
#include <span>
#include <string>

#include "pierce/error.h"
#include "pierce/options.h"
#include "pierce/types.h"

namespace pierce::scene {

template <class Real>
[[nodiscard]] bool is_finite(const Vec3<Real>& p) {
  // x - x is 0 for finite x and NaN otherwise; one test for all three.
  return (p.x - p.x) + (p.y - p.y) + (p.z - p.z) == 0;
}

template <class Real>
class Geometries;
template <class Real>
class RaySource;
template <class Real>
class PointSource;

/// What follows the name of the first offender: " (the only one)" or " (the first of 7)".
[[nodiscard]] std::string counted(std::size_t count);

/// Throws Error (SizeMismatch) unless there is room for a result each. `asked`: a "ray", a "point".
void validate_outputs(const std::string& asked, std::size_t count, std::size_t outputs);

/// Throws Error (SizeMismatch) unless there is a hit a ray.
void validate_hits(std::size_t rays, std::size_t hits);

/// Throws Error (SizeMismatch) unless of an option ("masks", say) none are given, or one each.
void validate_one_each(const std::string& asked, std::size_t count, std::size_t given,
                       const std::string& of);

/// Without a branch: a single ray waits for it.
template <class Real>
[[nodiscard]] bool is_valid(const Ray<Real>& ray) {
  const Vec3<Real>& d = ray.direction;
  const int directed = int{d.x != 0} | int{d.y != 0} | int{d.z != 0};
  const int ranged = int{ray.t_min == ray.t_min} & int{ray.t_max == ray.t_max};  // no NaN
  return (int{is_finite(ray.origin)} & int{is_finite(d)} & directed & ranged) != 0;
}

/// Throws Error (InvalidRay) that says what is wrong with the ray.
template <class Real>
[[noreturn]] void refuse(const Ray<Real>& ray);

/// Throws Error (InvalidRay) unless the ray is valid.
template <class Real>
void validate_ray(const Ray<Real>& ray) {
  if (!is_valid(ray)) [[unlikely]]
    refuse(ray);
}

/// Whether the ray is valid; if not, throws Error (InvalidRay) unless it is to count as a miss.
template <class Real>
[[nodiscard]] bool is_valid_or_throw(const Ray<Real>& ray, InvalidRays invalid) {
  if (is_valid(ray)) [[likely]]
    return true;
  if (invalid == InvalidRays::Throw) refuse(ray);
  return false;
}

/// Whether the ray is not valid and is to count as a miss. (Else who transforms it validates it.)
template <class Real>
[[nodiscard]] bool is_bad_miss(const Ray<Real>& ray, const QueryOptions& options) {
  return options.invalid == InvalidRays::Miss && !is_valid(ray);
}

/// Throws Error (InvalidRay) that names the first bad ray and counts them all.
template <class Real>
void validate_rays(const RaySource<Real>& rays, const std::atomic<bool>* stop);

/// Throws Error (InvalidArgument) unless the triangle to skip exists or is none.
template <class Real>
void validate_skip(const Geometries<Real>& geometries, const TriangleRef& skip);

/// Throws Error (SizeMismatch, InvalidArgument) about the options that come one a ray; names the
/// first offender and counts them.
template <class Real>
void validate_options(const Geometries<Real>& geometries, std::size_t rays,
                      const BatchOptions& options);

/// The same, and the rays themselves (InvalidRay), unless bad ones count as misses, and what they
/// are to go on after.
template <class Real>
void validate_batch(const Geometries<Real>& geometries, const RaySource<Real>& rays,
                    const BatchOptions& options);

/// Throws Error (InvalidArgument) if the options ask for hits of some kind: passages have none.
template <class Options>
void validate_passages(const Options& options);

/// Throws Error (InvalidPoint) unless the query point is finite.
template <class Real>
void validate_point(const Vec3<Real>& point);

/// Throws Error (InvalidPoint) that names the first bad point and counts them all.
template <class Real>
void validate_points(const PointSource<Real>& points, const std::atomic<bool>* stop);

/// Whether the triangle's vertices exist and are finite.
template <class Real>
[[nodiscard]] bool is_valid(const MeshView<Real>& mesh, const Triangle& triangle);

/// Throws Error (IndexOutOfRange, NonFiniteVertex) about the triangles of one mesh. Only vertices
/// that some triangle uses need be finite.
template <class Real>
void validate_mesh(const MeshView<Real>& mesh, std::size_t geometry, std::size_t geometries);

/// Throws Error (NonFiniteVertex) unless the point is finite.
template <class Real>
void validate_corner(const Vec3<Real>& corner, char name);

}  // namespace pierce::scene
