// SPDX-License-Identifier: Apache-2.0
#include "io/rays.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "io/bad_file.h"
#include "io/mapped_file.h"
#include "io/number_table.h"
#include "io/text_cursor.h"
#include "pierce/error.h"

namespace pierce::io {
namespace {

constexpr std::array<std::string_view, 8> kRayColumns = {"ox", "oy", "oz",    "dx",
                                                         "dy", "dz", "t_min", "t_max"};
constexpr TableShape kRays = {"rays", kRayColumns, 6};
constexpr std::array<std::string_view, 3> kPointColumns = {"x", "y", "z"};
constexpr TableShape kPoints = {"points", kPointColumns, 3};

// A number of the table in the type asked for.
template <class Real>
Real convert(double value, const NumberTable& table, std::uint64_t row) {
  const Real converted = static_cast<Real>(value);
  if (std::isfinite(value) && !std::isfinite(converted)) {
    bad_file(table.name(), fmt::format("row {}: {} does not fit the range of float: use double "
                                       "precision",
                                       row, value));
  }
  return converted;
}

// Calls use(i, row) for the rows first + i of the table, i < count.
template <class Use>
void for_each_row(const NumberTable& table, std::uint64_t first, std::size_t count, Use use) {
  if (first > table.rows() || count > table.rows() - first) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: rows {} to {} of {} do not exist", table.name(), first,
                            first + count, table.rows()));
  }
  constexpr std::size_t kPieceRows = 1024;
  std::vector<double> piece;
  for (std::size_t done = 0; done < count;) {
    const std::size_t rows = std::min(count - done, kPieceRows);
    piece.resize(rows * table.columns());
    table.read(first + done, piece);
    for (std::size_t i = 0; i < rows; ++i) use(done + i, piece.data() + i * table.columns());
    done += rows;
  }
}

}  // namespace

std::unique_ptr<NumberTable> open_table(const std::filesystem::path& path,
                                        const TableShape& shape) {
  // The content decides; a name that promises .npy must keep the promise.
  bool is_npy = same_word(path.extension().string(), ".npy");
  if (!is_npy) is_npy = MappedFile(path).bytes().starts_with("\x93NUMPY");
  return is_npy ? open_npy_table(path, shape) : open_csv_table(path, shape);
}

RayFile::RayFile(const std::filesystem::path& path) : table_(open_table(path, kRays)) {}
RayFile::RayFile(RayFile&&) noexcept = default;
RayFile& RayFile::operator=(RayFile&&) noexcept = default;
RayFile::~RayFile() = default;

std::uint64_t RayFile::size() const { return table_->rows(); }
bool RayFile::single_precision() const { return table_->single_precision(); }

template <class Real>
void RayFile::read(std::uint64_t first, std::span<Ray<Real>> out) const {
  const NumberTable& table = *table_;
  const bool has_range = table.columns() == kRayColumns.size();
  for_each_row(table, first, out.size(), [&](std::size_t i, const double* row) {
    const auto at = [&](std::size_t k) { return convert<Real>(row[k], table, first + i); };
    Ray<Real> ray{{at(0), at(1), at(2)}, {at(3), at(4), at(5)}};
    if (has_range) {
      ray.t_min = at(6);
      ray.t_max = at(7);
    }
    out[i] = ray;
  });
}

PointFile::PointFile(const std::filesystem::path& path) : table_(open_table(path, kPoints)) {}
PointFile::PointFile(PointFile&&) noexcept = default;
PointFile& PointFile::operator=(PointFile&&) noexcept = default;
PointFile::~PointFile() = default;

std::uint64_t PointFile::size() const { return table_->rows(); }
bool PointFile::single_precision() const { return table_->single_precision(); }

template <class Real>
void PointFile::read(std::uint64_t first, std::span<Vec3<Real>> out) const {
  const NumberTable& table = *table_;
  for_each_row(table, first, out.size(), [&](std::size_t i, const double* row) {
    const auto at = [&](std::size_t k) { return convert<Real>(row[k], table, first + i); };
    out[i] = {at(0), at(1), at(2)};
  });
}

template void RayFile::read(std::uint64_t, std::span<Ray<float>>) const;
template void RayFile::read(std::uint64_t, std::span<Ray<double>>) const;
template void PointFile::read(std::uint64_t, std::span<Vec3<float>>) const;
template void PointFile::read(std::uint64_t, std::span<Vec3<double>>) const;

}  // namespace pierce::io
