// SPDX-License-Identifier: Apache-2.0
//
// Just enough JSON: objects, arrays, strings, numbers; commas and indentation are its business.
#pragma once

#include <concepts>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace pierce::io {

class JsonWriter {
 public:
  /// Fractions with so many digits; 0: as many as it takes to read the same number again.
  explicit JsonWriter(int digits = 0) : digits_(digits) {}

  void open_object(std::string_view key = {}) { open(key, '{'); }
  void open_array(std::string_view key = {}) { open(key, '['); }
  void close_object() { close('}'); }
  void close_array() { close(']'); }

  void value(std::string_view key, std::string_view text) {
    begin(key);
    out_ += quoted(text);
  }
  void value(std::string_view key, const char* text) { value(key, std::string_view(text)); }
  template <std::same_as<bool> Bool>
  void value(std::string_view key, Bool truth) {
    begin(key);
    out_ += truth ? "true" : "false";
  }
  template <class Number>
  requires(std::is_arithmetic_v<Number> &&
           !std::same_as<Number, bool>) void value(std::string_view key, Number number) {
    begin(key);
    out_ += to_text(number);
  }
  template <class Number>
  void values(std::string_view key, const std::vector<Number>& numbers) {
    begin(key);
    out_ += '[';
    for (std::size_t i = 0; i < numbers.size(); ++i)
      out_.append(i == 0 ? "" : ", ").append(to_text(numbers[i]));
    out_ += ']';
  }

  [[nodiscard]] std::string text() const { return out_ + "\n"; }

 private:
  template <class Number>
  [[nodiscard]] std::string to_text(Number number) const {
    if constexpr (std::is_floating_point_v<Number>) {
      return fraction(number);
    } else {
      return std::to_string(number);
    }
  }
  // Infinities and NaN are no JSON: they become null.
  [[nodiscard]] std::string fraction(float number) const;
  [[nodiscard]] std::string fraction(double number) const;

  // With its quotes. Bytes that are no UTF-8 (names of files may hold any) become U+FFFD.
  static std::string quoted(std::string_view text);

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

  int digits_;
  std::string out_;
  std::size_t depth_ = 0;
  bool first_ = true;
};

}  // namespace pierce::io
