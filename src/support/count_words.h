// SPDX-License-Identifier: Apache-2.0
//
// Counts in words, as messages and answers say them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace pierce {

/// "1,234,567".
[[nodiscard]] inline std::string grouped(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

/// "1 vertex", "1,234 vertices".
[[nodiscard]] inline std::string counted(std::uint64_t count, const char* one, const char* many) {
  return grouped(count) + " " + (count == 1 ? one : many);
}

/// "once", "2 times".
[[nodiscard]] inline std::string times(std::uint64_t count) {
  return count == 1 ? "once" : grouped(count) + " times";
}

}  // namespace pierce
