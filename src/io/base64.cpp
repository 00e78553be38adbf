// SPDX-License-Identifier: Apache-2.0
#include "io/base64.h"

#include <cstdint>

namespace pierce::io {
namespace {

// 0 to 63, or -1. The second alphabet, of addresses, is as good.
int digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

}  // namespace

std::optional<std::string> decode_base64(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const auto trim = [&] { text = text.substr(0, text.find_last_not_of(kSpace) + 1); };
  trim();
  for (int i = 0; i < 2 && text.ends_with('='); ++i) {
    text.remove_suffix(1);
    trim();
  }
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t block = 0;
  unsigned bits = 0;
  std::size_t digits = 0;
  for (const char c : text) {
    if (kSpace.find(c) != kSpace.npos) continue;  // lines may be broken
    ++digits;
    const int value = digit(c);
    if (value < 0) return std::nullopt;
    block = block << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<char>(block >> bits & 255));
  }
  if (digits % 4 == 1) return std::nullopt;
  return bytes;
}

}  // namespace pierce::io
