// SPDX-License-Identifier: Apache-2.0
#include "io/csv_fields.h"

#include <algorithm>
#include <string>

#include "io/text_cursor.h"

namespace pierce::io {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";
constexpr std::string_view kQuotes = "\"'";

void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields) {
  while (true) {
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == line.npos) return;
    line.remove_prefix(first);
    const bool quoted = line[0] == '"' && line.find('"', 1) != line.npos;
    const std::size_t end = quoted ? line.find('"', 1) + 1 : line.find_first_of(kBlanks);
    fields.push_back(line.substr(0, end));
    line.remove_prefix(std::min(end, line.size()));
  }
}

// Where the line ends. Piece by piece: a file may lack one of the two altogether.
std::size_t end_of_line(std::string_view text) {
  constexpr std::size_t kPiece = 256;
  for (std::size_t first = 0; first < text.size(); first += kPiece) {
    const std::string_view piece = text.substr(first, kPiece);
    const std::size_t end = std::min(piece.find('\n'), piece.find('\r'));
    if (end != piece.npos) return first + end;
  }
  return text.size();
}

}  // namespace

std::string_view trimmed(std::string_view text, std::string_view what) {
  const auto is_what = [what](char c) { return what.find(c) != what.npos; };
  while (!text.empty() && is_what(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_what(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = end_of_line(text);
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size()));
  return line;
}

void split_fields(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  if (separator == ' ') {
    split_at_blanks(line, fields);
    return;
  }
  if (line.find('"') == line.npos) {
    for (std::size_t at = line.find(separator); at != line.npos; at = line.find(separator)) {
      fields.push_back(trimmed(line.substr(0, at), kBlanks));
      line.remove_prefix(at + 1);
    }
    fields.push_back(trimmed(line, kBlanks));
    return;
  }
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != separator || quoted) continue;
    fields.push_back(trimmed(line.substr(start, i - start), kBlanks));
    start = i + 1;
  }
  fields.push_back(trimmed(line.substr(start), kBlanks));
}

bool parse_field(std::string_view field, char separator, FieldNumber& number) {
  number.decimal = '\0';
  if (parse_number(field, number.value)) {
    if (field.find('.') != field.npos) number.decimal = '.';
    return true;
  }
  bool comma = separator != ',';
  if (field.size() >= 2 && kQuotes.find(field[0]) != kQuotes.npos && field.back() == field[0]) {
    field = trimmed(field.substr(1, field.size() - 2), kBlanks);
    comma = true;
    if (parse_number(field, number.value)) {
      if (field.find('.') != field.npos) number.decimal = '.';
      return true;
    }
  }
  const std::size_t at = field.find(',');
  if (!comma || at == field.npos || field.find('.') != field.npos) return false;
  std::string with_point(field);
  with_point[at] = '.';
  number.decimal = ',';
  return parse_number(with_point, number.value);
}

}  // namespace pierce::io
