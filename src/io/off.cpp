// SPDX-License-Identifier: Apache-2.0
//
// OFF and its variants with normals, colours and texture coordinates (NOFF, COFF, STOFF and their
// combinations). Numbers may stand right behind the header word, comments anywhere.
// Source: Geomview manual, "OFF Files".
#include <fmt/format.h>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/polygons.h"
#include "io/text_cursor.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

struct OffHeader {
  bool texcoords = false, colors = false, normals = false, four_dimensional = false;
  std::size_t length = 0;  // of the header word without what is glued to it; 0: no header
};

OffHeader parse_word(std::string_view word) {
  OffHeader header;
  const std::string_view all = word;
  const auto take = [&](std::string_view prefix) {
    const bool there = word.starts_with(prefix);
    if (there) word.remove_prefix(prefix.size());
    return there;
  };
  header.texcoords = take("ST");
  header.colors = take("C");
  header.normals = take("N");
  header.four_dimensional = take("4");
  header.four_dimensional = take("n") || header.four_dimensional;
  const bool glued_digits = word.find_first_not_of("0123456789", 3) == word.npos;
  if (take("OFF") && glued_digits) header.length = all.size() - word.size();
  return header;
}

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& name) : text_(bytes, name, {'#', false}) {}

  Mesh read() {
    read_header();
    text_.skip_space();
    const std::uint64_t vertices = count("the number of vertices");
    const std::uint64_t faces = count("the number of faces");
    if (!at_line_end()) (void)count("the number of edges");
    if (!at_line_end()) text_.fail("too much behind the counts: remove it");
    // A vertex takes six characters at least, a face two; nothing is allocated for less.
    if (vertices > text_.remaining() / 6 || faces > text_.remaining() / 2) {
      text_.fail(
          fmt::format("{} and {} are announced, too many for the size of the file: it was cut off",
                      counted(vertices, "vertex", "vertices"), counted(faces, "face", "faces")));
    }
    mesh_.vertices.reserve(vertices);
    for (std::uint64_t i = 0; i < vertices; ++i) read_vertex();
    mesh_.triangles.reserve(faces);
    for (std::uint64_t i = 0; i < faces; ++i) read_face();
    text_.skip_space();
    if (!text_.at_end()) {
      text_.fail(fmt::format("{} behind the last face: the counts are wrong, correct them",
                             in_quotes(text_.word())));
    }
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.vertices.size(), {1, 1, 1});
    scale_colors(mesh_.colors);
    mesh_.format = "OFF";
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  void read_header() {
    text_.skip_space();
    TextCursor ahead = text_;
    header_ = parse_word(ahead.word());
    if (header_.length == 0) return;  // the word is optional
    text_.advance(header_.length);
    if (header_.four_dimensional) text_.fail("a mesh of 4 dimensions: only 3 are read");
    ahead = text_;
    if (ahead.word() == "BINARY") text_.fail("binary OFF is not read: convert it to PLY");
  }

  [[nodiscard]] bool at_line_end() {
    text_.skip_blanks();
    return text_.at_line_end();
  }

  std::uint64_t count(const char* what) {
    const std::int64_t value = text_.integer(what);
    if (value < 0 || static_cast<std::uint64_t>(value) > kMaxVertices) {
      text_.fail(fmt::format("{} cannot be {}: correct it", what, value));
    }
    return static_cast<std::uint64_t>(value);
  }

  Vec3<double> triple(const char* what) {
    const double x = text_.number(what);
    const double y = text_.number(what);
    return {x, y, text_.number(what)};
  }

  // x y z, the normal if announced, then what else the line holds: a colour of 3 or 4 parts
  // (announced or not), texture coordinates if announced.
  void read_vertex() {
    text_.skip_space();
    mesh_.vertices.push_back(triple("a coordinate"));
    if (header_.normals) {
      const Vec3<double> n = triple("a part of the normal");
      mesh_.normals.push_back({nearest_float(n.x), nearest_float(n.y), nearest_float(n.z)});
    }
    double extra[6] = {};
    std::size_t size = 0;
    while (!at_line_end()) {
      if (size == 6) text_.fail("too many numbers for a vertex: put each on a line of its own");
      extra[size++] = text_.number("a number");
    }
    if (header_.texcoords) {
      if (size < 2) text_.fail("expected texture coordinates: complete the line");
      mesh_.texcoords.push_back({nearest_float(extra[size - 2]), nearest_float(extra[size - 1])});
      size -= 2;
    }
    if (size == 0 && !header_.colors) return;
    if (size != 3 && size != 4) {
      text_.fail(
          fmt::format("expected a colour of 3 or 4 numbers, found {}: correct the line or "
                      "the header word",
                      size));
    }
    mesh_.colors.resize(mesh_.vertices.size() - 1, {1, 1, 1});
    mesh_.colors.push_back(
        {nearest_float(extra[0]), nearest_float(extra[1]), nearest_float(extra[2])});
  }

  // The number of corners, the corners, and a colour that is stepped over.
  void read_face() {
    text_.skip_space();
    const std::uint64_t corners = count("the number of corners");
    polygon_.clear();
    for (std::uint64_t i = 0; i < corners; ++i) {
      const std::int64_t index = text_.integer("the index of a vertex");
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size()) {
        text_.fail(fmt::format("index {} names no vertex, {}: correct it", index,
                               there_are(mesh_.vertices.size())));
      }
      polygon_.push_back(static_cast<std::uint32_t>(index));
    }
    polygons_.append(polygon_, mesh_.triangles);
    text_.skip_line();
  }

  TextCursor text_;
  Mesh mesh_;
  Polygons polygons_;
  OffHeader header_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

bool looks_like_off(std::string_view bytes) {
  TextCursor text(bytes, {}, {'#', false});
  text.skip_space();
  return parse_word(text.word()).length > 0;
}

Mesh read_off(std::string_view bytes, const std::string& name) {
  return OffReader(bytes, name).read();
}

}  // namespace pierce::io
