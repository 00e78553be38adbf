// SPDX-License-Identifier: Apache-2.0
//
// Just enough JSON: objects, arrays, strings, numbers; commas and indentation are its business.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pierce::bench {

class JsonWriter {
 public:
  void open_object(std::string_view key = {}) { open(key, '{'); }
  void open_array(std::string_view key = {}) { open(key, '['); }
  void close_object() { close('}'); }
  void close_array() { close(']'); }

  void value(std::string_view key, std::string_view text) {
    begin(key);
    out_ += quoted(text);
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void value(std::string_view key, Number number) {
    begin(key);
    out_ += to_text(number);
  }
  void values(std::string_view key, const std::vector<double>& numbers) {
    begin(key);
    out_ += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out_.append(i == 0 ? "" : ", ").append(to_text(numbers[i]));
    out_ += ']';
  }

  [[nodiscard]] std::string text() const { return out_ + "\n"; }

 private:
  // Infinities and NaN are no JSON; a measurement that is one is missing.
  template <class Number>
  static std::string to_text(Number number) {
    if constexpr (std::is_floating_point_v<Number>) {
      if (!std::isfinite(number)) return "null";
      return fmt::format("{:.6g}", number);
    } else {
      return fmt::format("{}", number);
    }
  }

  static std::string quoted(std::string_view text) {
    std::string out(1, '"');
    for (const char c : text) {
      if (c == '"' || c == '\\') out += '\\';
      if (static_cast<unsigned char>(c) < 0x20) {
        out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
      } else {
        out += c;
      }
    }
    out += '"';
    return out;
  }

  void new_line() { out_.append(1, '\n').append(depth_ * 2, ' '); }
  void begin(std::string_view key) {
    if (!first_) out_ += ',';
    if (!out_.empty()) new_line();
    first_ = false;
    if (!key.empty()) out_.append(quoted(key)).append(": ");
  }
  void open(std::string_view key, char bracket) {
    begin(key);
    out_ += bracket;
    ++depth_;
    first_ = true;
  }
  void close(char bracket) {
    --depth_;
    if (!first_) new_line();
    out_ += bracket;
    first_ = false;
  }

  std::string out_;
  std::size_t depth_ = 0;
  bool first_ = true;
};

}  // namespace pierce::bench
