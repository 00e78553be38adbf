// SPDX-License-Identifier: Apache-2.0
#include "io/bad_file.h"

#include <fmt/format.h>

namespace pierce::io {

void bad_file(std::string_view name, std::string_view message, std::uint64_t index) {
  throw Error(ErrorCode::BadFile, fmt::format("{}: {}", name, message), index);
}

void bad_line(std::string_view name, std::uint64_t line, std::string_view message) {
  throw Error(ErrorCode::BadFile, fmt::format("{}:{}: {}", name, line, message), line);
}

void bad_byte(std::string_view name, std::uint64_t byte, std::string_view message) {
  throw Error(ErrorCode::BadFile, fmt::format("{}: byte {}: {}", name, byte, message), byte);
}

std::string there_are(std::uint64_t count) {
  return fmt::format("there {} {}", count == 1 ? "is" : "are", count);
}

std::string in_quotes(std::string_view text, std::size_t longest) {
  std::string out = "'";
  for (const char c : text.substr(0, longest)) {
    out += c >= ' ' && c <= '~' ? c : '?';
  }
  return out + (text.size() > longest ? "...'" : "'");
}

}  // namespace pierce::io
