// SPDX-License-Identifier: Apache-2.0
//
// What the name of a file says about its format.
#pragma once

#include <filesystem>
#include <string_view>

#include "io/text_cursor.h"

namespace pierce::io {

/// Whether the name ends in the extension (".npy"), in whatever case: X.NPY is no other format.
[[nodiscard]] inline bool has_extension(const std::filesystem::path& path,
                                        std::string_view extension) {
  return same_word(path.extension().string(), extension);
}

}  // namespace pierce::io
