// SPDX-License-Identifier: Apache-2.0
//
// pierce view: a mesh, rays and hits as one page for a browser.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cast_options.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/extension.h"
#include "io/number_table.h"
#include "io/output_file.h"
#include "io/rays.h"
#include "io/view_page.h"
#include "loaded_scene.h"
#include "output.h"
#include "render/camera.h"

namespace pierce::tool {
namespace {

struct ViewArguments : FileOptions {
  std::string rays, hits;
};

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

// Hits as `pierce cast` writes them, of the first or of all. If there are as many as rays and none
// says of which it is, each is its row's.
template <class Real>
std::vector<io::ViewHit<Real>> read_hits(const std::string& path) {
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
std::vector<io::ViewHit<Real>> first_hits(const ViewArguments& options, const Scene<Real>& scene,
                                          std::span<const Ray<Real>> rays) {
  BatchOptions batch;
  batch.work.threads = options.threads;
  batch.work.stop = interrupt::stop();
  std::vector<Hit<Real>> found(rays.size());
  naming_rays<Real>(options.rays, 0, scene, rays, [&] { scene.closest_hits(rays, found, batch); });
  std::vector<io::ViewHit<Real>> hits;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Hit<Real>& hit = found[i];
    hits.push_back({{hit.t, hit.u, hit.v, hit.w},
                    {static_cast<std::uint32_t>(i), hit.geometry, hit.triangle}});
  }
  return hits;
}

template <class Real>
int view_as(const ViewArguments& options, std::vector<Geometry> geometries,
            const std::optional<io::RayFile>& file) {
  io::ViewContent<Real> content;
  content.title = name_of(options.meshes.files);
  content.z_up = has_z_up(options.meshes.files);
  std::vector<std::string> names;
  for (const Geometry& geometry : geometries) names.push_back(geometry.name());
  const interrupt::Graceful graceful;
  std::vector<Ray<Real>> rays(file ? file->size() : 0);
  if (file) file->read(0, std::span(rays));
  content.rays = rays;

  std::optional<LoadedScene<Real>> scene;
  std::optional<Meshes<Real>> meshes;
  if (!options.hits.empty()) {
    content.hits = read_hits<Real>(options.hits);
  } else if (file) {
    scene.emplace(std::move(geometries), BuildOptions{.work = {.threads = options.threads}});
    content.hits = first_hits<Real>(options, scene->scene(), rays);
  }
  if (!scene) meshes.emplace(std::move(geometries));
  const auto views = scene ? scene->views() : meshes->views();
  for (std::size_t i = 0; i < views.size(); ++i) content.meshes.push_back({names[i], views[i]});

  io::OutputFile out(options.out);
  std::uint64_t bytes = 0;
  naming_file(options.hits.empty() ? content.title : options.hits, [&] {
    io::write_view_page<Real>(content, [&](std::string_view part) {
      interrupt::check();
      out.write(part);
      bytes += part.size();
    });
  });
  out.commit();
  if (options.quiet) return 0;
  Summary table;
  std::uint64_t triangles = 0;
  for (const MeshView<Real>& view : views) triangles += view.triangles.size();
  table.add("triangles", grouped(triangles));
  if (file) table.add("rays", grouped(rays.size()));
  if (!content.hits.empty()) {
    std::uint64_t hits = 0;
    for (const auto& hit : content.hits) hits += hit.names[2] != kNone ? 1 : 0;
    table.add("hits", grouped(hits));
  }
  table.add("wrote", fmt::format("{}, {}", out_name(options), memory(bytes)));
  remark(table.text());
  return 0;
}

int run(const ViewArguments& options) {
  if (options.out != "-") check_extension(options.out, {".html", ".htm"});
  refuse_to_replace(options.out, inputs(options.meshes, {options.rays, options.hits}));
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  std::optional<io::RayFile> rays;
  if (!options.rays.empty()) {
    rays.emplace(options.rays);
    print_warnings(rays->remarks(), false);
    refuse_too_many(rays->size(), "--rays", options.rays);
  }
  const bool single = !rays || counts_as_single(*rays, options.precision);
  return choose_float(options.precision, meshes, options.rays, single)
             ? view_as<float>(options, std::move(meshes), rays)
             : view_as<double>(options, std::move(meshes), rays);
}

}  // namespace

Command add_view(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("view", "Show a mesh, rays and hits in a browser");
  const auto options = std::make_shared<ViewArguments>();
  add_mesh_arguments(*sub, options->meshes);
  sub->add_option("--rays", options->rays, "Rays to draw: .npy or .csv, as for cast");
  sub->add_option("--hits", options->hits,
                  "Hits to draw, as cast wrote them (closest or all); default: the first hit of "
                  "each ray");
  add_out_option(*sub, *options, "Page: .html; - is standard output");
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  add_quiet_flag(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce view bunny.obj --out bunny.html\n"
      "  pierce view bunny.obj --rays rays.npy --out bunny.html\n"
      "  pierce view room.ply chair.obj --rays rays.npy --hits hits.npy --out room.html\n"
      "The page is one file that needs no network and no server, only a browser with WebGL 2.\n"
      "Drag to turn, with Shift to move, wheel to come nearer; a click tells which triangle or "
      "hit\n"
      "is there, and its numbers as they are in the file.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
