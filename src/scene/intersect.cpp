// SPDX-License-Identifier: Apache-2.0
#include "pierce/intersect.h"

#include "predicate/decide.h"
#include "predicate/place.h"
#include "scene/rays/after.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

template <class Real>
predicate::TriangleD validated(const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c) {
  scene::validate_corner(a, 'a');
  scene::validate_corner(b, 'b');
  scene::validate_corner(c, 'c');
  return {predicate::to_double(a), predicate::to_double(b), predicate::to_double(c)};
}

}  // namespace

template <class Real>
std::optional<Hit<Real>> intersect(const Ray<Real>& ray, const Vec3<Real>& a, const Vec3<Real>& b,
                                   const Vec3<Real>& c, Range range) {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  const predicate::TriangleD triangle = validated(a, b, c);
  const predicate::RayD ray_d = predicate::to_double(ray, range);
  predicate::LadderCounts counts;
  predicate::DecidedHit decided;
  if (!predicate::decide_hit(ray_d, triangle, decided, counts)) return std::nullopt;
  Hit<Real> hit = predicate::round_hit<Real>(ray_d, triangle, decided.zeros, counts);
  hit.geometry = 0;
  hit.triangle = 0;
  return environment.made(hit);
}

template <class Real>
Vec3<Real> hit_point(const Ray<Real>& ray, const Vec3<Real>& a, const Vec3<Real>& b,
                     const Vec3<Real>& c) {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  const predicate::TriangleD triangle = validated(a, b, c);
  const predicate::RayD line = scene::line_of(ray);
  predicate::LadderCounts counts;
  predicate::DecidedHit decided;
  if (!predicate::decide_hit(line, triangle, decided, counts)) {
    throw Error(ErrorCode::InvalidArgument,
                "the ray's line does not hit the triangle; ask intersect whether the ray does");
  }
  return environment.made(predicate::round_point<Real>(line, triangle));
}

template <class Real>
Vec3<Real> normal(const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c) {
  const FloatEnvironment environment;
  return environment.made(predicate::round_normal<Real>(validated(a, b, c)));
}

template <class Real>
Vec3<Real> unit_normal(const Vec3<Real>& a, const Vec3<Real>& b, const Vec3<Real>& c) {
  const FloatEnvironment environment;
  return environment.made(predicate::round_unit_normal<Real>(validated(a, b, c)));
}

template std::optional<Hit<float>> intersect(const Ray<float>&, const Vec3<float>&,
                                             const Vec3<float>&, const Vec3<float>&, Range);
template std::optional<Hit<double>> intersect(const Ray<double>&, const Vec3<double>&,
                                              const Vec3<double>&, const Vec3<double>&, Range);
template Vec3<float> hit_point(const Ray<float>&, const Vec3<float>&, const Vec3<float>&,
                               const Vec3<float>&);
template Vec3<double> hit_point(const Ray<double>&, const Vec3<double>&, const Vec3<double>&,
                                const Vec3<double>&);
template Vec3<float> normal(const Vec3<float>&, const Vec3<float>&, const Vec3<float>&);
template Vec3<double> normal(const Vec3<double>&, const Vec3<double>&, const Vec3<double>&);
template Vec3<float> unit_normal(const Vec3<float>&, const Vec3<float>&, const Vec3<float>&);
template Vec3<double> unit_normal(const Vec3<double>&, const Vec3<double>&, const Vec3<double>&);

}  // namespace pierce
