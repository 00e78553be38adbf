// SPDX-License-Identifier: Apache-2.0
//
// NumberTable: rows of numbers, from .npy, .npz or .csv, whichever it is, or from memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/input_file.h"

namespace pierce::io {

struct TableColumn {
  std::string_view name;
  std::string_view alias = {};  ///< another name for it
  double otherwise = 0;         ///< what it holds if the file does not have it
};

/// Three columns under one name: fields of a structured array.
struct TableTriple {
  std::string_view name;
  std::size_t first;  ///< of its columns
};

/// What a table must look like. The first `fewest` columns must be there; the others may be left
/// out, one by one if the file names its columns, all together if it does not.
struct TableShape {
  std::string_view what;  ///< for messages: "rays"
  std::span<const TableColumn> columns;
  std::size_t fewest;
  std::span<const TableTriple> triples = {};
  /// The vertices of a PLY are rows of it, and in .xyz, .xyzn, .xyzrgb, .pts and .asc its columns
  /// come first, whatever follows.
  bool point_cloud = false;
};

class NumberTable {
 public:
  virtual ~NumberTable() = default;

  /// Rows from `first` on, as many as fit `out`, each of all the shape's columns. Thread-safe.
  /// Floats and doubles are rounded to nearest; a finite number beyond the floats, or an integer
  /// that is no Real, throws Error (BadFile) that names the row, counted from 0.
  virtual void read(std::uint64_t first, std::span<float> out) const = 0;
  virtual void read(std::uint64_t first, std::span<double> out) const = 0;

  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  /// All numbers are of types that float holds exactly.
  [[nodiscard]] bool single_precision() const { return single_precision_; }
  /// All numbers are integers: read as they are or not at all.
  [[nodiscard]] bool whole_numbers() const { return whole_numbers_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// What a reader of the file should know: each a line, beginning with its name.
  [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

 protected:
  explicit NumberTable(std::string name) : name_(std::move(name)) {}

  std::string name_;
  std::uint64_t rows_ = 0;
  bool single_precision_ = false;
  bool whole_numbers_ = false;
  std::vector<std::string> remarks_;
};

/// `path` may be "-", standard input; what gzip or zstd packed is unpacked in memory. Throws Error
/// (BadFile) if the file is no table of that shape.
[[nodiscard]] std::unique_ptr<NumberTable> open_table(const std::filesystem::path& path,
                                                      const TableShape& shape);
[[nodiscard]] std::unique_ptr<NumberTable> open_npy_table(InputFile file, const TableShape& shape);
[[nodiscard]] std::unique_ptr<NumberTable> open_csv_table(InputFile file, const TableShape& shape);

/// Numbers in memory, row by row, as a table of that shape.
struct TableNumbers {
  std::vector<double> numbers;
  std::vector<std::size_t> columns;  ///< for each number of a row: which of the shape's it is
  std::vector<std::string> remarks;
  bool single_precision = false;
};
[[nodiscard]] std::unique_ptr<NumberTable> make_table(TableNumbers numbers, std::string name,
                                                      const TableShape& shape);

/// The only array of an .npz, or the one named as `shape.what`.
[[nodiscard]] std::unique_ptr<NumberTable> open_npz_table(InputFile file, const TableShape& shape);
/// The vertices of a PLY, as rows of three.
[[nodiscard]] std::unique_ptr<NumberTable> open_ply_table(InputFile file, const TableShape& shape);

/// The csv reader on text in memory.
[[nodiscard]] TableNumbers parse_csv(std::string_view text, const std::string& name,
                                     const TableShape& shape);

/// A name that a file gives to a column, or to several together.
struct ColumnTitle {
  std::string name;
  std::size_t count = 1;
};

inline constexpr std::size_t kNoColumn = std::numeric_limits<std::size_t>::max();

/// Which columns the titles of a file mean, by name, in whatever case and order.
struct ColumnMatch {
  std::vector<std::size_t> columns;  ///< the first column of each title; kNoColumn: not used
  std::vector<bool> found;           ///< for each column of the shape
  std::string trouble;               ///< what is wrong with them, and the cure; empty if nothing
  std::string unused;                ///< the titles that nothing was known of, to be remarked upon
};
[[nodiscard]] ColumnMatch match_columns(std::span<const ColumnTitle> titles,
                                        const TableShape& shape);

/// "ox,oy,oz,dx,dy,dz[,t_min,t_max]"
[[nodiscard]] std::string column_names(const TableShape& shape);
/// "6 or 8"
[[nodiscard]] std::string column_counts(const TableShape& shape);

}  // namespace pierce::io
