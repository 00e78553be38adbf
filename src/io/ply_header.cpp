// SPDX-License-Identifier: Apache-2.0
#include "io/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "io/bad_file.h"
#include "io/text_cursor.h"

namespace pierce::io {
namespace {

PlyType parse_type(TextCursor& text) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 18> kNames = {{
      {"char", PlyType::Int8},
      {"int8", PlyType::Int8},
      {"uchar", PlyType::Uint8},
      {"uint8", PlyType::Uint8},
      {"short", PlyType::Int16},
      {"int16", PlyType::Int16},
      {"ushort", PlyType::Uint16},
      {"uint16", PlyType::Uint16},
      {"int", PlyType::Int32},
      {"int32", PlyType::Int32},
      {"uint", PlyType::Uint32},
      {"uint32", PlyType::Uint32},
      {"int64", PlyType::Int64},
      {"uint64", PlyType::Uint64},
      {"float", PlyType::Float32},
      {"float32", PlyType::Float32},
      {"double", PlyType::Float64},
      {"float64", PlyType::Float64},
  }};
  const std::string_view word = text.word();
  for (const auto& [type_name, type] : kNames) {
    if (same_word(word, type_name)) return type;
  }
  text.fail(
      fmt::format("{} is no PLY number type: use char, uchar, short, ushort, int, uint, "
                  "int64, uint64, float or double",
                  in_quotes(word)));
}

std::string parse_name(TextCursor& text, const char* what) {
  const std::string_view word = text.word();
  if (word.empty()) text.fail(fmt::format("the {} has no name: complete the line", what));
  return std::string(word);
}

PlyFormat parse_format(TextCursor& text) {
  const std::string_view word = text.word();
  std::optional<PlyFormat> format;
  if (same_word(word, "ascii")) format = PlyFormat::Ascii;
  if (same_word(word, "binary_little_endian")) format = PlyFormat::LittleEndian;
  if (same_word(word, "binary_big_endian")) format = PlyFormat::BigEndian;
  if (!format) {
    text.fail(
        fmt::format("unknown PLY format {}: it must be ascii, binary_little_endian or "
                    "binary_big_endian",
                    in_quotes(word)));
  }
  const std::string_view version = text.word();
  if (version != "1.0") {
    text.fail(fmt::format("unknown PLY version {}: only 1.0 exists", in_quotes(version)));
  }
  return *format;
}

void parse_element(TextCursor& text, PlyHeader& header) {
  PlyElement element;
  element.name = parse_name(text, "element");
  const bool again = std::any_of(header.elements.begin(), header.elements.end(),
                                 [&](const PlyElement& e) { return e.name == element.name; });
  if (again) text.fail(fmt::format("a second element {}: rename one", in_quotes(element.name)));
  const std::int64_t count = text.integer("the number of elements");
  if (count < 0) text.fail(fmt::format("{} elements cannot be: correct the number", count));
  element.count = static_cast<std::uint64_t>(count);
  header.elements.push_back(std::move(element));
}

void parse_property(TextCursor& text, PlyHeader& header) {
  if (header.elements.empty()) text.fail("a property before any element: put an element first");
  std::vector<PlyProperty>& properties = header.elements.back().properties;
  PlyProperty property;
  TextCursor ahead = text;
  if (same_word(ahead.word(), "list")) {
    text = ahead;
    property.is_list = true;
    property.count_type = parse_type(text);
  }
  property.type = parse_type(text);
  property.name = parse_name(text, "property");
  const bool again = std::any_of(properties.begin(), properties.end(),
                                 [&](const PlyProperty& p) { return p.name == property.name; });
  if (again) text.fail(fmt::format("a second property {}: rename one", in_quotes(property.name)));
  properties.push_back(std::move(property));
}

}  // namespace

std::size_t ply_size(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::Uint8:
      return 1;
    case PlyType::Int16:
    case PlyType::Uint16:
      return 2;
    case PlyType::Int64:
    case PlyType::Uint64:
    case PlyType::Float64:
      return 8;
    default:
      return 4;
  }
}

std::uint64_t PlyElement::least_bytes(PlyFormat format) const {
  if (format == PlyFormat::Ascii) return 2 * properties.size();
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += ply_size(p.is_list ? p.count_type : p.type);
  return bytes;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  PlyHeader header;
  bool has_format = false;
  TextCursor text(bytes, name);
  if (!same_word(text.word(), "ply"))
    text.fail("a PLY file starts with the line 'ply': this is none");
  while (true) {
    text.skip_line();
    if (text.at_end()) text.fail_at(text.position(), "no end_header: the file was cut off");
    const std::string_view keyword = text.word();
    if (same_word(keyword, "end_header")) break;
    if (same_word(keyword, "comment") || same_word(keyword, "obj_info") || keyword.empty())
      continue;
    if (same_word(keyword, "format")) {
      header.format = parse_format(text);
      has_format = true;
    } else if (same_word(keyword, "element")) {
      parse_element(text, header);
    } else if (same_word(keyword, "property")) {
      parse_property(text, header);
    } else if (header.elements.empty() && !keyword.starts_with("elem")) {
      // Blender once wrote who it was without the word "comment". Before the elements nothing is
      // lost by that.
      header.unknown_line = in_quotes(keyword);
      continue;
    } else {
      text.fail(fmt::format("unknown PLY header line {}: make it a comment", in_quotes(keyword)));
    }
    text.skip_blanks();
    if (!text.at_line_end()) {
      text.fail(fmt::format("{} too much on this line: remove it", in_quotes(text.word())));
    }
  }
  if (!has_format) text.fail("no format line in the header: add 'format ascii 1.0' or what it is");
  text.skip_blanks();
  // One line end, so that binary data may start with any byte. A CR alone ends the header only
  // where it ends the first line, too.
  const std::size_t at = bytes.size() - text.remaining();
  const std::size_t first_end = std::min(bytes.find_first_of("\r\n"), bytes.size());
  const bool cr_alone = bytes[first_end] == '\r' && bytes.substr(first_end, 2) != "\r\n";
  const std::size_t end = at + (bytes.substr(at, 2) == "\r\n" && !cr_alone ? 2 : 1);
  header.bytes = std::min(end, bytes.size());
  return header;
}

}  // namespace pierce::io
