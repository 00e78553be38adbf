// SPDX-License-Identifier: Apache-2.0
//
// The one exception of the library.
#pragma once

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

namespace pierce {

/// What kind of thing went wrong; the text of the Error says where and what to do.
enum class ErrorCode {
  NonFiniteVertex,   ///< a vertex that some triangle uses has a NaN or an infinity, or would have
                     ///< one where its instance places it
  IndexOutOfRange,   ///< a triangle names a vertex that does not exist
  TooManyTriangles,  ///< 2^32 - 1 triangles or more in one scene
  InvalidRay,        ///< a NaN or infinity in origin or direction, a zero direction, a NaN range
  InvalidPoint,      ///< a NaN or an infinity in a query point
  SizeMismatch,      ///< two spans that must have the same length do not
  InvalidArgument,   ///< any other argument outside its documented range
  NotClosed,         ///< the query needs a closed mesh and this one is not
  UnknownKernel,     ///< PIERCE_KERNEL names a kernel that does not exist or cannot run here
  Stopped,           ///< the caller asked to stop
  BadFile,           ///< a file that cannot be read or written, or does not hold what it should
};

/// "NonFiniteVertex" and so on: the name of a code as it stands above.
[[nodiscard, gnu::visibility("default")]] const char* name_of(ErrorCode code) noexcept;

/// Thrown by whatever can fail; `what()` is one line that names the first offender, how many there
/// are, and the cure.
class [[gnu::visibility("default")]] Error : public std::runtime_error {
 public:
  /// Where there is no offender that has a number.
  static constexpr std::uint64_t kNoIndex = std::numeric_limits<std::uint64_t>::max();

  Error(ErrorCode code, const std::string& message, std::uint64_t index = kNoIndex,
        std::uint64_t count = 1)
      : std::runtime_error(message), code_(code), index_(index), count_(count) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  /// The number by which what() names the first offender: of a ray in its batch, a triangle in its
  /// mesh (of an edge, its first triangle), a row, line or byte of its file; kNoIndex if by none.
  [[nodiscard]] std::uint64_t index() const noexcept { return index_; }
  /// How many offenders there are, as far as they were looked for; at least 1.
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }

 private:
  ErrorCode code_;
  std::uint64_t index_, count_;
};

}  // namespace pierce
