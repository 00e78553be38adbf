// SPDX-License-Identifier: Apache-2.0
//
// Wavefront OBJ: v, vt, vn and f, and the names of objects and groups (o, g); points, lines, curves
// and materials are stepped over.
// Written here and not left to tinyobjloader because that one does not read numbers to the nearest
// double (docs/decisions/0006-mesh-readers.md).
// Source: Alias|Wavefront, "Advanced Visualizer Manual", appendix B1.
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/polygons.h"
#include "io/text_cursor.h"
#include "support/count_words.h"

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
      if (keyword == "v" || keyword == "V") {
        read_vertex();
      } else if (keyword == "vt") {
        read_texcoord();
      } else if (keyword == "vn") {
        normals_.push_back(read_attribute());
      } else if (keyword == "f" || keyword == "F" || keyword == "fo") {
        read_face();
      } else if (keyword == "o") {
        read_part_name(object_);
      } else if (keyword == "g") {
        read_part_name(group_);
      } else {
        if (keyword.find('\0') != keyword.npos) text_.fail("not text: save it as UTF-8 text");
        note_unknown(keyword);
        is_name(keyword) ? skip_names() : skip_statement();
      }
      text_.skip_line();
    }
    check(last_vertex_, mesh_.vertices.size(), "vertex");
    gather(texcoord_of_, texcoords_, mesh_.texcoords);
    gather(normal_of_, normals_, mesh_.normals);
    if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.vertices.size(), kWhite);
    scale_colors(mesh_.colors);
    mesh_.format = "OBJ";
    polygons_.finish(mesh_);
    if (bad_attributes_ > 0) {
      mesh_.warnings.push_back(fmt::format("{} that are no numbers or not there: they are left out",
                                           counted(bad_attributes_, "normal or texture coordinate",
                                                   "normals or texture coordinates")));
    }
    if (bad_extras_ > 0) {
      mesh_.warnings.push_back(fmt::format("{} more than x, y, z and a colour: that is left out",
                                           counted(bad_extras_, "vertex holds", "vertices hold")));
    }
    if (surfaces_ > 0) {
      mesh_.warnings.push_back(
          fmt::format("{} not read: convert them to triangles",
                      counted(surfaces_, "free-form surface is", "free-form surfaces are")));
    }
    if (unknown_ > 0) {
      mesh_.warnings.push_back(
          fmt::format("{} that OBJ does not know, the first beginning with {}: passed over",
                      counted(unknown_, "line", "lines"), first_unknown_));
    }
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

  static bool is_name(std::string_view keyword) {
    return keyword == "mtllib" || keyword == "usemtl" || keyword == "maplib" ||
           keyword == "usemap" || keyword == "call" || keyword == "csh";
  }

  // "C:\\models\\" at the end of a line is a name; blanks before its last backslash would continue
  // the line.
  void skip_names() {
    while (!at_statement_end()) {
      (void)text_.word();
      if (text_.peek() == '\\') return;
    }
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
    bool good = true;
    for (; !at_statement_end(); ++count) {
      double value = 0;
      good = parse_number(text_.word(), value) && count < 4 && good;
      if (good) extra[count] = value;
    }
    if (!good || count == 2) ++bad_extras_;
    if (!good || count < 3) return;
    mesh_.colors.resize(mesh_.vertices.size() - 1, kWhite);
    mesh_.colors.push_back(
        {nearest_float(extra[0]), nearest_float(extra[1]), nearest_float(extra[2])});
  }

  void note_unknown(std::string_view keyword) {
    if (keyword == "surf") ++surfaces_;
    static constexpr std::string_view kKnown[] = {
        "",       "#",      "s",        "l",        "p",     "usemtl", "mtllib",     "mg",
        "vp",     "usemap", "maplib",   "curv",     "curv2", "surf",   "parm",       "trim",
        "hole",   "scrv",   "sp",       "end",      "con",   "deg",    "bmat",       "step",
        "cstype", "bevel",  "c_interp", "d_interp", "lod",   "ctech",  "stech",      "call",
        "csh",    "bsp",    "bzp",      "cdc",      "cdp",   "res",    "shadow_obj", "trace_obj"};
    if (std::find(std::begin(kKnown), std::end(kKnown), keyword) != std::end(kKnown)) return;
    if (unknown_++ == 0) first_unknown_ = in_quotes(keyword);
  }

  // Attributes decide nothing: what is no number, or not there, is 0.
  float any_number() {
    double value = 0;
    if (!parse_number(text_.word(), value)) {
      ++bad_attributes_;
      return 0;
    }
    return nearest_float(value);
  }

  Vec3<float> read_attribute() {
    const float x = any_number(), y = any_number();
    return {x, y, any_number()};
  }

  void read_texcoord() {
    const float s = any_number();
    texcoords_.push_back({s, at_statement_end() ? 0.0f : any_number()});
    skip_statement();
  }

  void read_face() {
    corners_.clear();
    while (!at_statement_end()) {
      const std::uint32_t vertex = read_index(mesh_.vertices.size(), last_vertex_, "vertex");
      corners_.push_back(vertex);
      if (text_.peek() != '/') continue;
      text_.step();
      read_attribute_index(texcoord_of_, vertex, texcoords_.size());
      if (text_.peek() != '/') continue;
      text_.step();
      read_attribute_index(normal_of_, vertex, normals_.size());
      if (!text_.at_word_end()) {
        text_.fail(fmt::format("expected an index, found {}: correct it", in_quotes(text_.word())));
      }
    }
    begin_part();
    polygons_.append(corners_, mesh_.triangles);
  }

  // Whatever stands there; what is wrong with it concerns pictures only.
  void read_attribute_index(std::vector<std::uint32_t>& of_vertex, std::uint32_t vertex,
                            std::size_t so_far) {
    const char* const start = text_.position();
    while (!text_.at_word_end() && text_.peek() != '/') text_.step();
    const std::string_view word(start, static_cast<std::size_t>(text_.position() - start));
    if (word.empty()) return;
    std::int64_t index = 0;
    const bool whole = parse_integer(word, index);
    if (whole && index < 0) index += static_cast<std::int64_t>(so_far) + 1;
    if (whole && index > 0 && static_cast<std::uint64_t>(index) < kNone) {
      remember(of_vertex, vertex, static_cast<std::uint32_t>(index - 1));
    } else {
      ++bad_attributes_;
    }
  }

  // A group may have several names, which make one; "g" alone ends a group.
  void read_part_name(std::string& name) {
    name.clear();
    while (!at_statement_end()) {
      name += name.empty() ? "" : " ";
      name += text_.word();
      if (text_.peek() == '\\') break;  // see skip_names
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
              std::vector<Value>& out) {
    if (of_vertex.empty() || values.empty()) {
      bad_attributes_ += of_vertex.size();
      return;
    }
    out.resize(mesh_.vertices.size());
    for (std::size_t i = 0; i < of_vertex.size(); ++i) {
      if (of_vertex[i] == kNone) continue;
      if (of_vertex[i] < values.size()) {
        out[i] = values[of_vertex[i]];
      } else {
        ++bad_attributes_;
      }
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
  Largest last_vertex_;
  std::uint64_t bad_attributes_ = 0, bad_extras_ = 0, surfaces_ = 0, unknown_ = 0;
  std::string first_unknown_;
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
