// SPDX-License-Identifier: Apache-2.0
//
// The few Python literals that a .npy header is made of: strings, True and False, tuples of whole
// numbers, and the brackets between them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

class PythonLiteral {
 public:
  PythonLiteral(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}

  /// The next character that is no white space; NUL at the end.
  [[nodiscard]] char peek();
  /// Steps over `c` if it comes next.
  bool take(char c);
  void expect(char c);
  std::string string();
  bool boolean();
  std::vector<std::uint64_t> tuple();

  [[noreturn]] void fail(std::string_view message) const;

 private:
  std::string_view text_;
  std::string name_;
  std::size_t at_ = 0;
};

}  // namespace pierce::io
