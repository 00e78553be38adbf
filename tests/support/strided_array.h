// SPDX-License-Identifier: Apache-2.0
//
// Arrays in every layout that NumPy knows: packed, padded, reversed, Fortran, spread, unaligned.
// What lies between the numbers is guarded.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "pierce/arrays.h"
#include "support/rng.h"

namespace pierce::hard {

enum class Layout { Packed, Padded, Reversed, Fortran, Spread, Unaligned, Mixed };
inline constexpr Layout kLayouts[] = {Layout::Packed,  Layout::Padded, Layout::Reversed,
                                      Layout::Fortran, Layout::Spread, Layout::Unaligned,
                                      Layout::Mixed};

/// `count` rows of `width` numbers.
template <class T>
class StridedArray {
 public:
  StridedArray(Rng& rng, Layout layout, std::size_t count, std::size_t width)
      : count_(count), width_(width) {
    const auto size = static_cast<std::ptrdiff_t>(sizeof(T));
    const auto rows = static_cast<std::ptrdiff_t>(count),
               columns = static_cast<std::ptrdiff_t>(width);
    const bool mixed = layout == Layout::Mixed;
    const std::ptrdiff_t unit = layout == Layout::Unaligned || mixed ? size + 1 : size;
    step_ = size;
    if (layout == Layout::Spread || mixed) step_ = unit * rng.between(1, 3);
    stride_ = columns * step_;
    if (layout == Layout::Padded || mixed) stride_ += unit * rng.between(1, 5);
    if (layout == Layout::Unaligned) stride_ += 1;
    if (layout == Layout::Fortran || (mixed && rng.coin())) {
      stride_ = unit;
      step_ = rows * unit + size * rng.between(0, 2);
    }
    if (layout == Layout::Reversed || (mixed && rng.coin())) stride_ = -stride_;
    if (mixed && rng.coin()) step_ = -step_;
    std::ptrdiff_t low = 0, high = 0;
    for (const std::ptrdiff_t reach : {(rows - 1) * stride_, (columns - 1) * step_}) {
      (reach < 0 ? low : high) += count == 0 ? 0 : reach;
    }
    constexpr std::ptrdiff_t kMargin = 64;
    bytes_.assign(static_cast<std::size_t>(high - low + size + 2 * kMargin), kGuard);
    first_ = kMargin - low + (layout == Layout::Unaligned ? 1 : 0);
  }

  [[nodiscard]] Rows<T> rows(std::size_t component = 0) {
    return {reinterpret_cast<T*>(bytes_.data() + first_ +
                                 static_cast<std::ptrdiff_t>(component) * step_),
            count_, stride_, step_};
  }
  [[nodiscard]] T get(std::size_t row, std::size_t component = 0) const {
    T value;
    std::memcpy(&value, bytes_.data() + place(row, component), sizeof value);
    return value;
  }
  void set(std::size_t row, std::size_t component, T value) {
    std::memcpy(bytes_.data() + place(row, component), &value, sizeof value);
  }
  /// Whether nothing was written beside the numbers.
  [[nodiscard]] bool guards_stand() const {
    std::vector<unsigned char> rest = bytes_;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < width_; ++j) {
        std::memset(rest.data() + place(i, j), kGuard, sizeof(T));
      }
    }
    return rest == std::vector<unsigned char>(bytes_.size(), kGuard);
  }

 private:
  static constexpr unsigned char kGuard = 0xa5;
  [[nodiscard]] std::ptrdiff_t place(std::size_t row, std::size_t component) const {
    return first_ + static_cast<std::ptrdiff_t>(row) * stride_ +
           static_cast<std::ptrdiff_t>(component) * step_;
  }

  std::size_t count_, width_;
  std::ptrdiff_t stride_ = 0, step_ = 0, first_ = 0;
  std::vector<unsigned char> bytes_;
};

}  // namespace pierce::hard
