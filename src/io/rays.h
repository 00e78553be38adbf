// SPDX-License-Identifier: Apache-2.0
//
// Rays and points in: .npy or .csv, by what the file holds, from a file or from standard input
// ("-"), or from memory.
//
// .npy: numbers of shape (n, 6) or (n, 8), of shape (n, 2, 3), with more indices before these, or
// records with fields by these names; float16, float32, float64, or integers that are exact; any
// byte order, any order of the memory. It is read piece by piece, so that 100 million rays need no
// more memory than the piece. .csv: with or without a line of titles, between commas, semicolons,
// tabs or blanks, with decimal points or (not between commas) decimal commas; it is read at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "pierce/types.h"

namespace pierce::io {

/// A table of numbers with a fixed set of columns; what both RayFile and PointFile are.
class NumberTable;

/// What both can tell. Safe to read from several threads.
class TableFile {
 public:
  TableFile(TableFile&&) noexcept;
  TableFile& operator=(TableFile&&) noexcept;
  ~TableFile();

  [[nodiscard]] std::uint64_t size() const;
  /// Every number is of a type that float holds exactly (a file of text never is; rows in memory
  /// are if each number is a float).
  [[nodiscard]] bool single_precision() const;
  /// Every number is an integer: what float cannot hold is refused, not rounded.
  [[nodiscard]] bool whole_numbers() const;
  [[nodiscard]] const std::string& name() const;
  /// What the user should know of how the file was read; a line each, which begins with its name.
  [[nodiscard]] const std::vector<std::string>& remarks() const;

 protected:
  explicit TableFile(std::unique_ptr<NumberTable> table);
  std::unique_ptr<NumberTable> table_;
};

/// Rays: `ox oy oz dx dy dz [t_min t_max]`.
class RayFile : public TableFile {
 public:
  /// Throws Error (BadFile) if the file cannot be read or is no table of rays. Whether the rays are
  /// valid (finite, direction not zero) is the batch's to say: it names the row.
  explicit RayFile(const std::filesystem::path& path);
  /// Rows of eight numbers in memory; `name` is for errors.
  RayFile(std::vector<double> rows, std::string name);

  /// Rays first ... first + out.size() - 1. Double numbers read as float are rounded to nearest;
  /// finite numbers beyond the floats throw Error (BadFile) naming the row.
  template <class Real>
  void read(std::uint64_t first, std::span<Ray<Real>> out) const;
};

/// Points: `x y z`.
class PointFile : public TableFile {
 public:
  explicit PointFile(const std::filesystem::path& path);
  PointFile(std::vector<double> rows, std::string name);

  template <class Real>
  void read(std::uint64_t first, std::span<Vec3<Real>> out) const;
};

extern template void RayFile::read(std::uint64_t, std::span<Ray<float>>) const;
extern template void RayFile::read(std::uint64_t, std::span<Ray<double>>) const;
extern template void PointFile::read(std::uint64_t, std::span<Vec3<float>>) const;
extern template void PointFile::read(std::uint64_t, std::span<Vec3<double>>) const;

}  // namespace pierce::io
