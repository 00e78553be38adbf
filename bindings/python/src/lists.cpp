// SPDX-License-Identifier: Apache-2.0
//
// What has a list of triangles for each point, segment or box: near ones, touched ones.
#include <vector>

#include "columns.h"
#include "scene.h"
#include "scene/points/point_source.h"
#include "scene/validate_input.h"
#include "support/for_chunks.h"

namespace pierce::python {
namespace {

using Offsets = std::span<std::int64_t>;

constexpr std::size_t kPart = 64;  // questions that a task answers

// The lists of all questions, one after the other, a vector for each part of them. `ask(i, list)`
// replaces what `list` held; `offsets` has one element more than there are questions.
template <class Answer, class Ask>
std::vector<std::vector<Answer>> find_lists(Offsets offsets, const WorkOptions& work,
                                            const Ask& ask) {
  const std::size_t count = offsets.size() - 1;
  std::vector<std::vector<Answer>> parts((count + kPart - 1) / kPart);
  scene::for_chunks(parts.size(), work, 1, [&](std::size_t begin, std::size_t end) {
    const scene::StopPoll stop(work.stop);
    std::vector<Answer> list;
    for (std::size_t i = begin * kPart; i < std::min(count, end * kPart); ++i) {
      stop.now();
      ask(i, list);
      offsets[i + 1] = static_cast<std::int64_t>(list.size());
      auto& part = parts[i / kPart];
      part.insert(part.end(), list.begin(), list.end());
    }
  });
  offsets[0] = 0;
  for (std::size_t i = 0; i < count; ++i) offsets[i + 1] += offsets[i];
  return parts;
}

// An array of a member of all answers.
template <class T, class Answer, class Member>
nb::object column_of(const std::vector<std::vector<Answer>>& parts, std::size_t size,
                     const Member& member) {
  GrowingColumn<T> column;
  column.reserve(size);
  T* next = column.rows(0, size).data;
  for (const auto& part : parts) {
    for (const Answer& answer : part) *next++ = static_cast<T>(member(answer));
  }
  return column.release(size);
}

template <class Real>
nb::object points_of(const std::vector<std::vector<NearestPoint<Real>>>& parts, std::size_t size) {
  std::vector<Vec3<Real>> points;
  points.reserve(size);
  for (const auto& part : parts) {
    for (const NearestPoint<Real>& near : part) points.push_back(near.point);
  }
  return table_of<Real>(std::move(points));
}

Offsets offsets_of(const Buffer& buffer, std::size_t questions) {
  const auto offsets = buffer.packed<std::int64_t, std::int64_t>();
  if (offsets.size() != questions + 1) throw nb::value_error("offsets: one more than questions");
  return offsets;
}

template <class Real, class Touching>
nb::tuple touching_lists(const Rows<const Real>& first, const Rows<const Real>& second,
                         Offsets offsets, const Control& control, Length length,
                         const Touching& touching) {
  if (second.count != first.count) throw nb::value_error("as many of the one as of the other");
  std::vector<std::vector<TriangleRef>> parts;
  run(control, length, [&](const WorkOptions& work) {
    const scene::PointSource<Real> from(first), to(second);
    scene::validate_points(from, work.stop);
    scene::validate_points(to, work.stop);
    parts = find_lists<TriangleRef>(
        offsets, work, [&](std::size_t i, auto& list) { touching(from[i], to[i], list); });
  });
  const auto size = static_cast<std::size_t>(offsets.back());
  return nb::make_tuple(
      column_of<std::int64_t>(parts, size, [](const TriangleRef& ref) { return ref.geometry; }),
      column_of<std::int64_t>(parts, size, [](const TriangleRef& ref) { return ref.triangle; }));
}

}  // namespace

template <class Real>
nb::tuple SceneOf<Real>::nearest_triangles(nb::handle points, std::uint64_t most, nb::handle radii,
                                           nb::handle offsets, const Control& control) {
  using Near = NearestPoint<Real>;
  const Buffer in(points, "points"), radius_buffer(radii, "radius");
  const Buffer out(offsets, "offsets", Access::Write);
  const auto point_rows = in.rows<const Real>(3);
  const auto reach = radius_buffer.packed<const Real, const Real>();
  if (reach.size() != 1 && reach.size() != point_rows.count) {
    throw nb::value_error("radius: one, or one for each point");
  }
  const Offsets ends = offsets_of(out, point_rows.count);
  std::vector<std::vector<Near>> parts;
  {
    const Asking scene(*this);
    run(control, length(point_rows.count, Reach::All), [&](const WorkOptions& work) {
      const scene::PointSource<Real> asked(point_rows);
      scene::validate_points(asked, work.stop);
      parts = find_lists<Near>(ends, work, [&](std::size_t i, auto& list) {
        scene->nearest_triangles(asked[i], most, list, reach[reach.size() == 1 ? 0 : i]);
      });
    });
  }
  const auto size = static_cast<std::size_t>(ends.back());
  const auto column = [&]<class T>(T /*type*/, auto member) {
    return column_of<T>(parts, size, [member](const Near& near) { return near.*member; });
  };
  return nb::make_tuple(
      points_of(parts, size), column(Real(), &Near::distance), column(Real(), &Near::u),
      column(Real(), &Near::v), column(Real(), &Near::w), column(std::int64_t(), &Near::geometry),
      column(std::int64_t(), &Near::triangle), column(std::uint8_t(), &Near::feature));
}

template <class Real>
nb::tuple SceneOf<Real>::touching_segments(nb::handle starts, nb::handle ends, nb::handle offsets,
                                           const Control& control) {
  const Buffer from(starts, "starts"), to(ends, "ends"), out(offsets, "offsets", Access::Write);
  const auto first = from.rows<const Real>(3);
  const Asking scene(*this);
  return touching_lists(first, to.rows<const Real>(3), offsets_of(out, first.count), control,
                        length(first.count, Reach::All),
                        [&](const Vec3<Real>& p, const Vec3<Real>& q, auto& list) {
                          scene->touching_segment(p, q, list);
                        });
}

template <class Real>
nb::tuple SceneOf<Real>::touching_boxes(nb::handle lower, nb::handle upper, nb::handle offsets,
                                        const Control& control) {
  const Buffer from(lower, "lower"), to(upper, "upper"), out(offsets, "offsets", Access::Write);
  const auto first = from.rows<const Real>(3);
  const Asking scene(*this);
  return touching_lists(first, to.rows<const Real>(3), offsets_of(out, first.count), control,
                        length(first.count, Reach::All),
                        [&](const Vec3<Real>& p, const Vec3<Real>& q, auto& list) {
                          scene->touching_box(p, q, list);
                        });
}

#define PIERCE_LISTS(Real)                                                                   \
  template nb::tuple SceneOf<Real>::nearest_triangles(nb::handle, std::uint64_t, nb::handle, \
                                                      nb::handle, const Control&);           \
  template nb::tuple SceneOf<Real>::touching_segments(nb::handle, nb::handle, nb::handle,    \
                                                      const Control&);                       \
  template nb::tuple SceneOf<Real>::touching_boxes(nb::handle, nb::handle, nb::handle,       \
                                                   const Control&)

PIERCE_LISTS(float);
PIERCE_LISTS(double);

}  // namespace pierce::python
