// SPDX-License-Identifier: Apache-2.0
//
// OFF and its variants with normals, colours and texture coordinates (NOFF, COFF, STOFF and their
// combinations). Numbers may stand right behind the header word, comments anywhere.
//
// Nearly all files have a line for each vertex and face, and then what more a line holds is a
// colour. A file that makes no sense so, and has another number of lines, is read once more as
// numbers one after the other, wherever lines end; every count must fit then, up to the end.
//
// Behind "OFF BINARY" all is big-endian, 32 bits a number; faces have the size of their colour.
// Source: Geomview manual, "OFF Files".
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/ply_source.h"
#include "io/polygons.h"
#include "io/text_cursor.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

struct OffHeader {
  bool texcoords = false, colors = false, normals = false, homogeneous = false;
  bool any_dimension = false;  // the number of dimensions stands first
  bool normals_last = false;   // behind the colours: MeshLab writes NCOFF and means that
  std::size_t length = 0;      // of the header word without what is glued to it; 0: no header
};

OffHeader parse_word(std::string_view word) {
  OffHeader header;
  // All in small letters is the same; a small n means something else only beside large ones.
  std::string letters(word.substr(0, std::min<std::size_t>(word.size(), 16)));
  if (letters.find("off") != letters.npos) {
    for (char& c : letters) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  }
  std::string_view rest = letters;
  const auto take = [&](std::string_view prefix) {
    const bool there = rest.starts_with(prefix);
    if (there) rest.remove_prefix(prefix.size());
    return there;
  };
  // In any order, once each: not all programs keep to that of the manual.
  const auto once = [&](bool& found, std::string_view prefix) {
    const bool there = !found && take(prefix);
    found = found || there;
    return there;
  };
  while (once(header.texcoords, "ST") || once(header.colors, "C") || once(header.normals, "N") ||
         once(header.homogeneous, "4") || once(header.any_dimension, "n")) {
    if (header.normals && !header.colors) header.normals_last = true;
  }
  header.normals_last = header.normals_last && header.colors;
  if (!take("OFF")) return {};
  const std::size_t glued = word.size() - (letters.size() - rest.size());
  const bool digits = word.substr(word.size() - glued).find_first_not_of("0123456789") == word.npos;
  if (digits) header.length = word.size() - glued;
  return header;
}

// Where vertices and faces end.
enum class Layout : std::uint8_t {
  Lines,   // with their lines, on which colours may follow
  Colors,  // after their numbers; on a face's last line a colour may follow
  Numbers  // after their numbers, which are all that there is
};

class OffReader {
 public:
  OffReader(std::string_view bytes, const std::string& name, Layout layout)
      : text_(bytes, name, {'#', false}), layout_(layout) {}

