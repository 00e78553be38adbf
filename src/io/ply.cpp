// SPDX-License-Identifier: Apache-2.0
//
// PLY: elements with properties, of which the vertices, the faces (or triangle strips) matter here
// and all others are stepped over.
#include <cmath>
#include <optional>

#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/ply_source.h"
#include "io/polygons.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

enum Slot : std::size_t { X, Y, Z, NX, NY, NZ, Red, Green, Blue, S, T, kSlots };

std::optional<Slot> slot_of(std::string_view property) {
  struct Name {
    std::string_view name;
    Slot slot;
  };
  static constexpr Name kNames[] = {
      {"x", X},
      {"y", Y},
      {"z", Z},
      {"nx", NX},
      {"ny", NY},
      {"nz", NZ},
      {"red", Red},
      {"green", Green},
      {"blue", Blue},
      {"r", Red},
      {"g", Green},
      {"b", Blue},
      {"diffuse_red", Red},
      {"diffuse_green", Green},
      {"diffuse_blue", Blue},
      {"s", S},
      {"t", T},
      {"u", S},
      {"v", T},
      {"texture_u", S},
      {"texture_v", T},
  };
  for (const Name& entry : kNames) {
    if (same_word(property, entry.name)) return entry.slot;
  }
  return std::nullopt;
}

// Whatever its name.
const PlyProperty* only_list_of_integers(const PlyElement& element) {
  const PlyProperty* found = nullptr;
  for (const PlyProperty& property : element.properties) {
    const bool fits =
        property.is_list && property.type != PlyType::Float32 && property.type != PlyType::Float64;
    if (fits && found != nullptr) return nullptr;
    if (fits) found = &property;
  }
  return found;
}

// Zeros, blanks, and the mark at which DOS ended texts.
bool is_padding(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) {
    return c == '\0' || c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\x1a';
  });
}

// What a whole number of a colour stands for: the largest of its type is 1.
double color_unit(PlyType type) {
  if (type == PlyType::Uint8) return 255;
  if (type == PlyType::Uint16) return 65535;
  return 1;
}

template <class Source>
class PlyBody {
 public:
  PlyBody(const PlyHeader& header, Source& source) : header_(header), source_(source) {}

  Mesh read() {
    for (const PlyElement& element : header_.elements) {
      if (same_word(element.name, "vertex")) vertex_count_ = element.count;
    }
    for (const PlyElement& element : header_.elements) {
      check_size(element);
      if (same_word(element.name, "vertex")) {
        read_vertices(element);
      } else if (same_word(element.name, "face")) {
        read_polygons(element, false);
      } else if (same_word(element.name, "tristrips")) {
        read_polygons(element, true);
      } else {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
          for (const PlyProperty& property : element.properties) skip(property);
          source_.end_row();
        }
      }
    }
    const std::string_view leftover = source_.leftover();
    if (!leftover.empty() && is_padding(leftover)) {
      mesh_.warnings.push_back(fmt::format("{} behind the last element left out",
                                           counted(leftover.size(), "empty byte", "empty bytes")));
    } else if (!leftover.empty()) {
      fail(
          fmt::format("{} too many after the last element: the counts in the header are "
                      "wrong or line ends were converted",
                      counted(source_.remaining(), "byte", "bytes")));
    }
    if (bad_attributes_ > 0) {
      mesh_.warnings.push_back(
          fmt::format("{} no number: read as 0",
                      counted(bad_attributes_, "part of a normal, colour or texture coordinate is",
                              "parts of normals, colours or texture coordinates are")));
    }
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { source_.fail(message); }

  // Before anything is allocated: a header can announce anything.
  void check_size(const PlyElement& element) {
    const std::uint64_t least = element.least_bytes(header_.format);
    if (least > 0 && element.count > (source_.remaining() + 1) / least) {
      fail(
          fmt::format("the header announces {} {}, too many for the size of the file: "
                      "it was cut off or line ends were converted",
                      counted(element.count, "element", "elements"), in_quotes(element.name)));
    }
  }

