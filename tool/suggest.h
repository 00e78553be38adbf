// SPDX-License-Identifier: Apache-2.0
//
// "Did you mean": the known word nearest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pierce::tool {

/// The word fewest edits away (insert, delete, replace, swap neighbours), or the first that begins
/// so; empty if none is near for a word of that length. Dashes in front do not count.
[[nodiscard]] std::string nearest_word(std::string_view typed, std::span<const std::string> words);

}  // namespace pierce::tool
