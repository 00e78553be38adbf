// SPDX-License-Identifier: Apache-2.0
//
// In place of zstd.cpp where libzstd is not to be had.
#include "io/packed.h"

namespace pierce::io {

std::string unpack_zstd(std::string_view /*bytes*/, std::uint64_t /*limit*/, std::string& /*out*/) {
  return "this pierce was built without libzstd: unpack it with unzstd";
}

}  // namespace pierce::io
