// SPDX-License-Identifier: Apache-2.0
#include "shown_rays.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "cast_options.h"
#include "failure.h"
#include "geometries.h"
#include "interrupt.h"
#include "io/number_table.h"
#include "output.h"

namespace pierce::tool {
namespace {

// More than a page can be asked to draw.
constexpr std::uint64_t kMostRows = std::uint64_t{1} << 20;

void refuse_too_many(std::uint64_t rows, const char* option, const std::string& name) {
  if (rows <= kMostRows) return;
  throw Error(ErrorCode::BadFile,
              fmt::format("{}: {} rows, and a page shows {} at most: give {} fewer", name,
                          grouped(rows), grouped(kMostRows), option));
}

std::uint32_t to_number(double x, const std::string& name, std::uint64_t row) {
  if (x >= 0 && x <= 0x1p32 - 1 && x == static_cast<double>(static_cast<std::uint32_t>(x)))
    return static_cast<std::uint32_t>(x);
  if (x == -1) return kNone;  // as the Python package writes a miss
  throw Error(
      ErrorCode::BadFile,
      fmt::format("{}, row {}: {} is no number of a ray, a geometry or a triangle", name, row, x));
}

}  // namespace

std::optional<io::RayFile> open_shown_rays(const std::string& path) {
  if (path.empty()) return std::nullopt;
  std::optional<io::RayFile> rays(std::in_place, path);
  print_warnings(rays->remarks(), false);
  refuse_too_many(rays->size(), "--rays", path);
  return rays;
}

template <class Real>
std::vector<Ray<Real>> read_shown_rays(const std::optional<io::RayFile>& file) {
  std::vector<Ray<Real>> rays(file ? file->size() : 0);
  if (file) file->read(0, std::span(rays));
  return rays;
}

template <class Real>
std::vector<io::ViewHit<Real>> read_shown_hits(const std::string& path) {
  static constexpr io::TableColumn kColumns[] = {
      {"t"}, {"u"}, {"v"}, {"w"}, {"geometry"}, {"triangle"}, {"facing"}, {"ray", {}, -1}};
  const auto table = io::open_table(path, {"hits", kColumns, 6});
  print_warnings(table->remarks(), false);
  refuse_too_many(table->rows(), "--hits", path);
  constexpr std::size_t kWidth = std::size(kColumns);
  std::vector<double> numbers(table->rows() * kWidth);
  table->read(0, std::span(numbers));
  std::vector<io::ViewHit<Real>> hits(table->rows());
  bool known = false;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double* row = numbers.data() + i * kWidth;
    for (std::size_t k = 0; k < 4; ++k) hits[i].numbers[k] = static_cast<Real>(row[k]);
    hits[i].names = {to_number(row[7], path, i), to_number(row[4], path, i),
                     to_number(row[5], path, i)};
    known = known || hits[i].names[0] != kNone;
  }
  if (!known) {
    for (std::size_t i = 0; i < hits.size(); ++i) hits[i].names[0] = static_cast<std::uint32_t>(i);
  }
  return hits;
}

template <class Real>
std::vector<io::ViewHit<Real>> first_hits(const std::string& name, const Scene<Real>& scene,
                                          std::span<const Ray<Real>> rays, unsigned threads) {
  BatchOptions batch;
  batch.work.threads = threads;
  batch.work.stop = interrupt::stop();
  std::vector<Hit<Real>> found(rays.size());
  naming_rays<Real>(name, 0, scene, rays, [&] { scene.closest_hits(rays, found, batch); });
  std::vector<io::ViewHit<Real>> hits;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Hit<Real>& hit = found[i];
    hits.push_back({{hit.t, hit.u, hit.v, hit.w},
                    {static_cast<std::uint32_t>(i), hit.geometry, hit.triangle}});
  }
  return hits;
}

template std::vector<Ray<float>> read_shown_rays(const std::optional<io::RayFile>&);
template std::vector<Ray<double>> read_shown_rays(const std::optional<io::RayFile>&);
template std::vector<io::ViewHit<float>> read_shown_hits(const std::string&);
template std::vector<io::ViewHit<double>> read_shown_hits(const std::string&);
template std::vector<io::ViewHit<float>> first_hits(const std::string&, const Scene<float>&,
                                                    std::span<const Ray<float>>, unsigned);
template std::vector<io::ViewHit<double>> first_hits(const std::string&, const Scene<double>&,
                                                     std::span<const Ray<double>>, unsigned);

}  // namespace pierce::tool
