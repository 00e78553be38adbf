// SPDX-License-Identifier: Apache-2.0
//
// Rays and points in: .npy (2-D float32 or float64, C order, either byte order) or .csv.
//
// A .npy file is read piece by piece, so that 100 million rays need no more memory than the piece;
// a .csv file is read at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "pierce/types.h"

namespace pierce::io {

/// A table of numbers with a fixed set of allowed widths; what both RayFile and PointFile are.
class NumberTable;

/// An open file of rays: `ox oy oz dx dy dz [t_min t_max]`. Safe to read from several threads.
class RayFile {
 public:
  /// Throws Error (BadFile) if the file cannot be read or is no table of 6 or 8 columns. Whether
  /// the rays are valid (finite, direction not zero) is the batch's to say: it names the row.
  explicit RayFile(const std::filesystem::path& path);
  RayFile(RayFile&&) noexcept;
  RayFile& operator=(RayFile&&) noexcept;
  ~RayFile();

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] bool single_precision() const;  ///< float32; text never is

  /// Rays first ... first + out.size() - 1. Double numbers read as float are rounded to nearest;
  /// finite numbers beyond the floats throw Error (BadFile) naming the row.
  template <class Real>
  void read(std::uint64_t first, std::span<Ray<Real>> out) const;

 private:
  std::unique_ptr<NumberTable> table_;
};

/// An open file of points: `x y z`.
class PointFile {
 public:
  explicit PointFile(const std::filesystem::path& path);
  PointFile(PointFile&&) noexcept;
  PointFile& operator=(PointFile&&) noexcept;
  ~PointFile();

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] bool single_precision() const;

  template <class Real>
  void read(std::uint64_t first, std::span<Vec3<Real>> out) const;

 private:
  std::unique_ptr<NumberTable> table_;
};

extern template void RayFile::read(std::uint64_t, std::span<Ray<float>>) const;
extern template void RayFile::read(std::uint64_t, std::span<Ray<double>>) const;
extern template void PointFile::read(std::uint64_t, std::span<Vec3<float>>) const;
extern template void PointFile::read(std::uint64_t, std::span<Vec3<double>>) const;

}  // namespace pierce::io
