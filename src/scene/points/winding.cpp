// SPDX-License-Identifier: Apache-2.0
//
// Winding numbers, for one point and for many.
#include "pierce/winding.h"

#include <string>

#include "scene/points/winder.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/finite.h"
#include "support/float_environment.h"

namespace pierce {
namespace {

void validate_tolerance(double tolerance) {
  if (tolerance >= 0) return;
  throw Error(ErrorCode::InvalidArgument,
              std::string("the tolerance ") +
                  (is_nan(tolerance) ? "is not a number" : "is negative") + "; give 0 or more");
}

}  // namespace

template <class Real>
WindingNumber Scene<Real>::winding_number(const Vec3<Real>& point,
                                          const WindingOptions& options) const {
  const FloatEnvironment environment;
  scene::validate_point(point);
  validate_tolerance(options.tolerance);
  impl_->require_flat("winding numbers");
  const scene::AxisSpace space = impl_->axis_space();
  WindingNumber number;
  scene::ask_winding(*impl_, space, point, options.work,
                     [&](std::size_t, const auto& winder, const auto& asked) {
                       number = winder.number(asked, options.tolerance);
                     });
  return number;
}

template <class Real>
void Scene<Real>::winding_numbers(const Rows<const Real>& rows, const Rows<double>& values,
                                  const Rows<double>& errors, const WindingOptions& options) const {
  const FloatEnvironment environment;
  const scene::PointSource<Real> points(rows);
  scene::validate_outputs("point", points.size(), values.count);
  const scene::OutputRows<double> value_rows(values, points.size(), "point", "values");
  const scene::OutputRows<double> error_rows(errors, points.size(), "point", "errors");
  scene::validate_points(points, options.work.stop);
  validate_tolerance(options.tolerance);
  impl_->require_flat("winding numbers");
  scene::AxisSpace space = impl_->axis_space();
  scene::ask_windings(*impl_, space, points, options.work,
                      [&](std::size_t i, const auto& winder, const auto& asked) {
                        const WindingNumber number = winder.number(asked, options.tolerance);
                        if (value_rows.wanted()) value_rows.set(i, number.value);
                        if (error_rows.wanted()) error_rows.set(i, number.error);
                      });
}

template <class Real>
void Scene<Real>::winding_numbers(std::span<const Vec3<Real>> points,
                                  std::span<WindingNumber> numbers,
                                  const WindingOptions& options) const {
  scene::validate_outputs("point", points.size(), numbers.size());
  if (numbers.empty()) return;
  constexpr auto kStride = static_cast<std::ptrdiff_t>(sizeof(WindingNumber));
  winding_numbers(rows(points), {&numbers[0].value, numbers.size(), kStride},
                  {&numbers[0].error, numbers.size(), kStride}, options);
}

template WindingNumber Scene<float>::winding_number(const Vec3<float>&,
                                                    const WindingOptions&) const;
template WindingNumber Scene<double>::winding_number(const Vec3<double>&,
                                                     const WindingOptions&) const;
template void Scene<float>::winding_numbers(const Rows<const float>&, const Rows<double>&,
                                            const Rows<double>&, const WindingOptions&) const;
template void Scene<float>::winding_numbers(std::span<const Vec3<float>>, std::span<WindingNumber>,
                                            const WindingOptions&) const;
template void Scene<double>::winding_numbers(const Rows<const double>&, const Rows<double>&,
                                             const Rows<double>&, const WindingOptions&) const;
template void Scene<double>::winding_numbers(std::span<const Vec3<double>>,
                                             std::span<WindingNumber>, const WindingOptions&) const;

}  // namespace pierce
