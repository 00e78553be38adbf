// SPDX-License-Identifier: Apache-2.0
//
// TextCursor: walks through a text file word by word. Numbers are read to the nearest double, or
// float (fast_float), whatever their length; errors name the line, which is counted only then.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pierce::io {

struct TextRules {
  char comment = '\0';        ///< starts a comment that runs to the end of the line
  bool continuation = false;  ///< a backslash at the end of a line joins the next one to it
};

/// Lines end with LF, CR LF or CR. "Blanks" are the white space inside a line, "space" is any.
class TextCursor {
 public:
  TextCursor(std::string_view text, std::string name, TextRules rules = {})
      : begin_(text.data()),
        at_(begin_),
        mark_(begin_),
        end_(begin_ + text.size()),
        name_(std::move(name)),
        rules_(rules) {}

  void skip_blanks();
  /// Also skips line ends and comments.
  void skip_space();
  /// Goes to the start of the next line.
  void skip_line();

  [[nodiscard]] bool at_end() const { return at_ == end_; }
  /// At a line end, at a comment, or at the end of the text. Call skip_blanks first.
  [[nodiscard]] bool at_line_end() const;

  [[nodiscard]] bool at_word_end() const { return ends_word(at_); }

  /// The next word of this line; empty at its end.
  [[nodiscard]] std::string_view word();

  /// The next number of this line; anything else fails, "expected `what`, found ...".
  double number(const char* what);
  /// The same to the nearest float, rounded once; for numbers that the file declares to be floats.
  float float_number(const char* what);
  std::int64_t integer(const char* what);

  /// The character at the cursor, NUL at the end; and a step over it.
  [[nodiscard]] char peek() const { return at_ == end_ ? '\0' : *at_; }
  void step() { ++at_; }
  /// Over `count` characters at once.
  void advance(std::size_t count) { at_ = mark_ = at_ + count; }

  /// Reads digits with an optional sign right here, and stops behind them (for "3/7/-1").
  std::int64_t integer_here(const char* what);

  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  [[nodiscard]] const char* position() const { return at_; }

  /// Throws Error (BadFile) with the line of the last word or number that was looked at.
  [[noreturn]] void fail(std::string_view message) const { fail_at(mark_, message); }
  [[noreturn]] void fail_at(const char* position, std::string_view message) const;

 private:
  template <class Real>
  Real read_number(const char* what, const char* too_large);
  [[nodiscard]] bool ends_word(const char* p) const;
  [[noreturn]] void fail_expected(const char* what);

  const char* begin_;
  const char* at_;
  const char* mark_;  ///< where the last word or number starts
  const char* end_;
  std::string name_;
  TextRules rules_;
};

/// The nearest double to the whole of `text` ("nan" and "inf" are numbers, "1e400" is not: it fits
/// no double). False if it is not a number.
[[nodiscard]] bool parse_number(std::string_view text, double& value);

/// What to do about a word that is no number: known mistakes have cures of their own.
[[nodiscard]] const char* number_cure(std::string_view word);

/// The whole of `text` as an integer. False if it is none, or too large.
[[nodiscard]] bool parse_integer(std::string_view text, std::int64_t& value);

/// Equal but for the case of ASCII letters.
[[nodiscard]] bool same_word(std::string_view a, std::string_view b);

}  // namespace pierce::io
