// SPDX-License-Identifier: Apache-2.0
//
// STL: a list of triangles, each with corners of its own (nothing is merged), as text or binary. A
// binary file is known by its size, for many start with "solid" like the text ones.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/polygons.h"
#include "io/text_cursor.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

// Binary: 80 bytes of anything, a count, and for each triangle normal, three corners, two bytes.
constexpr std::size_t kCountAt = 80;
constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kRecordBytes = 50;
constexpr std::size_t kNormalBytes = 12;

std::uint32_t little_endian(const char* p) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) {
    value |= std::uint32_t{static_cast<unsigned char>(p[i])} << (8 * i);
  }
  return value;
}

double coordinate(const char* p) {
  return static_cast<double>(std::bit_cast<float>(little_endian(p)));
}

std::uint64_t attribute_bytes(std::string_view bytes, std::uint64_t record) {
  const auto byte = [&](std::uint64_t at) -> std::uint64_t {
    return static_cast<unsigned char>(bytes[record + kRecordBytes - 2 + at]);
  };
  return byte(0) | byte(1) << 8;
}

// Whether the two bytes of each triangle count what follows it, all through the file. They mostly
// hold a colour, and nothing follows.
bool has_vendor_bytes(std::string_view bytes, std::uint64_t count) {
  std::uint64_t at = kHeaderBytes;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (bytes.size() - at < kRecordBytes) return false;
    const std::uint64_t more = attribute_bytes(bytes, at);
    at += kRecordBytes;
    if (bytes.size() - at < more) return false;
    at += more;
  }
  return at == bytes.size();
}

bool is_text(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 512);
  return std::none_of(start.begin(), start.end(), [](char c) {
    const auto code = static_cast<unsigned char>(c);
    return code < 9 || (code > 13 && code < 32);
  });
}

// Steps over comments and colours, which stand on lines of their own.
void skip_to_word(TextCursor& text) {
  constexpr std::string_view kMarks = "#;!";
  for (text.skip_space(); !text.at_end(); text.skip_space()) {
    TextCursor ahead = text;
    const std::string_view word = ahead.word();
    const bool passed = kMarks.find(word[0]) != kMarks.npos || word.starts_with("//") ||
                        same_word(word, "color") || same_word(word, "colour");
    if (!passed) return;
    text.skip_line();
  }
}

// "endloop", also in two words.
bool take_word(TextCursor& text, std::string_view wanted) {
  skip_to_word(text);
  TextCursor ahead = text;
  const std::string_view word = ahead.word();
  bool found = same_word(word, wanted);
  if (!found && wanted.starts_with("end") && same_word(word, "end")) {
    found = same_word(ahead.word(), wanted.substr(3));
  }
  if (found) text = ahead;
  return found;
}

void append_triangle(Mesh& mesh) {
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.triangles.push_back({last - 3, last - 2, last - 1});
}

Mesh read_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < kHeaderBytes) {
    bad_byte(name, bytes.size(), "the file ends in the header of a binary STL: it was cut off");
  }
  Mesh mesh;
  std::uint64_t count = little_endian(bytes.data() + kCountAt);
  const std::uint64_t rest = bytes.size() - kHeaderBytes;
  if ((count == 0 || count == 0xffffffff) && rest > 0 && rest % kRecordBytes == 0) {
    mesh.warnings.push_back(
        fmt::format("the header announces {}: read as the {} that the file has room for",
                    counted(count, "triangle", "triangles"), grouped(rest / kRecordBytes)));
    count = rest / kRecordBytes;
  }
  const std::uint64_t expected = kHeaderBytes + kRecordBytes * count;
  if (bytes.size() < expected || (count == 0 && rest > 0)) {
    if (is_text(bytes))
      bad_file(name, "is text, but no STL, which begins with 'solid': get it again");
    bad_byte(name, kCountAt,
             fmt::format("the header announces {}, {} bytes, but the file has {}: it was cut off "
                         "or changed, get it again",
                         counted(count, "triangle", "triangles"), grouped(expected),
                         grouped(bytes.size())));
  }
  if (3 * count > kMaxVertices) {
    bad_byte(name, kCountAt, fmt::format("{} triangles are too many: split the mesh", count));
  }
  const bool vendor = bytes.size() > expected && has_vendor_bytes(bytes, count);
  if (vendor) {
    mesh.warnings.emplace_back("the vendor's bytes behind each triangle are left out");
  } else if (bytes.size() > expected) {
    mesh.warnings.push_back(fmt::format("{} behind the announced {} left out",
                                        counted(bytes.size() - expected, "byte", "bytes"),
                                        counted(count, "triangle", "triangles")));
  }
  mesh.format = "STL, binary";
  mesh.single_precision = true;
  mesh.vertices.reserve(3 * count);
  mesh.triangles.reserve(count);
  std::uint64_t at = kHeaderBytes;
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* p = bytes.data() + at + kNormalBytes;
    at += kRecordBytes + (vendor ? attribute_bytes(bytes, at) : 0);
    for (int corner = 0; corner < 3; ++corner, p += 12) {
      mesh.vertices.push_back({coordinate(p), coordinate(p + 4), coordinate(p + 8)});
    }
    append_triangle(mesh);
  }
  return mesh;
}

