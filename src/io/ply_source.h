// SPDX-License-Identifier: Apache-2.0
//
// Where the numbers of a PLY body come from: text, or binary of either byte order. Both answer the
// same questions, so that the reader of elements is written once, over either.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/bad_file.h"
#include "io/ply_header.h"
#include "io/text_cursor.h"

namespace pierce::io {

class PlyAsciiSource {
 public:
  /// Free form: rows end anywhere, else with their lines.
  PlyAsciiSource(std::string_view bytes, std::size_t start, const std::string& name, bool free_form)
      : text_(bytes, name), free_form_(free_form) {
    text_.advance(start);
  }

  [[nodiscard]] bool free_form() const { return free_form_; }
  /// Behind the last number of a row. A number too many or too few, or a wrong count in the header,
  /// must not go on as if it were the next row.
  void end_row() {
    if (free_form_) return;
    text_.skip_blanks();
    if (text_.at_line_end()) return;
    const std::string_view word = text_.word();
    text_.fail(fmt::format(
        "{} is more than the header announces for a row: correct its counts or properties, or "
        "begin a line for each row",
        in_quotes(word)));
  }

  // What is declared a float is one: it is read to the nearest float, as any reader with floats
  // does.
  double scalar(PlyType type) {
    skip_space();
    if (type == PlyType::Float32) return static_cast<double>(text_.float_number("a number"));
    return text_.number("a number");
  }
  /// What decides nothing; NaN for what is no number.
  double attribute(PlyType) {
    skip_space();
    double value = 0;
    const std::string_view word = text_.word();
    if (word.empty()) text_.fail("the file ends too early: it was cut off");
    return parse_number(word, value) ? value : std::numeric_limits<double>::quiet_NaN();
  }
  std::int64_t integer(PlyType) {
    skip_space();
    return text_.integer("a whole number");
  }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
      skip_space();
      if (text_.word().empty()) text_.fail("the file ends too early: it was cut off");
    }
  }
  [[nodiscard]] std::uint64_t remaining() {
    skip_space();
    return text_.remaining();
  }
  /// What follows the last element and should not.
  [[nodiscard]] std::string_view leftover() {
    const std::uint64_t bytes = remaining();
    text_.advance(0);  // so that a failure names its line
    return {text_.position(), bytes};
  }
  [[noreturn]] void fail(const std::string& message) const { text_.fail(message); }

 private:
  // Some writers go on with comments behind the header.
  void skip_space() {
    for (text_.skip_space(); text_.peek() == 'c' || text_.peek() == 'C'; text_.skip_space()) {
      TextCursor ahead = text_;
      if (!same_word(ahead.word(), "comment")) return;
      text_.skip_line();
    }
  }

  TextCursor text_;
  bool free_form_;
};

template <std::endian kOrder>
class PlyBinarySource {
 public:
  PlyBinarySource(std::string_view bytes, std::size_t start, const std::string& name)
      : bytes_(bytes), at_(start), mark_(start), name_(name) {}

  [[nodiscard]] static constexpr bool free_form() { return false; }
  void end_row() const {}

  double scalar(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return take<std::int8_t>();
      case PlyType::Uint8:
        return take<std::uint8_t>();
      case PlyType::Int16:
        return take<std::int16_t>();
      case PlyType::Uint16:
        return take<std::uint16_t>();
      case PlyType::Int32:
        return take<std::int32_t>();
      case PlyType::Uint32:
        return take<std::uint32_t>();
      case PlyType::Int64:
        return static_cast<double>(take<std::int64_t>());
      case PlyType::Uint64:
        return static_cast<double>(take<std::uint64_t>());
      case PlyType::Float32:
        return static_cast<double>(take<float>());
      default:
        return take<double>();
    }
  }
  double attribute(PlyType type) { return scalar(type); }
  // Lists of floats exist; their indices must be whole.
  std::int64_t integer(PlyType type) {
    if (type == PlyType::Int32) return take<std::int32_t>();
    const double value = scalar(type);
    constexpr double kLargest = 4294967296.0;
    if (!(std::abs(value) <= kLargest) || value != std::trunc(value)) {
      fail(fmt::format("expected a whole number, found {}: correct it", value));
    }
    return static_cast<std::int64_t>(value);
  }
  void skip(PlyType type, std::uint64_t count) {
    mark_ = at_;
    if (count > remaining() / ply_size(type)) fail_short();
    at_ += count * ply_size(type);
  }
  [[nodiscard]] std::uint64_t remaining() const { return bytes_.size() - at_; }
  // Some writers end the file with a line end.
  [[nodiscard]] std::string_view leftover() const {
    const std::string_view rest = bytes_.substr(at_);
    return rest == "\n" || rest == "\r\n" ? std::string_view() : rest;
  }
  [[noreturn]] void fail(const std::string& message) const { bad_byte(name_, mark_, message); }

 private:
  template <class T>
  T take() {
    mark_ = at_;
    if (remaining() < sizeof(T)) fail_short();
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if constexpr (kOrder != std::endian::native) std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    return std::bit_cast<T>(raw);
  }
  [[noreturn]] void fail_short() const { fail("the file ends too early: it was cut off"); }

  std::string_view bytes_;
  std::size_t at_;
  std::size_t mark_;  // where the last number starts
  const std::string& name_;
};

}  // namespace pierce::io
