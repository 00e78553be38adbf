// SPDX-License-Identifier: Apache-2.0
//
// In place of gzip.cpp where zlib is not to be had.
#include "io/packed.h"

namespace pierce::io {

std::string unpack_gzip(std::string_view /*bytes*/, std::uint64_t /*limit*/, std::string& /*out*/) {
  return "this pierce was built without zlib: unpack it with gunzip";
}

}  // namespace pierce::io
