// SPDX-License-Identifier: Apache-2.0
//
// The errors of all readers and writers: one line that names the file and the place in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace pierce::io {

/// Throws Error (BadFile): "name: message".
[[noreturn]] void bad_file(std::string_view name, std::string_view message);

/// "name:line: message"; lines count from 1.
[[noreturn]] void bad_line(std::string_view name, std::uint64_t line, std::string_view message);

/// "name: byte 123: message"; bytes count from 0.
[[noreturn]] void bad_byte(std::string_view name, std::uint64_t byte, std::string_view message);

/// "1 vertex", "2 vertices".
[[nodiscard]] std::string counted(std::uint64_t count, const char* one, const char* many);

/// "there is 1", "there are 2".
[[nodiscard]] std::string there_are(std::uint64_t count);

/// A piece of a file made fit for a message: quoted, one line, no control characters, not long.
[[nodiscard]] std::string in_quotes(std::string_view text, std::size_t longest = 40);

}  // namespace pierce::io
