// SPDX-License-Identifier: Apache-2.0
//
// What points are asked.
#include "columns.h"
#include "scene.h"

namespace pierce::python {
namespace {

LocateOptions options_of(const PointQuestion& question, const WorkOptions& work) {
  return {.rule = static_cast<InsideRule>(question.rule),
          .open_mesh = question.open_mesh,
          .work = work};
}

}  // namespace

template <class Real>
void SceneOf<Real>::locate(nb::handle points, nb::handle locations, const PointQuestion& question) {
  const Buffer in(points, "points"), out(locations, "locations", Access::Write);
  const auto point_rows = in.rows<const Real>(3);
  const auto results = out.rows<std::int8_t>();
  const Asking scene(*this);
  // The first call asks whether the surface is closed.
  run(question.control, length(point_rows.count, Reach::All), [&](const WorkOptions& work) {
    scene->locate(point_rows, results, options_of(question, work));
  });
}

template <class Real>
void SceneOf<Real>::signed_distances(nb::handle points, nb::handle distances,
                                     const PointQuestion& question) {
  const Buffer in(points, "points"), out(distances, "distances", Access::Write);
  const auto point_rows = in.rows<const Real>(3);
  const auto results = out.rows<Real>();
  const Asking scene(*this);
  run(question.control, length(point_rows.count, Reach::All), [&](const WorkOptions& work) {
    scene->signed_distances(point_rows, results, options_of(question, work));
  });
}

template <class Real>
void SceneOf<Real>::winding_numbers(nb::handle points, nb::handle numbers, nb::handle errors,
                                    double tolerance, const Control& control) {
  const Buffer in(points, "points"), out(numbers, "numbers", Access::Write);
  const Buffer off(errors, "errors", Access::Write);
  const auto point_rows = in.rows<const Real>(3);
  const auto results = out.rows<double>(), bounds = off.rows<double>();
  const Asking scene(*this);
  run(control, length(point_rows.count, Reach::All), [&](const WorkOptions& work) {
    scene->winding_numbers(point_rows, results, bounds, {.tolerance = tolerance, .work = work});
  });
}

template <class Real>
void SceneOf<Real>::nearest(const Rows<const Real>& points, nb::handle radii,
                            const NearestArrays<Real>& results, const Control& control) {
  const Buffer radius_buffer(radii, "radius");
  NearestOptions<Real> options;
  const auto reach = radius_buffer.packed<const Real, const Real>();
  if (reach.size() == 1) {
    options.radius = reach[0];
  } else {
    options.radii = reach;
  }
  const Asking scene(*this);
  run(control, length(points.count), [&](const WorkOptions& work) {
    options.work = work;
    scene->nearest_points(points, results, options);
  });
}

template <class Real>
void SceneOf<Real>::nearest_points(nb::handle points, nb::handle radii, const nb::tuple& columns,
                                   const Control& control) {
  const Buffer in(points, "points"), point(columns[0], "point", Access::Write);
  const Buffer distance(columns[1], "distance", Access::Write);
  const Buffer u(columns[2], "u", Access::Write), v(columns[3], "v", Access::Write),
      w(columns[4], "w", Access::Write);
  const Buffer geometry(columns[5], "geometry", Access::Write);
  const Buffer triangle(columns[6], "triangle", Access::Write);
  const Buffer feature(columns[7], "feature", Access::Write);
  nearest(in.rows<const Real>(3), radii,
          {.point = point.rows<Real>(3),
           .distance = distance.rows<Real>(),
           .u = u.rows<Real>(),
           .v = v.rows<Real>(),
           .w = w.rows<Real>(),
           .geometry = geometry.rows<std::int64_t>(),
           .triangle = triangle.rows<std::int64_t>(),
           .feature = feature.rows<std::uint8_t>()},
          control);
}

template <class Real>
nb::object SceneOf<Real>::nearest_packed(nb::handle points, nb::handle radii,
                                         const Control& control) {
  const Buffer in(points, "points");
  const auto point_rows = in.rows<const Real>(3);
  const std::size_t count = point_rows.count;
  nb::object bytes = bytes_for(count * (2 * sizeof(std::int64_t) + 7 * sizeof(Real) + 1));
  PackedColumns columns(bytes, count);
  NearestArrays<Real> results;
  results.geometry = columns.column<std::int64_t>();
  results.triangle = columns.column<std::int64_t>();
  results.point = columns.vectors<Real>();
  results.distance = columns.column<Real>();
  results.u = columns.column<Real>();
  results.v = columns.column<Real>();
  results.w = columns.column<Real>();
  results.feature = columns.column<std::uint8_t>();
  nearest(point_rows, radii, results, control);
  return bytes;
}

template <class Real>
void SceneOf<Real>::voxelise(nb::handle grid, std::uint32_t x, std::uint32_t y, std::uint32_t z,
                             nb::handle cells, const PointQuestion& question) {
  const Buffer grid_buffer(grid, "grid"), out(cells, "cells", Access::Write);
  const auto numbers = grid_buffer.packed<const Real, const Real>();
  if (numbers.size() != 6) throw nb::value_error("grid: origin and spacing");
  const Grid<Real> cell_grid{.origin = {numbers[0], numbers[1], numbers[2]},
                             .spacing = {numbers[3], numbers[4], numbers[5]},
                             .size = {x, y, z}};
  const auto results = out.packed<Location, std::int8_t>();
  const Asking scene(*this);
  run(question.control, Length::Long, [&](const WorkOptions& work) {
    scene->voxelise(cell_grid, 0, x, results, options_of(question, work));
  });
}

#define PIERCE_POINTS(Real)                                                                      \
  template void SceneOf<Real>::locate(nb::handle, nb::handle, const PointQuestion&);             \
  template void SceneOf<Real>::signed_distances(nb::handle, nb::handle, const PointQuestion&);   \
  template void SceneOf<Real>::winding_numbers(nb::handle, nb::handle, nb::handle, double,       \
                                               const Control&);                                  \
  template void SceneOf<Real>::nearest_points(nb::handle, nb::handle, const nb::tuple&,          \
                                              const Control&);                                   \
  template nb::object SceneOf<Real>::nearest_packed(nb::handle, nb::handle, const Control&);     \
  template void SceneOf<Real>::voxelise(nb::handle, std::uint32_t, std::uint32_t, std::uint32_t, \
                                        nb::handle, const PointQuestion&)

PIERCE_POINTS(float);
PIERCE_POINTS(double);

}  // namespace pierce::python
