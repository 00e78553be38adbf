// SPDX-License-Identifier: Apache-2.0
//
// The lines and fields of tables in text, in the ways that programs write them.
#pragma once

#include <string_view>
#include <vector>

namespace pierce::io {

/// Without any of the characters `what` at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view what);

/// Takes the first line off `text`, without its end: LF, CR LF or CR.
[[nodiscard]] std::string_view take_line(std::string_view& text);

/// What stands between fields: ',' ';' a tab, or ' ' for any run of white space.
/// Fields come without white space around them; those in quotes may hold separators and keep their
/// quotes.
void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields);

/// One number: quotes around it do not matter, and where a comma cannot be a separator it may be
/// the decimal sign. Tells which sign it had: ',' '.' or NUL. False if it is no number.
struct FieldNumber {
  double value = 0;
  char decimal = '\0';
};
[[nodiscard]] bool parse_field(std::string_view field, char separator, FieldNumber& number);

}  // namespace pierce::io
