// SPDX-License-Identifier: Apache-2.0
#include "io/text_cursor.h"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "io/bad_file.h"

namespace pierce::io {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

struct Parsed {
  const char* end;  // nullptr: not a number
  bool too_large;
};

// fast_float takes no plus sign, gives infinity for what is too large, and takes words for NaN and
// infinity; only the words may give an infinity.
template <class Real>
Parsed parse_prefix(const char* first, const char* last, Real& value) {
  const char* start = first;
  if (start != last && *start == '+') {
    ++start;
    if (start != last && *start == '-') return {nullptr, false};
  }
  const fast_float::from_chars_result result = fast_float::from_chars(start, last, value);
  if (result.ec == std::errc::invalid_argument) return {nullptr, false};
  const char* const digits = *start == '-' ? start + 1 : start;
  const bool is_word = *digits == 'i' || *digits == 'I';
  return {result.ptr, std::isinf(value) && !is_word};
}

}  // namespace

bool TextCursor::ends_word(const char* p) const {
  return p == end_ || is_blank(*p) || is_line_end(*p) ||
         (rules_.comment != '\0' && *p == rules_.comment) ||
         (rules_.continuation && *p == '\\' && p + 1 != end_ && is_line_end(p[1]));
}

void TextCursor::skip_blanks() {
  while (true) {
    while (at_ != end_ && is_blank(*at_)) ++at_;
    if (!rules_.continuation || at_ == end_ || *at_ != '\\') return;
    const char* next = at_ + 1;
    if (next == end_ || !is_line_end(*next)) return;
    at_ = next + (*next == '\r' && next + 1 != end_ && next[1] == '\n' ? 2 : 1);
  }
}

void TextCursor::skip_space() {
  while (true) {
    skip_blanks();
    if (at_end() || !at_line_end()) return;
    skip_line();
  }
}

void TextCursor::skip_line() {
  while (at_ != end_ && !is_line_end(*at_)) ++at_;
  if (at_ == end_) return;
  at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
}

bool TextCursor::at_line_end() const {
  return at_ == end_ || is_line_end(*at_) || (rules_.comment != '\0' && *at_ == rules_.comment);
}

std::string_view TextCursor::word() {
  skip_blanks();
  mark_ = at_;
  while (!ends_word(at_)) ++at_;
  return {mark_, static_cast<std::size_t>(at_ - mark_)};
}

template <class Real>
Real TextCursor::read_number(const char* what, const char* too_large) {
  skip_blanks();
  mark_ = at_;
  Real value = 0;
  const Parsed parsed = parse_prefix(at_, end_, value);
  if (parsed.end == nullptr || !ends_word(parsed.end)) fail_expected(what);
  if (parsed.too_large) fail(fmt::format("{} {}", in_quotes(word()), too_large));
  at_ = parsed.end;
  return value;
}

double TextCursor::number(const char* what) {
  return read_number<double>(what, "does not fit a double: scale the data");
}

float TextCursor::float_number(const char* what) {
  return read_number<float>(what,
                            "does not fit a float, as which it is declared: declare a double");
}

std::int64_t TextCursor::integer_here(const char* what) {
  mark_ = at_;
  const char* const start = at_ != end_ && *at_ == '+' ? at_ + 1 : at_;
  std::int64_t value = 0;
  const std::from_chars_result result = std::from_chars(start, end_, value);
  if (result.ec != std::errc() || (start != at_ && value < 0)) fail_expected(what);
  at_ = result.ptr;
  return value;
}

std::int64_t TextCursor::integer(const char* what) {
  skip_blanks();
  const char* const start = at_;
  const std::int64_t value = integer_here(what);
  if (!ends_word(at_)) {
    at_ = mark_ = start;
    fail_expected(what);
  }
  return value;
}

void TextCursor::fail_expected(const char* what) {
  if (at_end()) {
    fail(fmt::format("expected {}, found the end of the file: it was cut off, get it again", what));
  }
  if (at_line_end()) {
    fail(fmt::format("expected {}, found the end of the line: complete the line", what));
  }
  const std::string_view found = word();
  fail(fmt::format("expected {}, found {}: {}", what, in_quotes(found), number_cure(found)));
}

void TextCursor::fail_at(const char* position, std::string_view message) const {
  std::uint64_t line = 1;
  for (const char* p = begin_; p != position; ++p) {
    if (*p == '\n' || (*p == '\r' && (p + 1 == end_ || p[1] != '\n'))) ++line;
  }
  bad_line(name_, line, message);
}

bool parse_number(std::string_view text, double& value) {
  const char* const last = text.data() + text.size();
  const Parsed parsed = parse_prefix(text.data(), last, value);
  return parsed.end == last && !parsed.too_large && !text.empty();
}

const char* number_cure(std::string_view word) {
  const auto parses_with = [&](std::string_view wrong, char right) {
    std::string other(word);
    const std::size_t at = other.find_first_of(wrong);
    if (at == other.npos) return false;
    other[at] = right;
    double value = 0;
    return parse_number(other, value);
  };
  double value = 0;
  const bool comma_behind = word.ends_with(',');
  if (comma_behind && parse_number(word.substr(0, word.size() - 1), value))
    return "put blanks between numbers, no commas";
  if (parses_with(",", '.')) return "write it with a decimal point";
  if (parses_with("dD", 'e')) return "write its exponent with E";
  return "correct it";
}

bool parse_integer(std::string_view text, std::int64_t& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const char* const last = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), last, value);
  return result.ec == std::errc() && result.ptr == last;
}

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace pierce::io
