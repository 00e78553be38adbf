// SPDX-License-Identifier: Apache-2.0
#include "io/rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <utility>

#include "io/number_table.h"
#include "pierce/error.h"

namespace pierce::io {
namespace {

constexpr double kInf = kInfinity<double>;
constexpr std::array<TableColumn, 8> kRayColumns = {{{"ox"},
                                                     {"oy"},
                                                     {"oz"},
                                                     {"dx"},
                                                     {"dy"},
                                                     {"dz"},
                                                     {"t_min", "tmin", 0},
                                                     {"t_max", "tmax", kInf}}};
constexpr std::array<TableTriple, 2> kRayTriples = {{{"origin", 0}, {"direction", 3}}};
constexpr TableShape kRays = {"rays", kRayColumns, 6, kRayTriples};
constexpr std::array<TableColumn, 3> kPointColumns = {{{"x"}, {"y"}, {"z"}}};
constexpr std::array<TableTriple, 1> kPointTriples = {{{"point", 0}}};
constexpr TableShape kPoints = {"points", kPointColumns, 3, kPointTriples, true};

std::unique_ptr<NumberTable> from_memory(std::vector<double> rows, std::string name,
                                         const TableShape& shape) {
  TableNumbers numbers;
  numbers.single_precision = std::all_of(rows.begin(), rows.end(), [](double x) {
    return static_cast<double>(static_cast<float>(x)) == x;
  });
  numbers.numbers = std::move(rows);
  numbers.columns.resize(shape.columns.size());
  std::iota(numbers.columns.begin(), numbers.columns.end(), std::size_t{0});
  return make_table(std::move(numbers), std::move(name), shape);
}

// A row of the table is one Item: so many Reals, one after the other.
template <class Real, class Item>
void read_items(const NumberTable& table, std::uint64_t first, std::span<Item> out) {
  if (first > table.rows() || out.size() > table.rows() - first) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: rows {} to {} of {} do not exist", table.name(), first,
                            first + out.size(), table.rows()));
  }
  static_assert(sizeof(Item) % sizeof(Real) == 0);
  if (out.empty()) return;
  table.read(first, std::span(reinterpret_cast<Real*>(out.data()),
                              out.size() * (sizeof(Item) / sizeof(Real))));
}

template <class Real>
constexpr bool kRayIsARow = sizeof(Ray<Real>) == 8 * sizeof(Real) &&
                            offsetof(Ray<Real>, direction) == 3 * sizeof(Real) &&
                            offsetof(Ray<Real>, t_min) == 6 * sizeof(Real) &&
                            offsetof(Ray<Real>, t_max) == 7 * sizeof(Real);
static_assert(kRayIsARow<float> && kRayIsARow<double>);

}  // namespace

TableFile::TableFile(std::unique_ptr<NumberTable> table) : table_(std::move(table)) {}
TableFile::TableFile(TableFile&&) noexcept = default;
TableFile& TableFile::operator=(TableFile&&) noexcept = default;
TableFile::~TableFile() = default;

std::uint64_t TableFile::size() const { return table_->rows(); }
bool TableFile::single_precision() const { return table_->single_precision(); }
bool TableFile::whole_numbers() const { return table_->whole_numbers(); }
const std::string& TableFile::name() const { return table_->name(); }
const std::vector<std::string>& TableFile::remarks() const { return table_->remarks(); }

RayFile::RayFile(const std::filesystem::path& path) : TableFile(open_table(path, kRays)) {}
RayFile::RayFile(std::vector<double> rows, std::string name)
    : TableFile(from_memory(std::move(rows), std::move(name), kRays)) {}

template <class Real>
void RayFile::read(std::uint64_t first, std::span<Ray<Real>> out) const {
  read_items<Real>(*table_, first, out);
}

PointFile::PointFile(const std::filesystem::path& path) : TableFile(open_table(path, kPoints)) {}
PointFile::PointFile(std::vector<double> rows, std::string name)
    : TableFile(from_memory(std::move(rows), std::move(name), kPoints)) {}

template <class Real>
void PointFile::read(std::uint64_t first, std::span<Vec3<Real>> out) const {
  read_items<Real>(*table_, first, out);
}

template void RayFile::read(std::uint64_t, std::span<Ray<float>>) const;
template void RayFile::read(std::uint64_t, std::span<Ray<double>>) const;
template void PointFile::read(std::uint64_t, std::span<Vec3<float>>) const;
template void PointFile::read(std::uint64_t, std::span<Vec3<double>>) const;

}  // namespace pierce::io