  void skip(const PlyProperty& property) {
    source_.skip(property.type, property.is_list ? list_length(property) : 1);
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const std::int64_t length = source_.integer(property.count_type);
    if (length < 0) fail(fmt::format("a list of {} items cannot be: correct it", length));
    return static_cast<std::uint64_t>(length);
  }

  double attribute(PlyType type) {
    const double value = source_.attribute(type);
    if (!std::isnan(value)) return value;
    ++bad_attributes_;
    return 0;
  }

  void read_vertices(const PlyElement& element);
  void read_polygons(const PlyElement& element, bool strips);
  void append_strip(std::span<const std::int64_t> corners);
  std::uint32_t checked(std::int64_t index) const;

  const PlyHeader& header_;
  Source& source_;
  std::uint64_t vertex_count_ = 0, bad_attributes_ = 0;
  Mesh mesh_;
  Polygons polygons_;
};

template <class Source>
void PlyBody<Source>::read_vertices(const PlyElement& element) {
  struct Column {
    const PlyProperty* property;
    std::size_t slot;
  };
  std::vector<Column> columns;
  std::array<const PlyProperty*, kSlots> found = {};
  for (const PlyProperty& property : element.properties) {
    const std::optional<Slot> slot = property.is_list ? std::nullopt : slot_of(property.name);
    const bool wanted = slot && found[*slot] == nullptr;
    if (wanted) found[*slot] = &property;
    columns.push_back({&property, wanted ? *slot : std::size_t{kSlots}});
  }
  if (!found[X] || !found[Y] || !found[Z]) {
    fail("the vertices lack a property x, y or z: name them so");
  }
  if (element.count > kMaxVertices) {
    fail(fmt::format("{} vertices are more than 2^32 - 1: split the mesh", element.count));
  }
  const auto is_float = [&](Slot slot) { return found[slot]->type == PlyType::Float32; };
  mesh_.single_precision = is_float(X) && is_float(Y) && is_float(Z);
  const bool normals = found[NX] && found[NY] && found[NZ];
  const bool colors = found[Red] && found[Green] && found[Blue];
  const bool texcoords = found[S] && found[T];
  mesh_.vertices.reserve(element.count);
  if (normals) mesh_.normals.reserve(element.count);
  if (colors) mesh_.colors.reserve(element.count);
  if (texcoords) mesh_.texcoords.reserve(element.count);

  std::array<double, kSlots + 1> at = {};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const Column& column : columns) {
      if (column.slot == kSlots) {
        skip(*column.property);
      } else if (column.slot <= Z) {
        at[column.slot] = source_.scalar(column.property->type);
      } else {
        at[column.slot] = attribute(column.property->type);
      }
    }
    source_.end_row();
    mesh_.vertices.push_back({at[X], at[Y], at[Z]});
    if (normals) {
      mesh_.normals.push_back(
          {nearest_float(at[NX]), nearest_float(at[NY]), nearest_float(at[NZ])});
    }
    if (colors) {
      mesh_.colors.push_back({nearest_float(at[Red] / color_unit(found[Red]->type)),
                              nearest_float(at[Green] / color_unit(found[Green]->type)),
                              nearest_float(at[Blue] / color_unit(found[Blue]->type))});
    }
    if (texcoords) mesh_.texcoords.push_back({nearest_float(at[S]), nearest_float(at[T])});
  }
  scale_colors(mesh_.colors);
}

template <class Source>
std::uint32_t PlyBody<Source>::checked(std::int64_t index) const {
  if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count_) {
    fail(fmt::format("index {} names no vertex, {}: correct it", index, there_are(vertex_count_)));
  }
  return static_cast<std::uint32_t>(index);
}

