// SPDX-License-Identifier: Apache-2.0
#include "pierce/error.h"

namespace pierce {

const char* name_of(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::NonFiniteVertex:
      return "NonFiniteVertex";
    case ErrorCode::IndexOutOfRange:
      return "IndexOutOfRange";
    case ErrorCode::TooManyTriangles:
      return "TooManyTriangles";
    case ErrorCode::InvalidRay:
      return "InvalidRay";
    case ErrorCode::InvalidPoint:
      return "InvalidPoint";
    case ErrorCode::SizeMismatch:
      return "SizeMismatch";
    case ErrorCode::InvalidArgument:
      return "InvalidArgument";
    case ErrorCode::NotClosed:
      return "NotClosed";
    case ErrorCode::UnknownKernel:
      return "UnknownKernel";
    case ErrorCode::Stopped:
      return "Stopped";
    case ErrorCode::BadFile:
      return "BadFile";
  }
  return "unknown error";
}

}  // namespace pierce
