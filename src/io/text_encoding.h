// SPDX-License-Identifier: Apache-2.0
//
// Text that is not plain UTF-8: marks at its beginning, and two bytes a character.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pierce::io {

/// Without the mark of UTF-8, if it begins with it.
[[nodiscard]] inline std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  return text.substr(text.starts_with(kMark) ? kMark.size() : 0);
}

/// Without what some programs put behind the end of a text, or leave there: NULs, and the mark at
/// which DOS ended files. What is no text (NULs elsewhere, control characters) comes back whole.
[[nodiscard]] std::string_view without_padding(std::string_view text);

/// UTF-16 (which begins with a mark, of either byte order, or is XML) as UTF-8; nothing if it is
/// none.
[[nodiscard]] std::optional<std::string> from_utf16(std::string_view bytes);

/// Four bytes a character, by its mark.
[[nodiscard]] bool is_utf32(std::string_view bytes);

}  // namespace pierce::io
