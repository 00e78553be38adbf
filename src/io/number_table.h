// SPDX-License-Identifier: Apache-2.0
//
// NumberTable: rows of numbers in a file, .npy or .csv, whichever it is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

/// What a table must look like.
struct TableShape {
  std::string_view what;                      ///< for messages: "rays"
  std::span<const std::string_view> columns;  ///< all their names, in order
  std::size_t fewest_columns;                 ///< this many or all of them
};

class NumberTable {
 public:
  virtual ~NumberTable() = default;

  /// The file's rows from `first` on, as many as fit `out`, exactly as doubles. Thread-safe.
  virtual void read(std::uint64_t first, std::span<double> out) const = 0;

  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] bool single_precision() const { return single_precision_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 protected:
  explicit NumberTable(std::string name) : name_(std::move(name)) {}

  std::string name_;
  std::uint64_t rows_ = 0;
  std::size_t columns_ = 0;
  bool single_precision_ = false;
};

/// Throws Error (BadFile) if the file is no table of that shape.
[[nodiscard]] std::unique_ptr<NumberTable> open_table(const std::filesystem::path& path,
                                                      const TableShape& shape);
[[nodiscard]] std::unique_ptr<NumberTable> open_npy_table(const std::filesystem::path& path,
                                                          const TableShape& shape);
[[nodiscard]] std::unique_ptr<NumberTable> open_csv_table(const std::filesystem::path& path,
                                                          const TableShape& shape);

/// The csv reader on text in memory; row by row into `numbers`. Returns the number of columns.
std::size_t parse_csv(std::string_view text, const std::string& name, const TableShape& shape,
                      std::vector<double>& numbers);

}  // namespace pierce::io
