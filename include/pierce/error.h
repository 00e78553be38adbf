// SPDX-License-Identifier: Apache-2.0
//
// The one exception of the library.
#pragma once

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

/// Thrown by whatever can fail; `what()` is one line that names the first offender, how many there
/// are, and the cure.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace pierce
