// SPDX-License-Identifier: Apache-2.0
//
// The header of a PLY file: which elements follow, how many, and what each consists of.
// Source: Greg Turk, "The PLY polygon file format" (1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

enum class PlyFormat { Ascii, LittleEndian, BigEndian };

// Int64 and Uint64 are in no specification, but in files.
enum class PlyType { Int8, Uint8, Int16, Uint16, Int32, Uint32, Int64, Uint64, Float32, Float64 };

[[nodiscard]] std::size_t ply_size(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float32;  ///< of the number, or of the items of the list
  bool is_list = false;
  PlyType count_type = PlyType::Uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// The fewest bytes that one of these takes: with empty lists; in ascii a digit and a blank each.
  [[nodiscard]] std::uint64_t least_bytes(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::Ascii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;     ///< the data starts here
  std::string unknown_line;  ///< its first word, quoted, if a line was passed over
};

[[nodiscard]] PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace pierce::io
