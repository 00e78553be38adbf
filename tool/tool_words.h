// SPDX-License-Identifier: Apache-2.0
//
// The library speaks to programmers; what it says reaches the tool's users in words of the command
// line.
#pragma once

#include <string>

#include "pierce/error.h"

namespace pierce::tool {

/// The message of the library, with its options named as those of the tool, and a cure that the
/// tool has. Not for messages that the name of a file was put into.
[[nodiscard]] std::string in_tool_words(const Error& error);

}  // namespace pierce::tool
