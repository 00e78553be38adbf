// SPDX-License-Identifier: Apache-2.0
#include "io/base64.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace pierce::io {
namespace {

constexpr std::int8_t kBad = -1, kBlank = -2;

// 0 to 63, kBad or kBlank. The second alphabet, of addresses, is as good.
constexpr std::array<std::int8_t, 256> kDigitOf = [] {
  std::array<std::int8_t, 256> digits{};
  digits.fill(kBad);
  std::int8_t next = 0;
  const auto add = [&](char first, char last) {
    for (char c = first; c <= last; ++c) digits[static_cast<std::size_t>(c)] = next++;
  };
  add('A', 'Z');
  add('a', 'z');
  add('0', '9');
  digits['+'] = digits['-'] = 62;
  digits['/'] = digits['_'] = 63;
  for (const char c : {' ', '\t', '\r', '\n'}) digits[static_cast<std::size_t>(c)] = kBlank;
  return digits;
}();

std::int32_t digit(char c) { return kDigitOf[static_cast<unsigned char>(c)]; }

}  // namespace

std::optional<std::string> decode_base64(std::string_view text) {
  const auto trim = [&] {
    while (!text.empty() && digit(text.back()) == kBlank) text.remove_suffix(1);
  };
  trim();
  for (int i = 0; i < 2 && text.ends_with('='); ++i) {
    text.remove_suffix(1);
    trim();
  }
  std::string bytes(text.size() / 4 * 3 + 3, '\0');
  char* out = bytes.data();
  std::uint32_t block = 0;
  unsigned bits = 0;
  std::size_t digits = 0;
  for (std::size_t i = 0; i < text.size();) {
    if (bits == 0 && text.size() - i >= 4) {
      const std::int32_t a = digit(text[i]), b = digit(text[i + 1]), c = digit(text[i + 2]),
                         d = digit(text[i + 3]);
      if ((a | b | c | d) >= 0) {
        const std::int32_t three = a << 18 | b << 12 | c << 6 | d;
        *out++ = static_cast<char>(three >> 16);
        *out++ = static_cast<char>(three >> 8 & 255);
        *out++ = static_cast<char>(three & 255);
        i += 4;
        continue;
      }
    }
    const std::int32_t value = digit(text[i++]);
    if (value == kBlank) continue;  // lines may be broken
    if (value == kBad) return std::nullopt;
    ++digits;
    block = block << 6 | static_cast<std::uint32_t>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    *out++ = static_cast<char>(block >> bits & 255);
  }
  if (digits % 4 == 1) return std::nullopt;
  bytes.resize(static_cast<std::size_t>(out - bytes.data()));
  return bytes;
}

}  // namespace pierce::io
