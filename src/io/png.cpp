// SPDX-License-Identifier: Apache-2.0
#include "io/png.h"

#include <fmt/format.h>

#include <limits>

#include "io/bad_file.h"
#include "io/output_file.h"
#include "pierce/error.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace pierce::io {

void write_png(const std::filesystem::path& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> pixels, unsigned channels) {
  const std::uint64_t bytes = std::uint64_t{channels} * width * height;
  if (width == 0 || height == 0 || bytes != pixels.size()) {
    throw Error(ErrorCode::SizeMismatch,
                fmt::format("a picture of {} x {} pixels has {} bytes, not {}", width, height,
                            bytes, pixels.size()));
  }
  // stb counts in int and holds the picture twice, once with a byte more per row
  if (bytes + height > std::numeric_limits<int>::max() / 2) {
    bad_file(path.string(), fmt::format("a picture of {} x {} pixels is too large: make it smaller",
                                        width, height));
  }
  // stb is C and must not be thrown through, so the bytes are collected first.
  std::string png;
  const auto collect = [](void* context, void* data, int size) {
    static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                               static_cast<std::size_t>(size));
  };
  if (stbi_write_png_to_func(collect, &png, static_cast<int>(width), static_cast<int>(height),
                             static_cast<int>(channels), pixels.data(),
                             static_cast<int>(channels * width)) == 0) {
    bad_file(path.string(), "not enough memory to pack the picture: make it smaller");
  }
  OutputFile file(path);
  file.write(png);
  file.commit();
}

}  // namespace pierce::io
