// SPDX-License-Identifier: Apache-2.0
//
// Rows of numbers in the caller's memory: checked once, then read and written. Numbers there may be
// unaligned: all goes by memcpy, which compilers make plain loads and stores of.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include "pierce/arrays.h"
#include "pierce/error.h"

namespace pierce::scene {

template <class T>
[[nodiscard]] bool is_aligned(const T* data) {
  return std::bit_cast<std::uintptr_t>(data) % alignof(T) == 0;
}

/// Throws Error (InvalidArgument) if there are rows but no data, or a negative number of rows.
void validate_rows(const void* data, std::size_t count, const char* name);

/// How many things a batch has, by its input arrays: one row each, or one for all.
class BatchSize {
 public:
  /// `of`: a "ray", a "point".
  explicit BatchSize(const char* of) : of_(of) {}

  template <class T>
  void need(const Rows<const T>& rows, const char* name) {
    add(rows.data, rows.count, name);
  }
  template <class T>
  void may_have(const Rows<const T>& rows, const char* name) {
    if (!rows.empty()) add(rows.data, rows.count, name);
  }
  [[nodiscard]] std::size_t get() const { return size_; }

 private:
  void add(const void* data, std::size_t count, const char* name);

  const char* of_;
  const char* name_ = nullptr;  // of the array that said
  std::size_t size_ = 1;
};

/// What is read of a batch. Without rows it must not be asked.
template <class T>
class InputRows {
 public:
  InputRows() = default;
  explicit InputRows(const Rows<const T>& rows)
      : data_(reinterpret_cast<const std::byte*>(rows.data)),
        stride_(rows.count == 1 ? 0 : rows.stride),
        step_(rows.step) {}

  [[nodiscard]] bool given() const { return data_ != nullptr; }
  [[nodiscard]] bool is_packed() const { return step_ == sizeof(T); }
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  [[nodiscard]] const std::byte* row(std::size_t i) const {
    return data_ + static_cast<std::ptrdiff_t>(i) * stride_;
  }
  /// Whether the components of a row stand right behind the three of the other's.
  [[nodiscard]] bool follows(const InputRows& other) const {
    return is_packed() && other.is_packed() && stride_ == other.stride_ &&
           data_ == other.data_ + 3 * sizeof(T);
  }

  /// Components 0 to n - 1 of `count` rows from `first` on, to out, out + stride, ...; `stride` in
  /// bytes.
  template <std::size_t n>
  void read(std::size_t first, std::size_t count, T* out, std::size_t stride) const {
    const std::byte* from = row(first);
    auto* to = reinterpret_cast<std::byte*>(out);
    if (is_packed()) {
      for (std::size_t i = 0; i < count; ++i, from += stride_, to += stride) {
        std::memcpy(to, from, n * sizeof(T));
      }
      return;
    }
    for (std::size_t i = 0; i < count; ++i, from += stride_, to += stride) {
      for (std::size_t j = 0; j < n; ++j) {
        std::memcpy(to + j * sizeof(T), from + static_cast<std::ptrdiff_t>(j) * step_, sizeof(T));
      }
    }
  }

 private:
  const std::byte* data_ = nullptr;
  std::ptrdiff_t stride_ = 0, step_ = sizeof(T);
};

/// What is written of a batch: nothing if there are no rows.
template <class T>
class OutputRows {
 public:
  OutputRows() = default;
  /// Throws Error (SizeMismatch) unless there is a row for each of the `wanted` things (`of`).
  OutputRows(const Rows<T>& rows, std::size_t wanted, const char* of, const char* name)
      : OutputRows(rows.data, rows.count, rows.stride, rows.step, wanted, of, name) {}
  OutputRows(void* data, std::size_t count, std::ptrdiff_t stride, std::ptrdiff_t step,
             std::size_t wanted, const char* of, const char* name);

  [[nodiscard]] bool wanted() const { return data_ != nullptr; }
  /// Where the rows from `first` on are, if they lie as an array does; else null.
  [[nodiscard]] T* in_place(std::size_t first) const {
    auto* data = reinterpret_cast<T*>(data_);
    return stride_ == sizeof(T) && is_aligned(data) ? data + first : nullptr;
  }
  void set(std::size_t i, const T& value) const {
    std::memcpy(data_ + static_cast<std::ptrdiff_t>(i) * stride_, &value, sizeof(T));
  }
  void set(std::size_t i, const Vec3<T>& value) const {
    std::byte* to = data_ + static_cast<std::ptrdiff_t>(i) * stride_;
    std::memcpy(to, &value.x, sizeof(T));
    std::memcpy(to + step_, &value.y, sizeof(T));
    std::memcpy(to + 2 * step_, &value.z, sizeof(T));
  }
  /// The rows from `first` on: what `value` makes of each of the items.
  template <class Item, class Value>
  void write(std::size_t first, std::span<const Item> items, const Value& value) const {
    if (!wanted()) return;
    if constexpr (std::is_same_v<std::invoke_result_t<Value, const Item&>, T>) {
      if (stride_ == sizeof(T)) {  // the compiler can do several at a time
        std::byte* to = data_ + first * sizeof(T);
        for (std::size_t i = 0; i < items.size(); ++i) {
          const T number = value(items[i]);
          std::memcpy(to + i * sizeof(T), &number, sizeof(T));
        }
        return;
      }
    }
    for (std::size_t i = 0; i < items.size(); ++i) set(first + i, value(items[i]));
  }

 private:
  std::byte* data_ = nullptr;
  std::ptrdiff_t stride_ = 0, step_ = 0;
};

/// Numbers of geometries or triangles, of which kNone is -1 where they are wide.
class OutputIds {
 public:
  OutputIds() = default;
  OutputIds(const IdRows& rows, std::size_t wanted, const char* of, const char* name);

  template <class Item, class Id>
  void write(std::size_t first, std::span<const Item> items, const Id& id) const {
    narrow_.write(first, items, id);
    wide_.write(first, items, [&](const Item& item) {
      const std::uint32_t number = id(item);
      return number == kNone ? std::int64_t{-1} : std::int64_t{number};
    });
  }

 private:
  OutputRows<std::uint32_t> narrow_;
  OutputRows<std::int64_t> wide_;
};

extern template class OutputRows<float>;
extern template class OutputRows<double>;
extern template class OutputRows<std::uint8_t>;
extern template class OutputRows<std::int8_t>;
extern template class OutputRows<std::uint32_t>;
extern template class OutputRows<std::int32_t>;
extern template class OutputRows<std::int64_t>;

}  // namespace pierce::scene
