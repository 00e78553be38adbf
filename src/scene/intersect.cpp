// SPDX-License-Identifier: Apache-2.0
#include "pierce/intersect.h"

#include "predicate/decide.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"

namespace pierce {

template <class Real>
std::optional<Hit<Real>> intersect(const Ray<Real>& ray, const Vec3<Real>& a, const Vec3<Real>& b,
                                   const Vec3<Real>& c, Range range) {
  const FloatEnvironment environment;
  scene::validate_ray(ray);
  scene::validate_corner(a, 'a');
  scene::validate_corner(b, 'b');
  scene::validate_corner(c, 'c');
  const predicate::RayD ray_d = predicate::to_double(ray, range);
  const predicate::TriangleD triangle{predicate::to_double(a), predicate::to_double(b),
                                      predicate::to_double(c)};
  predicate::LadderCounts counts;
  predicate::DecidedHit decided;
  if (!predicate::decide_hit(ray_d, triangle, decided, counts)) return std::nullopt;
  Hit<Real> hit = predicate::round_hit<Real>(ray_d, triangle, decided.zeros, counts);
  hit.geometry = 0;
  hit.triangle = 0;
  return hit;
}

template std::optional<Hit<float>> intersect(const Ray<float>&, const Vec3<float>&,
                                             const Vec3<float>&, const Vec3<float>&, Range);
template std::optional<Hit<double>> intersect(const Ray<double>&, const Vec3<double>&,
                                              const Vec3<double>&, const Vec3<double>&, Range);

}  // namespace pierce
