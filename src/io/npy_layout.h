// SPDX-License-Identifier: Apache-2.0
//
// Where the numbers of a table lie in the data of a .npy file: plain or structured arrays of any
// number of dimensions, in either order of the memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/npy.h"
#include "io/number_table.h"

namespace pierce::io {

enum class NumberType : std::uint8_t { F2, F4, F8, I1, I2, I4, I8, U1, U2, U4, U8 };

/// A column: number i of it lies `offset` bytes behind the start of row i.
struct NpySource {
  std::size_t column = 0;  ///< of the table
  NumberType type = NumberType::F8;
  bool swapped = false;  ///< the other byte order
  std::uint64_t offset = 0;
};

struct NpyLayout {
  std::vector<NpySource> sources;
  std::vector<std::size_t> absent;  ///< columns that the file does not have
  std::uint64_t rows = 0;
  bool fortran = false;
  /// C order: from row to row. Fortran order: along the last index, which runs fastest over the
  /// rows, as numpy.reshape(-1, ...) counts them.
  std::uint64_t stride = 0;
  std::vector<std::uint64_t> extents, strides;  ///< of the indices that count rows
  std::vector<std::string> remarks;

  /// Where a row starts, from the start of the data.
  [[nodiscard]] std::uint64_t row_offset(std::uint64_t row) const;
  /// How many rows from this one on follow each other at `stride`.
  [[nodiscard]] std::uint64_t run(std::uint64_t row) const;
};

/// Throws Error (BadFile) if the array is no table of that shape.
[[nodiscard]] NpyLayout npy_layout(const NpyHeader& header, const std::string& name,
                                   const TableShape& shape);

}  // namespace pierce::io
