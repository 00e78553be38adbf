// SPDX-License-Identifier: Apache-2.0
//
// Wavefront OBJ: v, vt, vn and f, and the names of objects and groups (o, g); points, lines, curves
// and materials are stepped over.
// Written here and not left to tinyobjloader because that one does not read numbers to the nearest
// double (docs/decisions/0006-mesh-readers.md).
// Source: Alias|Wavefront, "Advanced Visualizer Manual", appendix B1.
#include <fmt/format.h>

#include <string>
#include <unordered_map>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/polygons.h"
#include "io/text_cursor.h"

namespace pierce::io {
namespace {

// Indices may name what comes later in the file, so the largest is kept and judged at the end.
struct Largest {
  std::uint64_t index = 0;
  const char* where = nullptr;
};

class ObjReader {
 public:
  ObjReader(std::string_view bytes, const std::string& name) : text_(bytes, name, {'#', true}) {}

  Mesh read() {
    while (!text_.at_end()) {
      const std::string_view keyword = text_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "vt") {
        read_texcoord();
      } else if (keyword == "vn") {
        normals_.push_back(read_attribute());
      } else if (keyword == "f" || keyword == "fo") {
        read_face();
      } else if (keyword == "o") {
        read_part_name(object_);
      } else if (keyword == "g") {
        read_part_name(group_);
      } else {
        if (keyword.find('\0') != keyword.npos) text_.fail("not text: save it as UTF-8 text");
        skip_statement();
      }
      text_.skip_line();
    }
    check(last_vertex_, mesh_.vertices.size(), "vertex");
    check(last_texcoord_, texcoords_.size(), "texture coordinate");
    check(last_normal_, normals_.size(), "normal");
    gather(texcoord_of_, texcoords_, mesh_.texcoords);
    gather(normal_of_, normals_, mesh_.normals);
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.vertices.size(), kWhite);
    scale_colors(mesh_.colors);
    mesh_.format = "OBJ";
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  static constexpr Vec3<float> kWhite = {1, 1, 1};

  [[nodiscard]] bool at_statement_end() {
    text_.skip_blanks();
    return text_.at_line_end();
  }

  void skip_statement() {
    while (!at_statement_end()) (void)text_.word();
  }

  // x y z, then nothing, a weight (which only curves use), a colour, or a colour with alpha.
  void read_vertex() {
    Vec3<double> p{};
    p.x = text_.number("the vertex's x");
    p.y = text_.number("the vertex's y");
    p.z = text_.number("the vertex's z");
    if (mesh_.vertices.size() == kMaxVertices) text_.fail("more than 2^32 - 1 vertices: split it");
    mesh_.vertices.push_back(p);
    double extra[4] = {};
    std::size_t count = 0;
    while (!at_statement_end()) {
      if (count == 4) text_.fail("a vertex has at most 7 numbers: remove the others");
      extra[count++] = text_.number("a number");
    }
    if (count == 2) text_.fail("a vertex has 3, 4, 6 or 7 numbers, not 5: complete it");
    if (count < 3) return;
    mesh_.colors.resize(mesh_.vertices.size() - 1, kWhite);
    mesh_.colors.push_back(
        {nearest_float(extra[0]), nearest_float(extra[1]), nearest_float(extra[2])});
  }

  Vec3<float> read_attribute() {
    const float x = nearest_float(text_.number("the normal's x"));
    const float y = nearest_float(text_.number("the normal's y"));
    const float z = nearest_float(text_.number("the normal's z"));
    return {x, y, z};
  }

  void read_texcoord() {
    const float s = nearest_float(text_.number("a texture coordinate"));
    const float t = at_statement_end() ? 0.0f : nearest_float(text_.number("a second one"));
    texcoords_.push_back({s, t});
    skip_statement();
  }

  void read_face() {
    corners_.clear();
    while (!at_statement_end()) {
      const std::uint32_t vertex = read_index(mesh_.vertices.size(), last_vertex_, "vertex");
      corners_.push_back(vertex);
      if (text_.peek() != '/') continue;
      text_.step();
      if (text_.peek() != '/' && !text_.at_word_end()) {
        remember(texcoord_of_, vertex,
                 read_index(texcoords_.size(), last_texcoord_, "texture coordinate"));
      }
      if (text_.peek() != '/') continue;
      text_.step();
      if (text_.at_word_end()) continue;
      remember(normal_of_, vertex, read_index(normals_.size(), last_normal_, "normal"));
    }
    begin_part();
    polygons_.append(corners_, mesh_.triangles);
  }

