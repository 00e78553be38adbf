// SPDX-License-Identifier: Apache-2.0
//
// pierce locate: points against a closed mesh, to a file that says which are inside, on the surface
// and outside, or to words.
#include <CLI/CLI.hpp>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "answer_printer.h"
#include "command.h"
#include "inside_options.h"
#include "interrupt.h"
#include "io/hits.h"
#include "loaded_scene.h"
#include "output.h"
#include "point_options.h"
#include "words.h"

namespace pierce::tool {
namespace {

struct LocateArguments : PointOptions {
  InsideOptions inside;
};

struct LocateTotals {
  LocationCounts counts;
  double seconds = 0;
  Statistics statistics;
};

/// Hands the answers of one chunk after the other to `write`.
template <class Real, class Write>
LocateTotals locate_all(const LocateArguments& options, const Scene<Real>& scene,
                        const io::PointFile& file, const Write& write) {
  const interrupt::Graceful graceful;
  LocateTotals totals;
  LocateOptions locate = locate_options(options.inside, options.threads);
  locate.work.stop = interrupt::stop();
  if (options.json || !options.quiet) locate.work.statistics = &totals.statistics;

  std::vector<Location> locations;
  const auto ask = [&](std::span<const Vec3<Real>> points, const Progress& progress) {
    locate.work.progress = progress;
    locations.resize(points.size());
    scene.locate(points, locations, locate);
    totals.counts.add(locations);
  };
  totals.seconds = for_point_chunks(options, scene, file, "locate", ask, [&] { write(locations); });
  return totals;
}

template <class Real>
void print_answers(const LocateArguments& options, const LoadedScene<Real>& mesh,
                   const io::PointFile& points) {
  AnswerPrinter printer(options.json, begin_json("locate", options, mesh), "point", points.size());
  const auto totals =
      locate_all(options, mesh.scene(), points, [&](std::span<const Location> locations) {
        for (const Location location : locations) {
          const char* const words = to_words(location);
          printer.answer([&](auto line) { line(words); },
                         [&](io::JsonWriter& json) { json.value("location", words); });
        }
      });
  printer.finish();
  remark_on_cancelling(totals.counts, options.inside, mesh);
}

template <class Real>
void summarise(const LocateArguments& options, const LoadedScene<Real>& mesh,
               const LocateTotals& totals) {
  Summary table;
  mesh.add_size_to(table);
  table.add("points", grouped(totals.counts.all()));
  totals.counts.add_to(table);
  mesh.add_to(table);
  table.add("locate", timing(totals.seconds, totals.counts.all(), "points"));
  table.add("exact arithmetic", exact_decisions(totals.statistics));
  table.add("wrote", out_name(options));
  remark(table.text());
}

template <class Real>
void summarise_json(const LocateArguments& options, const LoadedScene<Real>& scene,
                    const LocateTotals& totals) {
  io::JsonWriter json = begin_json("locate", options, scene);
  json.value("points", totals.counts.all());
  totals.counts.add_to(json);
  json.value("seconds", totals.seconds);
  add_decisions(json, totals.statistics);
  json.value("out", options.out);
  finish_json(json);
}

template <class Real>
int locate_as(const LocateArguments& options, std::vector<Geometry> meshes,
              const io::PointFile& points) {
  const LoadedScene<Real> scene(std::move(meshes), {.work = {.threads = options.threads}});
  if (answers_in_words(options)) {
    print_answers(options, scene, points);
    return 0;
  }
  const interrupt::Graceful graceful;
  io::LocationWriter writer(answer_target(options));
  const LocateTotals totals =
      locate_all(options, scene.scene(), points,
                 [&](std::span<const Location> locations) { writer.append(locations); });
  writer.finish();
  remark_on_cancelling(totals.counts, options.inside, scene);
  if (options.json) {
    summarise_json(options, scene, totals);
  } else if (!options.quiet) {
    summarise(options, scene, totals);
  }
  return 0;
}

int run(const LocateArguments& options) {
  return run_on_points(options,
                       [&]<class Real>(std::vector<Geometry> meshes, const io::PointFile& points) {
                         return locate_as<Real>(options, std::move(meshes), points);
                       });
}

}  // namespace

Command add_locate(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("locate", "Tell which points are inside a closed mesh");
  const auto options = std::make_shared<LocateArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_point_options(*sub, *options,
                    "Answers: .npy, .npz or .csv, one int8 a point: 1 inside, 0 on the surface, -1 "
                    "outside; - is standard output");
  add_inside_options(*sub, options->inside);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce locate bunny.obj --points points.npy --out inside.npy\n"
      "  pierce locate scan.ply --points points.csv --out inside.csv --open-mesh\n"
      "  pierce locate bunny.obj --point 0,0.1,0 --point '0 1 0'\n"
      "  pierce locate scan.ply --points points.csv --out inside.csv --rule winding\n"
      "A mesh that is not closed is refused: its inside is not defined, but by --rule winding.\n"
      "`pierce info MESH --open-edges FILE` lists all edges that are open. Several meshes are one\n"
      "surface.\n"
      "--json prints one object: command mesh meshes geometries triangles precision build_seconds, "
      "then\n"
      "points inside on_surface outside seconds decisions decisions_exact out; or, for --point\n"
      "without --out, answers: an array with an object a point, of location.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
