// SPDX-License-Identifier: Apache-2.0
//
// Pictures out: 8-bit RGB or RGBA PNG by stb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace pierce::io {

/// `pixels` holds width x height of 3 bytes, or of 4, the last of which is how much of it there is,
/// the top row first. The file appears under its name only when it is complete; failure throws
/// Error (BadFile).
void write_png(const std::filesystem::path& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> pixels, unsigned channels = 3);

}  // namespace pierce::io