  // A group may have several names, which make one; "g" alone ends a group.
  void read_part_name(std::string& name) {
    name.clear();
    while (!at_statement_end()) {
      name += name.empty() ? "" : " ";
      name += text_.word();
    }
    part_named_ = true;
  }

  // Faces of one object and group are one part, wherever they stand.
  void begin_part() {
    if (!part_named_ && !mesh_.part_runs.empty()) return;
    part_named_ = false;
    const std::string name =
        object_.empty() || group_.empty() ? object_ + group_ : object_ + "/" + group_;
    const auto [part, is_new] = parts_.try_emplace(name, mesh_.part_names.size());
    if (is_new) mesh_.part_names.push_back(name);
    mesh_.part_runs.push_back({part->second, mesh_.triangles.size()});
  }

  // 1 is the first, -1 the last one so far.
  std::uint32_t read_index(std::size_t so_far, Largest& largest, const char* what) {
    const char* const where = text_.position();
    const std::int64_t index = text_.integer_here("an index");
    const char next = text_.peek();
    if (next != '/' && next != '\\' && !text_.at_word_end()) {
      text_.fail_at(where, fmt::format("expected an index, found {} behind {}: correct it",
                                       in_quotes({&next, 1}), index));
    }
    if (index > 0 && static_cast<std::uint64_t>(index) <= kMaxVertices) {
      const auto zero_based = static_cast<std::uint64_t>(index) - 1;
      if (largest.where == nullptr || zero_based > largest.index) largest = {zero_based, where};
      return static_cast<std::uint32_t>(zero_based);
    }
    if (index == 0) text_.fail_at(where, "index 0 names nothing, the first is 1: correct it");
    const std::int64_t from_end = static_cast<std::int64_t>(so_far) + index;
    if (index > 0 || from_end < 0) fail_range(where, index, so_far, what);
    return static_cast<std::uint32_t>(from_end);
  }

  template <class Number>
  [[noreturn]] void fail_range(const char* where, Number index, std::size_t count,
                               const char* what) const {
    text_.fail_at(
        where, fmt::format("index {} names no {}, {}: correct it", index, what, there_are(count)));
  }

  void check(const Largest& largest, std::size_t count, const char* what) const {
    if (largest.where != nullptr && largest.index >= count) {
      fail_range(largest.where, largest.index + 1, count, what);
    }
  }

  // Vertices yet to come are kept track of only as far as they have come; a face that names later
  // ones is too rare to spend memory on.
  void remember(std::vector<std::uint32_t>& of_vertex, std::uint32_t vertex, std::uint32_t value) {
    if (vertex >= mesh_.vertices.size()) return;
    if (vertex >= of_vertex.size()) of_vertex.resize(mesh_.vertices.size(), kNone);
    if (of_vertex[vertex] == kNone) of_vertex[vertex] = value;
  }

  template <class Value>
  void gather(const std::vector<std::uint32_t>& of_vertex, const std::vector<Value>& values,
              std::vector<Value>& out) const {
    if (of_vertex.empty()) return;
    out.resize(mesh_.vertices.size());
    for (std::size_t i = 0; i < of_vertex.size(); ++i) {
      if (of_vertex[i] != kNone) out[i] = values[of_vertex[i]];
    }
  }

  TextCursor text_;
  Mesh mesh_;
  Polygons polygons_;
  std::vector<Vec3<float>> normals_;
  std::vector<std::array<float, 2>> texcoords_;
  std::vector<std::uint32_t> normal_of_, texcoord_of_;  // one a vertex, kNone if unknown
  std::vector<std::uint32_t> corners_;
  std::string object_, group_;
  bool part_named_ = false;  // since the last face
  std::unordered_map<std::string, std::uint32_t> parts_;
  Largest last_vertex_, last_texcoord_, last_normal_;
};

}  // namespace

bool looks_like_obj(std::string_view bytes) {
  constexpr std::string_view kFirstWords[] = {"v", "vt",     "vn",     "f", "o",
                                              "g", "mtllib", "usemtl", "s"};
  TextCursor text(bytes, {}, {'#', true});
  text.skip_space();
  const std::string_view first = text.word();
  for (const std::string_view word : kFirstWords) {
    if (first == word) return true;
  }
  return false;
}

Mesh read_obj(std::string_view bytes, const std::string& name) {
  return ObjReader(bytes, name).read();
}

}  // namespace pierce::io
