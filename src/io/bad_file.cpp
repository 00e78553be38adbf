// SPDX-License-Identifier: Apache-2.0
#include "io/bad_file.h"

#include <fmt/format.h>

#include "pierce/error.h"

namespace pierce::io {

void bad_file(std::string_view name, std::string_view message) {
  throw Error(ErrorCode::BadFile, fmt::format("{}: {}", name, message));
}

void bad_line(std::string_view name, std::uint64_t line, std::string_view message) {
  throw Error(ErrorCode::BadFile, fmt::format("{}:{}: {}", name, line, message));
}

void bad_byte(std::string_view name, std::uint64_t byte, std::string_view message) {
  throw Error(ErrorCode::BadFile, fmt::format("{}: byte {}: {}", name, byte, message));
}

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
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