class AsciiStl {
 public:
  AsciiStl(std::string_view bytes, const std::string& name) : text_(bytes, name) {}

  Mesh read() {
    mesh_.format = "STL, ascii";
    for (skip_to_word(text_); !text_.at_end(); skip_to_word(text_)) {
      expect("solid");
      begin_part(read_title());
      while (!next_is("endsolid")) read_facet();
      expect("endsolid");
      skip_end_title();
    }
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] bool next_is(std::string_view word) {
    TextCursor ahead = text_;
    return take_word(ahead, word);
  }

  void expect(std::string_view word) {
    if (take_word(text_, word)) return;
    const std::string_view found = text_.word();
    if (found.empty()) {
      text_.fail(fmt::format("the file ends before '{}': it was cut off{}", word,
                             word == "facet" ? ", or add a line 'endsolid'" : ""));
    }
    text_.fail(fmt::format("expected '{}', found {}: correct it", word, in_quotes(found)));
  }

  // A title is the rest of the line, but files without line ends exist: words with which the text
  // goes on behind the title end it, too.
  std::string read_title() {
    return line_until([](TextCursor ahead) {
      const std::string_view word = ahead.word();
      return same_word(word, "endsolid") ||
             (same_word(word, "end") && same_word(TextCursor(ahead).word(), "solid")) ||
             (same_word(word, "facet") && same_word(ahead.word(), "normal"));
    });
  }
  void skip_end_title() {
    (void)line_until(
        [](TextCursor ahead) { return same_word(ahead.word(), "solid") && goes_on(ahead); });
  }

  template <class Ends>
  std::string line_until(Ends ends) {
    std::string line;
    for (text_.skip_blanks(); !text_.at_line_end() && !ends(text_); text_.skip_blanks()) {
      line += line.empty() ? "" : " ";
      line += text_.word();
    }
    return line;
  }

  // Every solid is a part, whatever its name.
  void begin_part(std::string title) {
    mesh_.part_runs.push_back(
        {static_cast<std::uint32_t>(mesh_.part_names.size()), mesh_.triangles.size()});
    mesh_.part_names.push_back(std::move(title));
  }

  // Whether this line holds a solid: tells "endsolid solid" from "endsolid a solid b facet ...".
  [[nodiscard]] static bool goes_on(TextCursor ahead) {
    for (std::string_view word = ahead.word(); !word.empty(); word = ahead.word()) {
      if (same_word(word, "facet") || same_word(word, "endsolid")) return true;
    }
    return false;
  }

  void read_facet() {
    expect("facet");
    expect("normal");
    // The normal says nothing that the corners do not, and is often wrong or not even a number.
    for (int i = 0; i < 3; ++i) {
      text_.skip_space();
      const std::string_view word = text_.word();
      if (same_word(word, "outer")) {
        text_.fail("expected the normal's 3 numbers, found 'outer': write any");
      }
    }
    expect("outer");
    expect("loop");
    const std::size_t first = mesh_.vertices.size();
    while (!next_is("endloop")) {
      expect("vertex");
      Vec3<double> p{};
      for (double* c : {&p.x, &p.y, &p.z}) {
        text_.skip_space();
        *c = text_.number("a coordinate");
      }
      mesh_.vertices.push_back(p);
    }
    const std::size_t corners = mesh_.vertices.size() - first;
    if (mesh_.vertices.size() > kMaxVertices) text_.fail("more than 2^32 - 1 corners: split it");
    if (corners < 3) {
      expect("endloop");
      text_.fail(
          fmt::format("a facet with {}: a triangle has 3", counted(corners, "corner", "corners")));
    }
    polygon_.clear();
    for (std::size_t i = first; i < mesh_.vertices.size(); ++i) {
      polygon_.push_back(static_cast<std::uint32_t>(i));
    }
    polygons_.append(polygon_, mesh_.triangles);
    expect("endloop");
    expect("endfacet");
  }

  TextCursor text_;
  Mesh mesh_;
  Polygons polygons_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

bool looks_like_binary_stl(std::string_view bytes) {
  return bytes.size() >= kHeaderBytes &&
         bytes.size() ==
             kHeaderBytes + kRecordBytes * std::uint64_t{little_endian(bytes.data() + kCountAt)};
}

bool looks_like_ascii_stl(std::string_view bytes) {
  TextCursor text(bytes, {});
  skip_to_word(text);
  // A cut-off binary file may start with "solid", too, but text holds no NUL.
  return same_word(text.word(), "solid") && bytes.substr(0, 256).find('\0') == bytes.npos;
}

Mesh read_stl(std::string_view bytes, const std::string& name) {
  if (!looks_like_binary_stl(bytes) && looks_like_ascii_stl(bytes)) {
    return AsciiStl(bytes, name).read();
  }
  return read_binary(bytes, name);
}

}  // namespace pierce::io
