// SPDX-License-Identifier: Apache-2.0
//
// Meshes that own their arrays, and meshes in arrays of any layout.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pierce/arrays.h"
#include "pierce/error.h"
#include "pierce/types.h"

namespace pierce {

/// Three vertex indices a row, of any of the usual types of integers.
class TriangleRows {
 public:
  enum class Index : std::uint8_t { Uint16, Uint32, Uint64, Int32, Int64 };

  TriangleRows() = default;
  TriangleRows(Rows<const std::uint16_t> rows) : TriangleRows(rows, Index::Uint16) {}
  TriangleRows(Rows<const std::uint32_t> rows) : TriangleRows(rows, Index::Uint32) {}
  TriangleRows(Rows<const std::uint64_t> rows) : TriangleRows(rows, Index::Uint64) {}
  TriangleRows(Rows<const std::int32_t> rows) : TriangleRows(rows, Index::Int32) {}
  TriangleRows(Rows<const std::int64_t> rows) : TriangleRows(rows, Index::Int64) {}
  TriangleRows(std::span<const Triangle> triangles)
      : data_(triangles.data()), count_(triangles.size()), stride_(sizeof(Triangle)) {}

  [[nodiscard]] const void* data() const { return data_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] std::ptrdiff_t step() const { return step_; }
  [[nodiscard]] Index index() const { return index_; }

 private:
  template <class T>
  TriangleRows(const Rows<const T>& rows, Index index)
      : data_(rows.data),
        count_(rows.count),
        stride_(rows.stride),
        step_(rows.step),
        index_(index) {}

  const void* data_ = nullptr;
  std::size_t count_ = 0;
  std::ptrdiff_t stride_ = 0, step_ = sizeof(std::uint32_t);
  Index index_ = Index::Uint32;
};

/// A mesh in arrays of the caller's, of any layout (see Rows) and type of index:
///
///   MeshArrays<double>{.vertices = {v.data(), n, 3 * sizeof(double)}, .triangles = rows_of_int64}
///
/// What lies as an array of Vec3 or Triangle does (packed rows of three; of std::int32_t likewise)
/// is viewed as by MeshView; the rest is copied when a scene or a Mesh is made of it.
template <class Real>
struct MeshArrays {
  Rows<const Real> vertices = {};  ///< three components each
  TriangleRows triangles = {};
};

/// A mesh that owns its arrays.
template <class Real>
struct Mesh {
  std::vector<Vec3<Real>> vertices;
  std::vector<Triangle> triangles;

  /// A copy. Throws Error (IndexOutOfRange) that names the first triangle with an index that is
  /// negative or names no vertex, and how many there are; (InvalidArgument) if there are rows but
  /// no data.
  [[nodiscard, gnu::visibility("default")]] static Mesh from(const MeshArrays<Real>& arrays);

  /// Good for as long as this mesh is neither changed nor destroyed.
  [[nodiscard]] MeshView<Real> view() const& { return {vertices, triangles}; }
  void view() const&& = delete;  // of a mesh that is about to be gone
};

extern template struct Mesh<float>;
extern template struct Mesh<double>;

}  // namespace pierce