template <class Source>
void PlyBody<Source>::read_polygons(const PlyElement& element, bool strips) {
  const PlyProperty* indices = nullptr;
  for (const PlyProperty& property : element.properties) {
    const bool named =
        same_word(property.name, "vertex_indices") || same_word(property.name, "vertex_index");
    if (named && property.is_list) indices = &property;
  }
  if (!indices) indices = only_list_of_integers(element);
  if (!indices && element.count > 0) {
    fail(fmt::format("element {} lacks a list property vertex_indices: name it so",
                     in_quotes(element.name)));
  }
  if (!strips) mesh_.triangles.reserve(element.count);
  std::vector<std::uint32_t> corners;
  std::vector<std::int64_t> strip;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (&property != indices) {
        skip(property);
        continue;
      }
      const std::uint64_t length = list_length(property);
      // What is missing somewhere would pass for such a one.
      if (length < 3 && source_.free_form()) fail("a face of less than 3 corners: remove it");
      corners.clear();
      strip.clear();
      for (std::uint64_t k = 0; k < length; ++k) {
        const std::int64_t index = source_.integer(property.type);
        if (!strips || index != -1) corners.push_back(checked(index));
        if (strips) strip.push_back(index);
      }
      if (strips) {
        append_strip(strip);
      } else {
        polygons_.append(corners, mesh_.triangles);
      }
    }
    source_.end_row();
  }
}

// Every vertex makes a triangle with the two before it, every second one turned round; -1 starts a
// new strip.
template <class Source>
void PlyBody<Source>::append_strip(std::span<const std::int64_t> corners) {
  std::size_t start = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (corners[i] == -1) {
      start = i + 1;
    } else if (i >= start + 2) {
      const auto a = static_cast<std::uint32_t>(corners[i - 2]);
      const auto b = static_cast<std::uint32_t>(corners[i - 1]);
      const auto c = static_cast<std::uint32_t>(corners[i]);
      const bool turned = (i - start) % 2 == 1;
      mesh_.triangles.push_back(turned ? Triangle{b, a, c} : Triangle{a, b, c});
    }
  }
}

template <std::endian kOrder>
Mesh read_body(std::string_view bytes, const PlyHeader& header, const std::string& name) {
  PlyBinarySource<kOrder> source(bytes, header.bytes, name);
  return PlyBody(header, source).read();
}

Mesh read_text(std::string_view bytes, const PlyHeader& header, const std::string& name,
               bool free_form) {
  PlyAsciiSource source(bytes, header.bytes, name, free_form);
  return PlyBody(header, source).read();
}

bool has_a_line_each(std::string_view bytes, const PlyHeader& header) {
  std::uint64_t rows = 0, lines = 0;
  for (const PlyElement& element : header.elements) {
    if (!element.properties.empty()) rows += element.count;
  }
  TextCursor text(bytes.substr(header.bytes), {});
  for (text.skip_space(); !text.at_end(); text.skip_space(), ++lines) text.skip_line();
  return lines == rows;
}

// Nearly all files begin a line for each row. One that makes no sense so, and has another number of
// lines, is read once more as numbers one after the other.
Mesh read_ascii(std::string_view bytes, const PlyHeader& header, const std::string& name) {
  try {
    return read_text(bytes, header, name, false);
  } catch (const Error&) {
    if (has_a_line_each(bytes, header)) throw;
    try {
      Mesh mesh = read_text(bytes, header, name, true);
      mesh.warnings.emplace_back(
          "vertices and faces do not begin lines: the numbers are read one after the other");
      return mesh;
    } catch (const Error&) {  // the error of the usual layout says most
    }
    throw;
  }
}

}  // namespace

bool looks_like_ply(std::string_view bytes) {
  return same_word(bytes.substr(0, 3), "ply") &&
         (bytes.size() == 3 || bytes.find_first_of(" \t\r\n") == 3);
}

Mesh read_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  Mesh mesh;
  switch (header.format) {
    case PlyFormat::Ascii:
      mesh = read_ascii(bytes, header, name);
      mesh.format = "PLY, ascii";
      break;
    case PlyFormat::LittleEndian:
      mesh = read_body<std::endian::little>(bytes, header, name);
      mesh.format = "PLY, binary little endian";
      break;
    case PlyFormat::BigEndian:
      mesh = read_body<std::endian::big>(bytes, header, name);
      mesh.format = "PLY, binary big endian";
      break;
  }
  if (!header.unknown_line.empty()) {
    mesh.warnings.push_back(
        fmt::format("the header's line that begins with {} is no PLY: passed "
                    "over",
                    header.unknown_line));
  }
  return mesh;
}

}  // namespace pierce::io
