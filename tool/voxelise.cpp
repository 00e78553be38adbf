// SPDX-License-Identifier: Apache-2.0
//
// pierce voxelise: a closed mesh to a grid of cells, a .npy file of three dimensions. The grid goes
// through a few layers at a time, so that its size does not matter.
#include "pierce/voxelise.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "bounds.h"
#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "grid_options.h"
#include "inside_options.h"
#include "interrupt.h"
#include "io/npy.h"
#include "io/output_file.h"
#include "loaded_scene.h"
#include "output.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

constexpr std::uint64_t kCells = std::uint64_t{1} << 26;  // cells at a time, 64 MiB

enum class CellType : std::uint8_t { Int8, Bool };

struct VoxeliseArguments : FileOptions {
  GridOptions grid;
  CellType type = CellType::Int8;
  InsideOptions inside;
};

std::string header_of(const std::array<std::uint32_t, 3>& size, CellType type) {
  const std::array<std::uint64_t, 3> shape = {size[0], size[1], size[2]};
  return io::make_npy_header(type == CellType::Bool ? "'|b1'" : "'|i1'", shape);
}

struct VoxeliseTotals {
  LocationCounts counts;
  double seconds = 0;
};

template <class Real>
VoxeliseTotals voxelise_all(const VoxeliseArguments& options, const Scene<Real>& scene,
                            const Grid<Real>& grid) {
  static_assert(sizeof(Location) == 1, "locations are written as they are");
  const interrupt::Graceful graceful;
  VoxeliseTotals totals;
  LocateOptions locate = locate_options(options.inside, options.threads);
  locate.work.stop = interrupt::stop();
  io::OutputFile file(options.out);
  const std::string header = header_of(grid.size, options.type);
  file.reserve(header.size() + grid.cells());
  file.write(header);
  ProgressBar bar("voxelise");
  const std::uint64_t layer = std::uint64_t{grid.size[1]} * grid.size[2];
  const auto step =
      static_cast<std::uint32_t>(std::clamp<std::uint64_t>(kCells / layer, 1, grid.size[0]));
  std::vector<Location> cells;
  for (std::uint32_t first = 0; first < grid.size[0]; first += step) {
    interrupt::check();
    const std::uint32_t layers = std::min(step, grid.size[0] - first);
    cells.resize(layers * layer);
    locate.work.progress = bar.callback(static_cast<double>(first) / grid.size[0],
                                        static_cast<double>(first + layers) / grid.size[0]);
    const Stopwatch watch;
    naming_meshes(options.meshes, [&] { scene.voxelise(grid, first, layers, cells, locate); });
    totals.seconds += watch.seconds();
    totals.counts.add(cells);
    if (options.type == CellType::Bool) {
      for (Location& cell : cells) cell = Location(cell == Location::Outside ? 0 : 1);
    }
    file.write({reinterpret_cast<const char*>(cells.data()), cells.size()});
  }
  interrupt::check();
  file.commit();
  return totals;
}

template <class Real>
std::string text_of(const Vec3<Real>& v) {
  return fmt::format("{},{},{}", v.x, v.y, v.z);
}

template <class Real>
void summarise(const VoxeliseArguments& options, const LoadedScene<Real>& mesh,
               const Grid<Real>& grid, const VoxeliseTotals& totals) {
  Summary table;
  mesh.add_size_to(table);
  table.add("cells", fmt::format("{} = {}x{}x{}", grouped(grid.cells()), grid.size[0], grid.size[1],
                                 grid.size[2]));
  table.add("origin", text_of(grid.origin));
  table.add("spacing", text_of(grid.spacing));
  totals.counts.add_to(table);
  mesh.add_to(table);
  table.add("voxelise", timing(totals.seconds, grid.cells(), "cells"));
  table.add("wrote", out_name(options));
  remark(table.text());
}

template <class Real>
void summarise_json(const VoxeliseArguments& options, const LoadedScene<Real>& scene,
                    const Grid<Real>& grid, const VoxeliseTotals& totals) {
  io::JsonWriter json = begin_json("voxelise", options, scene);
  json.value("cells", grid.cells());
  json.values("size", std::vector<std::uint32_t>(grid.size.begin(), grid.size.end()));
  json.values("origin", std::vector{grid.origin.x, grid.origin.y, grid.origin.z});
  json.values("spacing", std::vector{grid.spacing.x, grid.spacing.y, grid.spacing.z});
  totals.counts.add_to(json);
  json.value("seconds", totals.seconds);
  json.value("out", options.out);
  finish_json(json);
}

template <class Real>
int voxelise_as(const VoxeliseArguments& options, std::vector<Geometry> meshes) {
  const LoadedScene<Real> scene(std::move(meshes), {.work = {.threads = options.threads}});
  const Grid<Real> grid = make_grid<Real>(options.grid, box_of(scene.views()));
  const VoxeliseTotals totals = voxelise_all(options, scene.scene(), grid);
  remark_on_cancelling(totals.counts, options.inside, scene);
  if (options.json) {
    summarise_json(options, scene, grid, totals);
  } else if (!options.quiet) {
    summarise(options, scene, grid, totals);
  }
  return 0;
}

int run(const VoxeliseArguments& options) {
  require_npy(options.out);
  if (options.out == "-") check_answer_options(options);
  refuse_to_replace(options.out, inputs(options.meshes));
  check_grid_options(options.grid);  // before the mesh is read
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  return choose_float(options.precision, meshes, "--origin and --spacing",
                      grid_is_float(options.grid))
             ? voxelise_as<float>(options, std::move(meshes))
             : voxelise_as<double>(options, std::move(meshes));
}

}  // namespace

Command add_voxelise(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("voxelise", "Turn a closed mesh into a grid of cells");
  const auto options = std::make_shared<VoxeliseArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_out_option(*sub, *options,
                 "Grid: .npy with three dimensions x y z, z fastest; 1 inside, 0 on the surface, "
                 "-1 outside; - is standard output");
  add_grid_options(*sub, options->grid);
  add_choice<CellType>(*sub, "--type", options->type,
                       {{"int8", CellType::Int8}, {"bool", CellType::Bool}},
                       "bool: true inside and on the surface");
  add_inside_options(*sub, options->inside);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce voxelise bunny.obj --size 512 --out grid.npy\n"
      "  pierce voxelise part.stl --size 100x80x60 --origin 0,0,0 --spacing 0.5 --out grid.npy\n"
      "A cell is what `pierce locate` says of its centre, origin + (index + 1/2) spacing rounded\n"
      "once. The summary tells origin and spacing in full.\n"
      "--json prints one object: command mesh meshes geometries triangles precision build_seconds\n"
      "cells size origin spacing inside on_surface outside seconds out.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
