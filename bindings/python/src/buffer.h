// SPDX-License-Identifier: Apache-2.0
//
// Arrays of Python's, wherever and however they lie: the buffer protocol, by bytes. The Python side
// has seen to it that they have the right type and shape; what comes in here all the same is
// refused, never misread.
#pragma once

#include <nanobind/nanobind.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>

#include "pierce/arrays.h"

namespace pierce::python {

namespace nb = nanobind;

enum class Access : std::uint8_t { Read, Write };

/// Keeps an array exported; None is an array that is not given. Made and destroyed under the GIL.
class Buffer {
 public:
  Buffer() = default;
  Buffer(nb::handle array, const char* name, Access access = Access::Read);
  Buffer(Buffer&& other) noexcept
      : view_(other.view_), name_(other.name_), given_(std::exchange(other.given_, false)) {}
  Buffer& operator=(Buffer&& other) noexcept;
  Buffer(const Buffer&) = delete;
  ~Buffer();

  [[nodiscard]] bool given() const { return given_; }
  /// Of an array with two dimensions; else 0.
  [[nodiscard]] int columns() const {
    return given_ && view_.ndim == 2 ? static_cast<int>(view_.shape[1]) : 0;
  }

  /// One row for each element of a one-dimensional array (`components` 0), or for each row of an
  /// array with so many columns. Throws TypeError or ValueError if it is no such array of T.
  template <class T>
  [[nodiscard]] Rows<T> rows(int components = 0) const {
    using Element = std::remove_const_t<T>;
    if (!given_) return {};
    constexpr Kind kind = std::is_floating_point_v<Element> ? Kind::Float
                          : std::is_signed_v<Element>       ? Kind::Signed
                                                            : Kind::Unsigned;
    check(kind, sizeof(Element), components);
    return {static_cast<T*>(view_.buf), static_cast<std::size_t>(view_.shape[0]), view_.strides[0],
            components == 0 ? static_cast<std::ptrdiff_t>(sizeof(T)) : view_.strides[1]};
  }

  /// The elements of an array that lies in one piece, as spans need it: rows of T, each of
  /// `components` numbers of type Number.
  template <class T, class Number>
  [[nodiscard]] std::span<T> packed(int components = 0) const {
    static_assert(sizeof(T) % sizeof(Number) == 0 && alignof(T) == alignof(Number));
    if (!given_) return {};
    const Rows<Number> all = rows<Number>(components);
    check_packed(sizeof(T), alignof(T));
    return {reinterpret_cast<T*>(all.data), all.count};
  }

 private:
  enum class Kind : std::uint8_t { Float, Signed, Unsigned, Other };

  void check(Kind kind, std::size_t size, int components) const;
  void check_packed(std::size_t row, std::size_t alignment) const;
  [[nodiscard]] Kind kind() const;

  Py_buffer view_{};
  const char* name_ = "";
  bool given_ = false;
};

}  // namespace pierce::python
