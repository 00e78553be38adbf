// SPDX-License-Identifier: Apache-2.0
#include "grid_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include "failure.h"
#include "parse.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

struct Size {
  std::array<std::uint32_t, 3> cells;
  bool cubes;  // a single number: as many along the longest side, and cells that are cubes
};

constexpr unsigned kMostCells = 1U << 21;  // along a side, see pierce/voxelise.h

// "512" or "640x480x320".
Size parse_grid_size(const std::string& text) {
  Size size{};
  std::size_t count = 0;
  std::string_view rest = text;
  for (;;) {
    const std::string_view part = rest.substr(0, rest.find('x'));
    unsigned number = 0;
    const char* end = part.data() + part.size();
    const auto [stop, error] = std::from_chars(part.data(), end, number);
    const bool good = error == std::errc{} && stop == end && number > 0 && count < 3;
    if (good) size.cells[count++] = number;
    const bool last = part.size() == rest.size();
    if (good && !last) {
      rest.remove_prefix(part.size() + 1);
      continue;
    }
    if (good && (count == 1 || count == 3)) break;
    throw UsageError("--size: '" + text +
                     "' is not a number of cells; give N or NXxNYxNZ, as in 512 or 640x480x320");
  }
  const unsigned most = *std::max_element(size.cells.begin(), size.cells.end());
  if (most > kMostCells) {
    throw UsageError(fmt::format("--size: {} cells along a side: at most {}", most, kMostCells));
  }
  size.cubes = count == 1;
  if (size.cubes) size.cells.fill(size.cells[0]);
  return size;
}

template <class Real>
Vec3<Real> to_real(const std::array<double, 3>& v) {
  return {static_cast<Real>(v[0]), static_cast<Real>(v[1]), static_cast<Real>(v[2])};
}

std::array<double, 3> to_array(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

// One number or three.
std::array<double, 3> parse_spacing(const std::string& text) {
  const bool one = parse_list(text, "--spacing").size() == 1;
  const std::vector<double> n = parse_numbers(text, one ? 1 : 3, "--spacing");
  for (const double s : n) {
    if (!(s > 0)) throw UsageError(fmt::format("--spacing: {} is not greater than 0", s));
  }
  return one ? std::array{n[0], n[0], n[0]} : std::array{n[0], n[1], n[2]};
}

// A layer that is only there because 0.3, 0.2 and 0.1 are no doubles (or floats) is none.
template <class Real>
double cells_to_cover(double lower, double upper, double spacing) {
  constexpr auto kUlp = static_cast<double>(std::numeric_limits<Real>::epsilon());
  const double cells = (upper - lower) / spacing, whole = std::round(cells);
  const double largest = std::max(std::fabs(lower), std::fabs(upper));
  const double rounding = 2 * kUlp * (largest / spacing + cells);
  return std::fabs(cells - whole) <= rounding ? whole : std::ceil(cells);
}

}  // namespace

template <class Real>
Grid<Real> make_grid(const GridOptions& options, const Box& box) {
  Size size = parse_grid_size(options.size);
  const std::array<double, 3> upper = to_array(box.high);
  const std::array<double, 3> origin =
      to_array(options.origin.empty() ? box.low : parse_vector(options.origin, "--origin"));
  std::array<double, 3> spacing{};
  if (!options.spacing.empty()) {
    spacing = parse_spacing(options.spacing);
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // Halves, so that a box from -1e308 to 1e308 does not overflow.
      spacing[axis] = (upper[axis] / 2 - origin[axis] / 2) / size.cells[axis] * 2;
    }
    const double largest = *std::max_element(spacing.begin(), spacing.end());
    if (!(largest > 0)) {
      throw UsageError("no part of the mesh lies above --origin; give --spacing, too");
    }
    for (double& s : spacing) s = size.cubes || !(s > 0) ? largest : s;
  }
  Grid<Real> grid{to_real<Real>(origin), to_real<Real>(spacing), size.cells};
  if (size.cubes && options.spacing.empty()) {  // no more cells than it takes to cover the mesh
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto step = static_cast<double>(component(grid.spacing, static_cast<int>(axis)));
      const double needed = cells_to_cover<Real>(origin[axis], upper[axis], step);
      grid.size[axis] = static_cast<std::uint32_t>(
          std::clamp(needed, 1.0, static_cast<double>(size.cells[axis])));
    }
  }
  return grid;
}

template Grid<float> make_grid(const GridOptions&, const Box&);
template Grid<double> make_grid(const GridOptions&, const Box&);

bool grid_is_float(const GridOptions& options) {
  const auto all_float = [](const std::string& text, const char* option) {
    const std::vector<double> list =
        text.empty() ? std::vector<double>{} : parse_list(text, option);
    return std::all_of(list.begin(), list.end(),
                       [](double x) { return static_cast<double>(static_cast<float>(x)) == x; });
  };
  return all_float(options.origin, "--origin") && all_float(options.spacing, "--spacing");
}

void check_grid_options(const GridOptions& options) { (void)parse_grid_size(options.size); }

void add_grid_options(CLI::App& app, GridOptions& options) {
  app.add_option("--size", options.size,
                 "Cells along the longest side (512), or along each (640x480x320)")
      ->type_name("N|NXxNYxNZ")
      ->required();
  app.add_option("--origin", options.origin, "Lower corner of the grid; default: of the mesh")
      ->type_name("X,Y,Z");
  app.add_option("--spacing", options.spacing, "Size of a cell; default: to cover the mesh")
      ->type_name("S|X,Y,Z");
}

}  // namespace pierce::tool
