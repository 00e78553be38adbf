// SPDX-License-Identifier: Apache-2.0
//
// Memory for arrays that are large, written once and read at random: aligned, never initialised,
// on huge pages where the system has them (10 to 20 % on incoherent rays in large scenes).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace pierce::bvh {

/// An array, mostly owned, of `size()` values of T, aligned to a cache line, or to a huge page when
/// large. What nobody has written is unspecified. Memory that is never touched is never paid for,
/// so a generous size costs address space only.
template <class T>
class HugeBuffer {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);

 public:
  HugeBuffer() = default;
  explicit HugeBuffer(std::size_t size) : data_(allocate(size)), size_(size) {}
  /// Values in memory that is not ours: it must be writable, aligned to a cache line, and outlive
  /// this.
  static HugeBuffer over(T* data, std::size_t size) {
    HugeBuffer buffer;
    buffer.data_ = Memory(data, Free{kNotOurs});
    buffer.size_ = size;
    return buffer;
  }

  HugeBuffer(HugeBuffer&& other) noexcept
      : data_(std::move(other.data_)), size_(std::exchange(other.size_, 0)) {}
  HugeBuffer& operator=(HugeBuffer&& other) noexcept {
    data_ = std::move(other.data_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] std::size_t bytes() const noexcept { return size_ * sizeof(T); }
  [[nodiscard]] T* data() noexcept { return data_.get(); }
  [[nodiscard]] const T* data() const noexcept { return data_.get(); }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }
  [[nodiscard]] T* begin() noexcept { return data(); }
  [[nodiscard]] T* end() noexcept { return data() + size_; }
  [[nodiscard]] const T* begin() const noexcept { return data(); }
  [[nodiscard]] const T* end() const noexcept { return data() + size_; }

  /// Keeps the values that fit; new ones are not initialised. Always moves to memory of just the
  /// new size.
  void resize(std::size_t size) {
    HugeBuffer other(size);
    if (const std::size_t kept = std::min(size, size_); kept != 0) {
      std::memcpy(static_cast<void*>(other.data()), data(), kept * sizeof(T));
    }
    *this = std::move(other);
  }

  /// Calls `between` now and then.
  template <class Between>
  [[nodiscard]] HugeBuffer copy(const Between& between) const {
    HugeBuffer other(size_);
    constexpr std::size_t kPiece = std::max<std::size_t>(1, (std::size_t{1} << 22) / sizeof(T));
    for (std::size_t begin = 0; begin < size_; begin += kPiece) {
      between();
      const std::size_t count = std::min(kPiece, size_ - begin);
      std::memcpy(static_cast<void*>(other.data() + begin), data() + begin, count * sizeof(T));
    }
    return other;
  }

  /// Forgets all but the first `size` values and keeps the memory where it is. (What was never
  /// touched of it costs nothing.)
  void truncate(std::size_t size) noexcept { size_ = std::min(size_, size); }

  void clear() noexcept { *this = HugeBuffer(); }

 private:
  static constexpr std::size_t kLine = std::max<std::size_t>(64, alignof(T));
  static constexpr std::size_t kHugePage = std::size_t{2} << 20;
  static_assert(kLine <= kHugePage);
  static constexpr std::size_t kNotOurs = 0;

  struct Free {
    std::size_t alignment = kLine;
    void operator()(T* memory) const noexcept {
      if (alignment == kNotOurs) return;
      ::operator delete (static_cast<void*>(memory), std::align_val_t{alignment});
    }
  };
  using Memory = std::unique_ptr<T[], Free>;

  static Memory allocate(std::size_t size) {
    if (size == 0) return {};
    if (size > std::numeric_limits<std::size_t>::max() / sizeof(T))
      throw std::bad_array_new_length();
    const std::size_t bytes = size * sizeof(T);
    const std::size_t alignment = bytes >= 2 * kHugePage ? kHugePage : kLine;
    void* memory = ::operator new (bytes, std::align_val_t{alignment});
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    // A wish: a system without huge pages says no, and that is fine.
    if (alignment == kHugePage) (void)madvise(memory, bytes, MADV_HUGEPAGE);
#endif
    return Memory(static_cast<T*>(memory), Free{alignment});
  }

  Memory data_;
  std::size_t size_ = 0;
};

}  // namespace pierce::bvh
