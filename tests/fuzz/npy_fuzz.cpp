// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a .npy header: fields that lie inside the element, a size that 64 bits can count,
// or Error with one line.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/npy.h"
#include "pierce/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const pierce::io::NpyHeader header = pierce::io::parse_npy_header(bytes, "a.npy");
    require(header.data_offset <= size);
    require(header.data_offset == pierce::io::npy_header_bytes(bytes.substr(0, 12)));
    for (const pierce::io::NpyField& field : header.fields) {
      require(field.offset + field.bytes * field.repeat <= header.element_bytes);
    }
    (void)header.count();
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
