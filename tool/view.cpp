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

#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/output_file.h"
#include "io/rays.h"
#include "io/view_page.h"
#include "loaded_scene.h"
#include "output.h"
#include "render/camera.h"
#include "shown_rays.h"

namespace pierce::tool {
namespace {

struct ViewArguments : FileOptions {
  std::string rays, hits;
};

template <class Real>
int view_as(const ViewArguments& options, std::vector<Geometry> geometries,
            const std::optional<io::RayFile>& file) {
  io::ViewContent<Real> content;
  content.title = name_of(options.meshes.files);
  content.z_up = has_z_up(options.meshes.files);
  std::vector<std::string> names;
  for (const Geometry& geometry : geometries) names.push_back(geometry.name());
  const interrupt::Graceful graceful;
  const std::vector<Ray<Real>> rays = read_shown_rays<Real>(file);
  content.rays = rays;

  std::optional<LoadedScene<Real>> scene;
  std::optional<Meshes<Real>> meshes;
  if (!options.hits.empty()) {
    content.hits = read_shown_hits<Real>(options.hits);
  } else if (file) {
    scene.emplace(std::move(geometries), BuildOptions{.work = {.threads = options.threads}});
    content.hits = first_hits<Real>(options.rays, scene->scene(), rays, options.threads);
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
  const std::optional<io::RayFile> rays = open_shown_rays(options.rays);
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
