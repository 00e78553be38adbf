// SPDX-License-Identifier: Apache-2.0
#include "io/python_literal.h"

#include <fmt/format.h>

#include <charconv>

#include "io/bad_file.h"

namespace pierce::io {

char PythonLiteral::peek() {
  while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != text_.npos) ++at_;
  return at_ < text_.size() ? text_[at_] : '\0';
}

bool PythonLiteral::take(char c) {
  if (peek() != c) return false;
  ++at_;
  return true;
}

void PythonLiteral::expect(char c) {
  if (!take(c)) fail(fmt::format("expected '{}', found {}", c, in_quotes(text_.substr(at_, 10))));
}

std::string PythonLiteral::string() {
  const char quote = peek();
  if (quote != '\'' && quote != '"') {
    fail(fmt::format("expected a string, found {}", in_quotes(text_.substr(at_, 10))));
  }
  std::string out;
  for (++at_; at_ < text_.size() && text_[at_] != quote; ++at_) {
    if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
    out += text_[at_];
  }
  if (at_ == text_.size()) fail("a string has no end");
  ++at_;
  return out;
}

bool PythonLiteral::boolean() {
  (void)peek();
  const std::string_view rest = text_.substr(at_);
  if (!rest.starts_with("True") && !rest.starts_with("False")) {
    fail(fmt::format("expected True or False, found {}", in_quotes(rest.substr(0, 10))));
  }
  const bool value = rest[0] == 'T';
  at_ += value ? 4 : 5;
  return value;
}

std::vector<std::uint64_t> PythonLiteral::tuple() {
  std::vector<std::uint64_t> numbers;
  expect('(');
  while (!take(')')) {
    (void)peek();
    std::uint64_t value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [rest, error] = std::from_chars(text_.data() + at_, end, value);
    if (error != std::errc()) {
      fail(fmt::format("expected a count, found {}", in_quotes(text_.substr(at_, 10))));
    }
    at_ += static_cast<std::size_t>(rest - (text_.data() + at_));
    (void)take('L');  // NumPy under Python 2 wrote 3L
    numbers.push_back(value);
    if (!take(',')) {
      expect(')');
      break;
    }
  }
  return numbers;
}

void PythonLiteral::fail(std::string_view message) const {
  bad_file(name_,
           fmt::format("bad .npy header: {}: write the file again with numpy.save", message));
}

}  // namespace pierce::io
