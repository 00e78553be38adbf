// SPDX-License-Identifier: Apache-2.0
//
// Arrays that are made here and become NumPy's without a copy: columns whose length is not known
// before they are full (they grow in place, where the machine can), and the rows of vectors.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "pierce/arrays.h"

namespace pierce::python {

namespace nb = nanobind;

/// The rows of a vector, three numbers each, as an array (n, 3) that owns them. Needs the GIL.
template <class Number, class Row>
nb::object table_of(std::vector<Row>&& rows) {
  static_assert(sizeof(Row) == 3 * sizeof(Number));
  auto kept = std::make_unique<std::vector<Row>>(std::move(rows));
  auto* data = reinterpret_cast<Number*>(kept->data());
  const std::size_t count = kept->size();
  const nb::capsule owner(kept.get(),
                          [](void* p) noexcept { delete static_cast<std::vector<Row>*>(p); });
  static_cast<void>(kept.release());
  return nb::cast(nb::ndarray<nb::numpy, Number, nb::shape<-1, 3>>(data, {count, 3}, owner));
}

/// One column. Memory comes from malloc, whose realloc moves pages instead of copying them.
template <class T>
class GrowingColumn {
 public:
  /// Room for `size` elements in all; what is there stays.
  void reserve(std::size_t size) {
    if (size <= capacity_) return;
    const std::size_t capacity = std::max({size, capacity_ + capacity_ / 2, std::size_t{256}});
    reallocate(capacity);
  }
  [[nodiscard]] Rows<T> rows(std::size_t first, std::size_t count) {
    return {memory_.get() + first, count};
  }
  /// The first `size` elements, as a NumPy array that owns them. Needs the GIL.
  nb::object release(std::size_t size) {
    reallocate(std::max<std::size_t>(size, 1));
    T* data = memory_.get();
    const nb::capsule owner(data, [](void* p) noexcept { std::free(p); });
    static_cast<void>(memory_.release());
    return nb::cast(nb::ndarray<nb::numpy, T, nb::ndim<1>>(data, {size}, owner));
  }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };

  void reallocate(std::size_t capacity) {
    void* p = std::realloc(memory_.get(), capacity * sizeof(T));
    if (p == nullptr) throw std::bad_alloc();
    static_cast<void>(memory_.release());
    memory_.reset(static_cast<T*>(p));
    capacity_ = capacity;
  }

  std::unique_ptr<T, Free> memory_;
  std::size_t capacity_ = 0;
};

/// Memory for so many bytes, as an array of them that is not filled. Needs the GIL.
///
/// NumPy would ask for huge pages, which a kernel that has none left must first put together: up to
/// three times as slow to fill as these. Those of malloc cost what they cost a C++ program.
inline nb::object room(std::size_t bytes) {
  GrowingColumn<std::uint8_t> column;
  column.reserve(bytes);
  return column.release(bytes);
}

/// A bytearray that is not filled. Needs the GIL.
inline nb::object bytes_for(std::size_t bytes) {
  return nb::steal(PyByteArray_FromStringAndSize(nullptr, static_cast<Py_ssize_t>(bytes)));
}

/// The columns of few answers in one piece of memory, one after the other, those of the largest
/// numbers first: an array each would take longer to make than the answers. As Layout has them,
/// bindings/python/pierce/_table.py.
class PackedColumns {
 public:
  PackedColumns(const nb::object& bytes, std::size_t count)
      : next_(PyByteArray_AsString(bytes.ptr())), count_(count) {}
  /// The next one.
  template <class T>
  [[nodiscard]] Rows<T> column() {
    return {take<T>(count_), count_};
  }
  /// The next one, of three numbers a row.
  template <class T>
  [[nodiscard]] Rows<T> vectors() {
    return {take<T>(3 * count_), count_, 3 * sizeof(T)};
  }

 private:
  template <class T>
  T* take(std::size_t size) {
    return reinterpret_cast<T*>(std::exchange(next_, next_ + size * sizeof(T)));
  }

  char* next_;
  std::size_t count_;
};

/// Of hits: geometry, triangle, t, u, v, w, facing.
template <class Real>
HitArrays<Real> hit_columns(PackedColumns columns) {
  HitArrays<Real> hits;
  hits.geometry = columns.column<std::int64_t>();
  hits.triangle = columns.column<std::int64_t>();
  hits.t = columns.column<Real>();
  hits.u = columns.column<Real>();
  hits.v = columns.column<Real>();
  hits.w = columns.column<Real>();
  hits.facing = columns.column<std::uint8_t>();
  return hits;
}
template <class Real>
constexpr std::size_t kHitBytes = 2 * sizeof(std::int64_t) + 4 * sizeof(Real) + 1;

/// The columns of a list of hits: t, u, v, w, geometry, triangle, facing.
template <class Real>
class GrowingHits {
 public:
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Room for so many more, to be written at once.
  HitArrays<Real> more(std::size_t count) {
    const std::size_t first = size_;
    const auto grow = [&](auto& column) {
      column.reserve(first + count);
      return column.rows(first, count);
    };
    size_ += count;
    return {.t = grow(t_),
            .u = grow(u_),
            .v = grow(v_),
            .w = grow(w_),
            .geometry = grow(geometry_),
            .triangle = grow(triangle_),
            .facing = grow(facing_)};
  }

  /// New arrays, or, if they are few, all in one piece (PackedColumns).
  nb::object release() {
    if (size_ <= kFew) return packed();
    return nb::make_tuple(t_.release(size_), u_.release(size_), v_.release(size_),
                          w_.release(size_), geometry_.release(size_), triangle_.release(size_),
                          facing_.release(size_));
  }

 private:
  static constexpr std::size_t kFew = 2048;

  nb::object packed() {
    nb::object bytes = bytes_for(size_ * kHitBytes<Real>);
    PackedColumns to(bytes, size_);
    const auto copy = [&]<class T>(GrowingColumn<T>& from) {
      const Rows<T> rows = to.column<T>();
      if (size_ != 0) std::copy_n(from.rows(0, size_).data, size_, rows.data);
    };
    copy(geometry_);
    copy(triangle_);
    copy(t_);
    copy(u_);
    copy(v_);
    copy(w_);
    copy(facing_);
    return bytes;
  }

  GrowingColumn<Real> t_, u_, v_, w_;
  GrowingColumn<std::int64_t> geometry_, triangle_;
  GrowingColumn<std::uint8_t> facing_;
  std::size_t size_ = 0;
};

}  // namespace pierce::python
