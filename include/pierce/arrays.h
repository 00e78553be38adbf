// SPDX-License-Identifier: Apache-2.0
//
// Arrays as people have them: rays, hits and points in columns, rows and strides of any kind. A
// batch reads and writes them where they are, some hundred rays at a time, and copies nothing.
//
//   std::vector<float> rays;               // n rows of 6: origin, direction
//   std::vector<float> t(n);               // only what is wanted of the hits
//   std::vector<std::int64_t> triangle(n);
//   scene.closest_hits(RayArrays<float>::rows_of_6(rays.data(), n),
//                      HitArrays<float>{.t = rows(t), .triangle = rows(triangle)});
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <ranges>
#include <span>
#include <type_traits>

#include "pierce/error.h"
#include "pierce/nearest.h"
#include "pierce/types.h"

namespace pierce {

/// Rows of numbers in the caller's memory. Component j of row i lies
/// `i * stride + j * step` bytes after `data`; the type of the argument that the rows are given for
/// says how many components there are (three for points and directions, one for columns).
///
/// Strides may be anything: larger than a row (a slice, a member of a record), negative (an array
/// read backwards), 0 (what is read is the same for all rows); `step` is the height of a column in
/// Fortran order. Numbers need not be aligned. What is written must not overlap.
///
/// No rows at all (the default) mean that there is no such array: an input's default holds, an
/// output is not wanted.
template <class T>
struct Rows {
  T* data = nullptr;
  std::size_t count = 0;              ///< rows
  std::ptrdiff_t stride = sizeof(T);  ///< bytes from a row to the next
  std::ptrdiff_t step = sizeof(T);    ///< bytes from a component to the next

  [[nodiscard]] bool empty() const { return count == 0; }
  /// Rows that may be written can be read.
  operator Rows<const T>() const requires(!std::is_const_v<T>) {
    return {data, count, stride, step};
  }
};

/// One row for all: what stands in `value` holds for every ray. `value` must live as long as the
/// rows are used.
template <class T>
[[nodiscard]] Rows<const T> row_for_all(const T& value) {
  return {std::addressof(value), 1};
}
template <class Real>
[[nodiscard]] Rows<const Real> row_for_all(const Vec3<Real>& value) {
  return {&value.x, 1, sizeof value};
}
template <class T>
void row_for_all(const T&& value) = delete;  // gone before the batch begins

/// The elements of a vector, a std::array, a span ..., of numbers (one a row) or of Vec3. `range`
/// must live as long as the rows are used; a temporary one does not compile.
template <std::ranges::contiguous_range Range>
requires std::ranges::borrowed_range<Range>
[[nodiscard]] auto rows(Range&& range) {
  using Element = std::remove_reference_t<std::ranges::range_reference_t<Range>>;
  const std::size_t count = std::ranges::size(range);
  auto* data = std::ranges::data(range);
  if constexpr (requires { data->x; }) {
    using Real = std::conditional_t<std::is_const_v<Element>, const decltype(Element::x),
                                    decltype(Element::x)>;
    return Rows<Real>{reinterpret_cast<Real*>(data), count, sizeof(Element)};
  } else {
    return Rows<Element>{data, count};
  }
}

/// The rays of a batch. Origins and directions are needed, and one of each for every ray, or one
/// row for all; likewise the ends of the ranges: one for every ray, one for all, or none (0 and
/// infinity). There are as many rays as the longest says.
///
/// What lies as an array of Ray does, be it an array of numbers with eight a row, is used in place.
template <class Real>
struct RayArrays {
  Rows<const Real> origins, directions;  ///< three components each
  Rows<const Real> t_min = {}, t_max = {};

  [[nodiscard]] static RayArrays of(std::span<const Ray<Real>> rays) {
    return rows_of_8(reinterpret_cast<const Real*>(rays.data()), rays.size());
  }
  /// Rows of 6: origin, direction. `stride` in bytes.
  [[nodiscard]] static RayArrays rows_of_6(const Real* data, std::size_t count,
                                           std::ptrdiff_t stride = 6 * sizeof(Real)) {
    return {{data, count, stride}, {data + (data != nullptr ? 3 : 0), count, stride}};
  }
  /// Rows of 8: origin, direction, t_min, t_max.
  [[nodiscard]] static RayArrays rows_of_8(const Real* data, std::size_t count,
                                           std::ptrdiff_t stride = 8 * sizeof(Real)) {
    if (data == nullptr) return rows_of_6(data, count, stride);
    return {{data, count, stride},
            {data + 3, count, stride},
            {data + 6, count, stride},
            {data + 7, count, stride}};
  }
};

/// Numbers of geometries or triangles, as std::uint32_t (none: kNone, 4294967295) or as
/// std::int64_t (none: -1).
class IdRows {
 public:
  IdRows() = default;
  IdRows(Rows<std::uint32_t> ids)
      : data_(ids.data), count_(ids.count), stride_(ids.stride), wide_(false) {}
  IdRows(Rows<std::int64_t> ids)
      : data_(ids.data), count_(ids.count), stride_(ids.stride), wide_(true) {}

  [[nodiscard]] void* data() const { return data_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] bool wide() const { return wide_; }  ///< std::int64_t

 private:
  void* data_ = nullptr;
  std::size_t count_ = 0;
  std::ptrdiff_t stride_ = 0;
  bool wide_ = false;
};

/// What is wanted of the hits of a batch: any of the columns, each with a row for every ray. Rows
/// that are not wanted are left out. The numbers are those of Hit, see there. A miss has t =
/// infinity, u = v = w = 0, facing Front, and no geometry and triangle, see IdRows.
template <class Real>
struct HitArrays {
  std::span<Hit<Real>> hits = {};  ///< whole Hits; beside or in place of columns
  Rows<Real> t = {}, u = {}, v = {}, w = {};
  IdRows geometry = {}, triangle = {};
  Rows<std::uint8_t> facing = {};  ///< 0 Front, 1 Back
  /// Rows of three, NaN for a miss: Scene::hit_point, normal and unit_normal of the hit.
  Rows<Real> point = {}, normal = {}, unit_normal = {};
};

/// What is wanted of the crossings of a batch.
struct CrossingsArrays {
  std::span<Crossings> crossings = {};  ///< whole Crossings; beside or in place of columns
  Rows<std::uint32_t> count = {};
  Rows<std::int32_t> signed_count = {};
  Rows<std::uint8_t> origin_on_surface = {};  ///< 0 or 1
};

/// What is wanted of the nearest points of a batch. If there is none: distance = infinity, point =
/// NaN in each coordinate, u = v = w = 0, feature Face, and no geometry and triangle, see IdRows.
template <class Real>
struct NearestArrays {
  std::span<NearestPoint<Real>> nearest = {};  ///< whole ones; a default one if there is none
  Rows<Real> point = {};                       ///< three components
  Rows<Real> distance = {}, u = {}, v = {}, w = {};
  IdRows geometry = {}, triangle = {};
  Rows<std::uint8_t> feature = {};  ///< as Feature has it
};

/// Is asked for room for the hits of some rays of a batch: of the rays first, first + 1, ...; those
/// of ray first + i are to be the rows offsets[i] ... offsets[i + 1] - 1 of what it returns, and
/// offsets begins with 0. Pieces come one after the other in the order of the rays.
template <class Real>
using HitRoom =
    std::function<HitArrays<Real>(std::uint64_t first, std::span<const std::uint64_t> offsets)>;

}  // namespace pierce