  Mesh read() {
    read_header();
    text_.skip_space();
    const std::uint64_t vertices = count("the number of vertices");
    const std::uint64_t faces = count("the number of faces");
    if (layout_ != Layout::Lines || !at_line_end()) skip_edges();
    if (layout_ == Layout::Lines && !at_line_end())
      text_.fail("too much behind the counts: remove it");
    // A vertex takes six characters at least, a face two; nothing is allocated for less.
    if (vertices > text_.remaining() / 6 || faces > text_.remaining() / 2) {
      text_.fail(
          fmt::format("{} and {} are announced, too many for the size of the file: it was cut off",
                      counted(vertices, "vertex", "vertices"), counted(faces, "face", "faces")));
    }
    lines_expected_ = vertices + faces;
    body_ = text_;
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

  /// After read failed: whether there is a line for each vertex and face, so that something else
  /// is wrong with one of them.
  [[nodiscard]] bool has_a_line_each() const {
    TextCursor text = body_;
    std::uint64_t lines = 0;
    for (text.skip_space(); !text.at_end(); text.skip_space()) {
      ++lines;
      text.skip_line();
    }
    return lines == lines_expected_;
  }

 private:
  void read_header() {
    text_.skip_space();
    TextCursor ahead = text_;
    header_ = parse_word(ahead.word());
    if (header_.length == 0) return;  // the word is optional
    text_.advance(header_.length);
    if (!header_.any_dimension) return;
    text_.skip_space();
    const std::uint64_t dimensions = count("the number of dimensions");
    if (dimensions == 3) return;
    text_.fail(fmt::format("a mesh of {} dimensions: only 3 are read", dimensions));
  }

  // In free form also on the next line.
  double number(const char* what) {
    if (layout_ != Layout::Lines) text_.skip_space();
    return text_.number(what);
  }

  [[nodiscard]] bool at_line_end() {
    text_.skip_blanks();
    return text_.at_line_end();
  }

  std::uint64_t count(const char* what) {
    if (layout_ != Layout::Lines) text_.skip_space();
    const std::int64_t value = text_.integer(what);
    if (value < 0 || static_cast<std::uint64_t>(value) > kMaxVertices) {
      text_.fail(fmt::format("{} cannot be {}: correct it", what, value));
    }
    return static_cast<std::uint64_t>(value);
  }

  // Says nothing, and is not always right, nor even positive.
  void skip_edges() {
    if (layout_ != Layout::Lines) text_.skip_space();
    (void)text_.integer("the number of edges");
  }

  Vec3<double> triple(const char* what) {
    const double x = number(what);
    const double y = number(what);
    return {x, y, number(what)};
  }

  // x y z, the normal if announced, then what else the line holds: a colour of 3 or 4 parts
  // (announced or not), texture coordinates if announced.
  void read_vertex() {
    text_.skip_space();
    mesh_.vertices.push_back(triple("a coordinate"));
    if (header_.homogeneous && number("the fourth coordinate") != 1) {
      text_.fail("a fourth coordinate that is not 1: divide the others by it");
    }
    if (header_.normals && !header_.normals_last) {
      const Vec3<double> n = triple("a part of the normal");
      mesh_.normals.push_back({nearest_float(n.x), nearest_float(n.y), nearest_float(n.z)});
    }
    double extra[9] = {};
    std::size_t size = 0;
    const std::size_t announced =
        (header_.colors ? 4 : 0) + (header_.texcoords ? 2 : 0) + (header_.normals_last ? 3 : 0);
    const std::size_t most = header_.normals_last ? 9 : 6;
    while (layout_ == Layout::Lines ? !at_line_end() : size < announced) {
      if (size == most) text_.fail("too many numbers for a vertex: put each on a line of its own");
      extra[size++] = number("a number");
    }
    if (header_.texcoords) {
      if (size < 2) text_.fail("expected texture coordinates: complete the line");
      mesh_.texcoords.push_back({nearest_float(extra[size - 2]), nearest_float(extra[size - 1])});
      size -= 2;
    }
    if (header_.normals_last) {
      if (size < 3) text_.fail("expected a normal: complete the line");
      const double* n = extra + size - 3;
      mesh_.normals.push_back({nearest_float(n[0]), nearest_float(n[1]), nearest_float(n[2])});
      size -= 3;
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

  // The number of corners, the corners, and a colour that is stepped over. A colour in free form
  // must be one; else what is missing somewhere would pass for it.
  void read_face() {
    text_.skip_space();
    const std::uint64_t corners = count("the number of corners");
    if (corners == 0 && (layout_ != Layout::Lines || !at_line_end())) {
      text_.fail("a face without corners: remove it");
    }
    polygon_.clear();
    for (std::uint64_t i = 0; i < corners; ++i) {
      if (layout_ != Layout::Lines) text_.skip_space();
      const std::int64_t index = text_.integer("the index of a vertex");
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size()) {
        text_.fail(fmt::format("index {} names no vertex, {}: correct it", index,
                               there_are(mesh_.vertices.size())));
      }
      polygon_.push_back(static_cast<std::uint32_t>(index));
    }
    polygons_.append(polygon_, mesh_.triangles);
    if (layout_ == Layout::Numbers) return;
    std::size_t size = 0;
    for (; layout_ == Layout::Colors && !at_line_end(); ++size) (void)number("a number");
    if (size != 0 && size != 3 && size != 4) text_.fail("a colour has 3 or 4 numbers: correct it");
    text_.skip_line();
  }

  TextCursor text_;
  TextCursor body_ = text_;  // behind the counts
  std::uint64_t lines_expected_ = 0;
  Mesh mesh_;
  Polygons polygons_;
  OffHeader header_;
  Layout layout_;
  std::vector<std::uint32_t> polygon_;
};

class BinaryOffReader {
 public:
  BinaryOffReader(std::string_view bytes, std::size_t start, const OffHeader& header,
                  const std::string& name)
      : source_(bytes, start, name), header_(header) {}

  Mesh read() {
    if (header_.any_dimension && count("the number of dimensions") != 3)
      source_.fail("a mesh of other than 3 dimensions: only 3 are read");
    const std::uint64_t vertices = count("the number of vertices");
    const std::uint64_t faces = count("the number of faces");
    (void)source_.integer(PlyType::Int32);  // edges
    const std::uint64_t numbers = 3U + (header_.homogeneous ? 1U : 0U) +
                                  (header_.normals ? 3U : 0U) + (header_.colors ? 4U : 0U) +
                                  (header_.texcoords ? 2U : 0U);
    if (vertices > source_.remaining() / (4 * numbers) || faces > source_.remaining() / 8) {
      source_.fail(
          fmt::format("{} and {} are announced, too many for the size of the file: it was cut off",
                      counted(vertices, "vertex", "vertices"), counted(faces, "face", "faces")));
    }
    for (std::uint64_t i = 0; i < vertices; ++i) read_vertex();
    for (std::uint64_t i = 0; i < faces; ++i) read_face();
    const std::size_t left = source_.leftover().size();
    if (left > 0) {
      source_.fail(fmt::format("{} behind the last face: the counts are wrong, get the file again",
                               counted(left, "byte", "bytes")));
    }
    scale_colors(mesh_.colors);
    mesh_.format = "OFF, binary";
    mesh_.single_precision = true;
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  double number() { return source_.scalar(PlyType::Float32); }
  float small() { return static_cast<float>(number()); }

  std::uint64_t count(const char* what) {
    const std::int64_t value = source_.integer(PlyType::Int32);
    if (value < 0) source_.fail(fmt::format("{} cannot be {}: get the file again", what, value));
    return static_cast<std::uint64_t>(value);
  }

  void read_vertex() {
    const double x = number(), y = number();
    mesh_.vertices.push_back({x, y, number()});
    if (header_.homogeneous && number() != 1)
      source_.fail("a fourth coordinate that is not 1: divide the others by it");
    if (header_.normals) {
      const float nx = small(), ny = small();
      mesh_.normals.push_back({nx, ny, small()});
    }
    if (header_.colors) {
      const float r = small(), g = small();
      mesh_.colors.push_back({r, g, small()});
      (void)number();
    }
    if (header_.texcoords) {
      const float s = small();
      mesh_.texcoords.push_back({s, small()});
    }
  }

  void read_face() {
    const std::uint64_t corners = count("the number of corners");
    polygon_.clear();
    for (std::uint64_t i = 0; i < corners; ++i) {
      const std::int64_t index = source_.integer(PlyType::Int32);
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh_.vertices.size()) {
        source_.fail(fmt::format("index {} names no vertex, {}: correct it", index,
                                 there_are(mesh_.vertices.size())));
      }
      polygon_.push_back(static_cast<std::uint32_t>(index));
    }
    polygons_.append(polygon_, mesh_.triangles);
    source_.skip(PlyType::Float32, count("the size of a colour"));
  }

  PlyBinarySource<std::endian::big> source_;
  OffHeader header_;
  Mesh mesh_;
  Polygons polygons_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

bool looks_like_off(std::string_view bytes) {
  TextCursor text(bytes, {}, {'#', false});
  text.skip_space();
  return parse_word(text.word()).length > 0;
}

Mesh read_off(std::string_view bytes, const std::string& name) {
  TextCursor text(bytes, name, {'#', false});
  text.skip_space();
  TextCursor ahead = text;
  const OffHeader header = parse_word(ahead.word());
  text.advance(header.length);
  if (header.length > 0 && same_word(text.word(), "BINARY")) {
    text.skip_line();
    return BinaryOffReader(bytes, bytes.size() - text.remaining(), header, name).read();
  }
  OffReader usual(bytes, name, Layout::Lines);
  try {
    return usual.read();
  } catch (const Error&) {
    if (usual.has_a_line_each()) throw;
    for (const Layout layout : {Layout::Colors, Layout::Numbers}) {
      try {
        Mesh mesh = OffReader(bytes, name, layout).read();
        mesh.warnings.emplace_back(
            "vertices and faces do not end with their lines: the numbers are read one after the "
            "other");
        return mesh;
      } catch (const Error&) {  // the error of the usual layout says most
      }
    }
    throw;
  }
}

}  // namespace pierce::io
