// SPDX-License-Identifier: Apache-2.0
//
// pierce locate: a file of points against a closed mesh, to a file that says which are inside, on
// the surface and outside.
#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "command.h"
#include "inside_options.h"
#include "interrupt.h"
#include "io/hits.h"
#include "loaded_scene.h"
#include "output.h"
#include "point_options.h"

namespace pierce::tool {
namespace {

struct Options : PointOptions {
  InsideOptions inside;
};

struct Totals {
  LocationCounts counts;
  double seconds = 0;
  Statistics statistics;
};

template <class Real>
Totals locate_all(const Options& options, const Scene<Real>& scene, const io::PointFile& file) {
  const interrupt::Graceful graceful;
  Totals totals;
  LocateOptions locate = locate_options(options.inside, options.threads);
  locate.work.stop = interrupt::stop();
  if (!options.quiet) locate.work.statistics = &totals.statistics;

  io::LocationWriter writer(options.out);
  std::vector<Location> locations;
  const auto ask = [&](std::span<const Vec3<Real>> points, const Progress& progress) {
    locate.work.progress = progress;
    locations.resize(points.size());
    scene.locate(points, locations, locate);
    totals.counts.add(locations);
  };
  totals.seconds =
      for_point_chunks<Real>(options, file, "locate", ask, [&] { writer.append(locations); });
  writer.finish();
  return totals;
}

template <class Real>
void summarise(const Options& options, const LoadedScene<Real>& mesh, const Totals& totals) {
  Summary table;
  mesh.add_size_to(table);
  table.add("points", grouped(totals.counts.all()));
  totals.counts.add_to(table);
  mesh.add_to(table);
  table.add("locate", timing(totals.seconds, totals.counts.all(), "points"));
  table.add("exact arithmetic", exact_decisions(totals.statistics));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int locate_as(const Options& options, std::vector<Geometry> meshes, const io::PointFile& points) {
  const LoadedScene<Real> scene(std::move(meshes), {.work = {.threads = options.threads}});
  const Totals totals = locate_all(options, scene.scene(), points);
  if (!options.quiet) summarise(options, scene, totals);
  return 0;
}

int run(const Options& options) {
  return run_on_points(options,
                       [&]<class Real>(std::vector<Geometry> meshes, const io::PointFile& points) {
                         return locate_as<Real>(options, std::move(meshes), points);
                       });
}

}  // namespace

Command add_locate(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("locate", "Tell which points are inside a closed mesh");
  const auto options = std::make_shared<Options>();
  add_mesh_arguments(*sub, options->meshes);
  add_points_option(*sub, *options);
  add_out_option(*sub, *options,
                 "Answers: .npy or .csv, one int8 a point: 1 inside, 0 on the surface, -1 outside");
  add_inside_options(*sub, options->inside);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce locate bunny.obj --points points.npy --out inside.npy\n"
      "  pierce locate scan.ply --points points.csv --out inside.csv --open-mesh\n"
      "A mesh that is not closed is refused: its inside is not defined. `pierce info MESH\n"
      "--open-edges FILE` lists all edges that are open. Several meshes are one surface.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
