// SPDX-License-Identifier: Apache-2.0
//
// Room for objects on the stack that are written before they are read: an array of them would be
// filled first, which for a block of rays costs more than to answer a few.
#pragma once

#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

namespace pierce {

template <class T, std::size_t N>
class Room {
 public:
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

  Room() {}  // NOLINT: nothing is filled

  [[nodiscard]] T* data() { return std::launder(reinterpret_cast<T*>(bytes_)); }
  [[nodiscard]] std::span<T> first(std::size_t count) { return {data(), count}; }

 private:
  alignas(T) std::byte bytes_[N * sizeof(T)];
};

}  // namespace pierce
