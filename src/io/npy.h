// SPDX-License-Identifier: Apache-2.0
//
// The header of NumPy's .npy files, versions 1, 2 and 3: magic, length, and a Python dictionary
// with the element type, the order and the shape.
// Source: NumPy documentation, "numpy.lib.format".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

/// One number type inside an element: '<f4' is {'f', 4, false}.
struct NpyField {
  std::string name;        ///< empty for a plain (not structured) type
  char kind = 'f';         ///< f, i, u, b (bool), V (padding) ... as NumPy's letters
  std::size_t bytes = 0;   ///< of one item
  std::size_t repeat = 1;  ///< items, for a field that is itself a small array
  bool big_endian = false;
  std::size_t offset = 0;  ///< in the element
};

struct NpyHeader {
  std::vector<NpyField> fields;
  bool structured = false;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::size_t element_bytes = 0;
  std::size_t data_offset = 0;  ///< of the first element in the file

  /// Elements in the array; the parser has checked that their bytes can be counted in 64 bits.
  [[nodiscard]] std::uint64_t count() const;
};

/// Parses the header at the start of `bytes` (the whole file or at least its header). Throws Error
/// (BadFile) that starts with `name`.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view bytes, const std::string& name);

/// How many bytes from the start of a file are needed to parse its header; 0 if this is no .npy
/// file. Needs the first 12 bytes.
[[nodiscard]] std::size_t npy_header_bytes(std::string_view first_bytes);

/// A version 1 header for a C-order array. `descr` is Python text: "'<f4'" or "[('t', '<f4')]".
/// Its length does not depend on the shape's numbers, so a count can be mended at the end.
[[nodiscard]] std::string make_npy_header(std::string_view descr,
                                          std::span<const std::uint64_t> shape);

/// Writes a whole .npy file of numbers of one type, `bytes` in C order (for tests, generators).
void write_npy(const std::filesystem::path& path, std::string_view descr,
               std::span<const std::uint64_t> shape, std::string_view bytes);

}  // namespace pierce::io
