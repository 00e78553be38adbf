// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_arrays.h"

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include "scene/strided.h"
#include "scene/validate_input.h"

namespace pierce {
namespace scene {
namespace {

template <class T>
using RowsOf = Rows<const T>;

// Rows that are read between two looks at whether to stop: a fraction of a millisecond.
constexpr std::size_t kRowsAtATime = 65536;

/// Calls `work(first, last)` for some rows after the other.
template <class Work>
void for_some_rows(std::size_t count, const StopPoll& stop, const Work& work) {
  for (std::size_t first = 0; first < count; first += kRowsAtATime) {
    stop.now();
    work(first, std::min(count, first + kRowsAtATime));
  }
}

/// Calls `visit` with the rows in their own type.
template <class Visit>
void with_rows(const TriangleRows& rows, const Visit& visit) {
  const auto as = [&]<class T>(T) {
    visit(RowsOf<T>{static_cast<const T*>(rows.data()), rows.count(), rows.stride(), rows.step()});
  };
  switch (rows.index()) {
    case TriangleRows::Index::Uint16:
      return as(std::uint16_t{});
    case TriangleRows::Index::Uint32:
      return as(std::uint32_t{});
    case TriangleRows::Index::Uint64:
      return as(std::uint64_t{});
    case TriangleRows::Index::Int32:
      return as(std::int32_t{});
    case TriangleRows::Index::Int64:
      return as(std::int64_t{});
  }
}

template <class T>
T index_at(const RowsOf<T>& rows, std::size_t row, std::size_t corner) {
  T index;
  std::memcpy(&index,
              reinterpret_cast<const std::byte*>(rows.data) +
                  static_cast<std::ptrdiff_t>(row) * rows.stride +
                  static_cast<std::ptrdiff_t>(corner) * rows.step,
              sizeof index);
  return index;
}

/// Throws Error (IndexOutOfRange) that says which triangles name what is not below `limit`.
template <class T>
[[noreturn]] void refuse_indices(const RowsOf<T>& rows, std::uint64_t limit, std::size_t vertices,
                                 const std::string& where) {
  std::size_t first = 0, count = 0;
  T bad = 0;
  for (std::size_t i = 0; i < rows.count; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const T index = index_at(rows, i, j);
      if (static_cast<std::uint64_t>(index) < limit) continue;
      if (count++ == 0) first = i, bad = index;
      break;
    }
  }
  throw Error(ErrorCode::IndexOutOfRange,
              "triangle " + std::to_string(first) + where + counted(count) + ": names vertex " +
                  std::to_string(bad) + ", but there are only " + std::to_string(vertices) +
                  "; correct the index",
              first, count);
}

template <class T>
std::vector<Triangle> copy_triangles(const RowsOf<T>& rows, std::size_t vertices,
                                     const std::string& where, const StopPoll& stop) {
  const auto limit = std::min<std::uint64_t>(vertices, std::uint64_t{1} << 32);
  std::vector<Triangle> triangles;
  triangles.reserve(rows.count);
  bool good = true;
  for_some_rows(rows.count, stop, [&](std::size_t first, std::size_t last) {
    triangles.resize(last);
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const T index = index_at(rows, i, j);
        good &= static_cast<std::uint64_t>(index) < limit;  // a negative one is very large
        triangles[i][j] = static_cast<std::uint32_t>(index);
      }
    }
  });
  if (!good) refuse_indices(rows, limit, vertices, where);
  return triangles;
}

/// Of indices that are viewed as unsigned, and would not be called by their name any more.
void validate_signs(const RowsOf<std::int32_t>& rows, std::size_t vertices,
                    const std::string& where, const StopPoll& stop) {
  std::int32_t any = 0;
  for_some_rows(rows.count, stop, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = 0; j < 3; ++j) any |= index_at(rows, i, j);
    }
  });
  if (any < 0) refuse_indices(rows, std::uint64_t{1} << 31, vertices, where);
}

template <class T>
bool lies_as(const Rows<const T>& rows, std::ptrdiff_t row) {
  return (rows.stride == row || rows.count < 2) && rows.step == sizeof(T) && is_aligned(rows.data);
}

}  // namespace

template <class Real>
MeshView<Real> view_or_copy(const MeshArrays<Real>& arrays, const std::string& where,
                            const StopPoll& stop, Mesh<Real>& own) {
  const std::size_t vertices = arrays.vertices.count;
  validate_rows(arrays.vertices.data, vertices, "vertices");
  validate_rows(arrays.triangles.data(), arrays.triangles.count(), "triangles");
  MeshView<Real> view;
  if (lies_as(arrays.vertices, sizeof(Vec3<Real>))) {
    view.vertices = std::span(reinterpret_cast<const Vec3<Real>*>(arrays.vertices.data), vertices);
  } else {
    own.vertices.reserve(vertices);
    const InputRows<Real> rows(arrays.vertices);
    for_some_rows(vertices, stop, [&](std::size_t first, std::size_t last) {
      own.vertices.resize(last);
      rows.template read<3>(first, last - first, &own.vertices[first].x, sizeof(Vec3<Real>));
    });
    view.vertices = own.vertices;
  }
  with_rows(arrays.triangles, [&]<class T>(const RowsOf<T>& rows) {
    if (sizeof(T) == sizeof(std::uint32_t) && lies_as(rows, sizeof(Triangle))) {
      if constexpr (std::is_same_v<T, std::int32_t>) {
        validate_signs(rows, vertices, where, stop);
      }
      view.triangles = std::span(reinterpret_cast<const Triangle*>(rows.data), rows.count);
    } else {
      own.triangles = copy_triangles(rows, vertices, where, stop);
      view.triangles = own.triangles;
    }
  });
  return view;
}

template MeshView<float> view_or_copy(const MeshArrays<float>&, const std::string&, const StopPoll&,
                                      Mesh<float>&);
template MeshView<double> view_or_copy(const MeshArrays<double>&, const std::string&,
                                       const StopPoll&, Mesh<double>&);

}  // namespace scene

template <class Real>
Mesh<Real> Mesh<Real>::from(const MeshArrays<Real>& arrays) {
  Mesh mesh;
  const MeshView<Real> view = scene::view_or_copy(arrays, "", scene::StopPoll(), mesh);
  if (mesh.vertices.size() != view.vertices.size()) {
    mesh.vertices.assign(view.vertices.begin(), view.vertices.end());
  }
  if (mesh.triangles.size() != view.triangles.size()) {
    mesh.triangles.assign(view.triangles.begin(), view.triangles.end());
    const auto good = [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(),
                         [&](std::uint32_t i) { return i < view.vertices.size(); });
    };
    if (!std::all_of(mesh.triangles.begin(), mesh.triangles.end(), good)) {
      scene::validate_mesh<Real>(mesh.view(), 0, 1);
    }
  }
  return mesh;
}

template struct Mesh<float>;
template struct Mesh<double>;

}  // namespace pierce
