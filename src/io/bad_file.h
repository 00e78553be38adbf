// SPDX-License-Identifier: Apache-2.0
//
// The errors of all readers and writers: one line that names the file and the place in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "pierce/error.h"

namespace pierce::io {

/// Throws Error (BadFile): "name: message". `index`: see Error.
[[noreturn]] void bad_file(std::string_view name, std::string_view message,
                           std::uint64_t index = Error::kNoIndex);

/// "name:line: message"; lines count from 1. The line is the error's index.
[[noreturn]] void bad_line(std::string_view name, std::uint64_t line, std::string_view message);

/// "name: byte 123: message"; bytes count from 0. The byte is the error's index.
[[noreturn]] void bad_byte(std::string_view name, std::uint64_t byte, std::string_view message);

/// "there is 1", "there are 2".
[[nodiscard]] std::string there_are(std::uint64_t count);

/// A piece of a file made fit for a message: quoted, one line, no control characters, not long.
[[nodiscard]] std::string in_quotes(std::string_view text, std::size_t longest = 40);

}  // namespace pierce::io
