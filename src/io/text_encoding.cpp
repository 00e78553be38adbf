// SPDX-License-Identifier: Apache-2.0
#include "io/text_encoding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace pierce::io {
namespace {

void append_utf8(std::uint32_t code, std::string& out) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xc0 | code >> 6);
    put(0x80 | (code & 0x3f));
  } else {
    if (code < 0x10000) {
      put(0xe0 | code >> 12);
    } else {
      put(0xf0 | code >> 18);
      put(0x80 | (code >> 12 & 0x3f));
    }
    put(0x80 | (code >> 6 & 0x3f));
    put(0x80 | (code & 0x3f));
  }
}

}  // namespace

std::string_view without_padding(std::string_view text) {
  using namespace std::string_view_literals;
  const std::size_t last = text.find_last_not_of("\0\x1a \t\r\n"sv);
  if (last == text.npos) return text;
  const std::size_t padding = text.find_first_of("\0\x1a"sv, last);
  if (padding == text.npos || text.substr(0, last).find('\0') != text.npos) return text;
  const std::string_view start = text.substr(0, std::min<std::size_t>(last, 512));
  const bool is_text = std::none_of(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 9 || (c > 13 && c < 32);
  });
  return is_text ? text.substr(0, padding) : text;
}

std::optional<std::string> from_utf16(std::string_view bytes) {
  using namespace std::string_view_literals;
  const bool marked = bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff");
  const bool little = bytes.starts_with("\xff\xfe") || bytes.starts_with("<\0?\0"sv);
  const bool big = bytes.starts_with("\xfe\xff") || bytes.starts_with("\0<\0?"sv);
  if ((!little && !big) || bytes.size() % 2 != 0) return std::nullopt;
  const auto unit = [&](std::size_t at) {
    const std::uint32_t first = static_cast<unsigned char>(bytes[at]);
    const std::uint32_t second = static_cast<unsigned char>(bytes[at + 1]);
    return little ? second << 8 | first : first << 8 | second;
  };
  std::string out;
  out.reserve(bytes.size() / 2);
  for (std::size_t at = marked ? 2 : 0; at < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (code >= 0xd800 && code < 0xe000) {
      const std::uint32_t next = code < 0xdc00 && at + 3 < bytes.size() ? unit(at + 2) : 0;
      if (next < 0xdc00 || next >= 0xe000) return std::nullopt;
      code = 0x10000 + ((code - 0xd800) << 10) + (next - 0xdc00);
      at += 2;
    }
    append_utf8(code, out);
  }
  return out;
}

bool is_utf32(std::string_view bytes) {
  using namespace std::string_view_literals;
  return bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv);
}

}  // namespace pierce::io
