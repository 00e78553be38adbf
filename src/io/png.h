// SPDX-License-Identifier: Apache-2.0
//
// Pictures out: 8-bit RGB PNG by stb.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace pierce::io {

/// `rgb` holds width x height pixels of 3 bytes, the top row first. The file appears under its name
/// only when it is complete; failure throws Error (BadFile).
void write_png(const std::filesystem::path& path, unsigned width, unsigned height,
               std::span<const std::uint8_t> rgb);

}  // namespace pierce::io
