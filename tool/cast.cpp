// SPDX-License-Identifier: Apache-2.0
//
// pierce cast: a file of rays against a mesh, to a file of answers. Rays are read, asked and
// answered a chunk at a time, so that the size of the files does not matter.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "cast_queries.h"
#include "choice.h"
#include "command.h"
#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/rays.h"
#include "loaded_scene.h"
#include "output.h"
#include "progress_bar.h"
#include "scene/validate_input.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

enum class Query : std::uint8_t { Closest, Any, All, Count, Crossings };

struct Options : FileOptions {
  std::string rays;
  Query query = Query::Closest;
  Sides sides = Sides::Both;
  Range range = Range::Closed;
  std::uint64_t max_hits = kUnlimited;
};

struct Totals {
  std::uint64_t rays = 0, hits = 0;
  double query_seconds = 0;
  Statistics statistics;
};

template <class Real, class Asker>
Totals cast_all(const Options& options, const Scene<Real>& scene, const io::RayFile& file,
                Asker asker) {
  Totals totals;
  BatchOptions batch;
  batch.work.threads = options.threads;
  batch.range = options.range;
  batch.sides = options.sides;
  batch.max_hits = options.max_hits;
  batch.work.stop = interrupt::stop();
  if (!options.quiet) batch.work.statistics = &totals.statistics;

  ProgressBar bar("cast");
  const double all = static_cast<double>(file.size());
  std::vector<Ray<Real>> rays;
  for (std::uint64_t first = 0; first < file.size(); first += rays.size()) {
    interrupt::check();
    rays.resize(std::min<std::uint64_t>(kChunk, file.size() - first));
    file.read(first, std::span(rays));
    const Stopwatch watch;
    batch.work.progress = bar.callback(static_cast<double>(first) / all,
                                       static_cast<double>(first + rays.size()) / all);
    try {
      totals.hits += asker.ask(scene, rays, batch);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::InvalidRay) {
        refuse_row(options.rays, first, std::span<const Ray<Real>>(rays),
                   scene::validate_ray<Real>);
      }
      throw;
    }
    totals.query_seconds += watch.seconds() - asker.seconds_writing();
    asker.write();
  }
  interrupt::check();
  asker.finish();
  totals.rays = file.size();
  return totals;
}

template <class Real>
Totals cast_query(const Options& options, const Scene<Real>& scene, const io::RayFile& file) {
  const interrupt::Graceful graceful;  // before the askers open their output files
  switch (options.query) {
    case Query::Any:
      return cast_all(options, scene, file, AnyQuery<Real>(options.out));
    case Query::All:
      return cast_all(options, scene, file, AllQuery<Real>(options.out));
    case Query::Count:
      return cast_all(options, scene, file, CountQuery<Real>(options.out));
    case Query::Crossings:
      return cast_all(options, scene, file, CrossingsQuery<Real>(options.out));
    case Query::Closest:
      break;
  }
  return cast_all(options, scene, file, ClosestQuery<Real>(options.out));
}

template <class Real>
void summarise(const Options& options, const LoadedScene<Real>& mesh, const Totals& totals) {
  Summary table;
  mesh.add_size_to(table);
  table.add("rays", grouped(totals.rays));
  table.add(
      options.query == Query::Crossings ? "passages" : "hits",
      options.query != Query::Closest && options.query != Query::Any
          ? grouped(totals.hits)
          : fmt::format("{} ({})", grouped(totals.hits), percentage(totals.hits, totals.rays)));
  mesh.add_to(table);
  table.add("cast", timing(totals.query_seconds, totals.rays, "rays"));
  table.add("exact arithmetic",
            exact_decisions(totals.statistics) + ", " + exact_roundings(totals.statistics));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int cast_as(const Options& options, std::vector<Geometry> meshes, const io::RayFile& rays) {
  BuildOptions build;
  build.work.threads = options.threads;
  const LoadedScene<Real> scene(std::move(meshes), build);
  const Totals totals = cast_query(options, scene.scene(), rays);
  if (!options.quiet) summarise(options, scene, totals);
  return 0;
}

int run(const Options& options) {
  if (options.max_hits != kUnlimited && options.query != Query::All) {
    throw UsageError("--max-hits: only the lists of --query all can be cut short");
  }
  refuse_to_replace(options.out, inputs(options.meshes, {options.rays}));
  const io::RayFile rays(options.rays);
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  const bool use_float =
      choose_float(options.precision, meshes, options.rays, rays.single_precision());
  return use_float ? cast_as<float>(options, std::move(meshes), rays)
                   : cast_as<double>(options, std::move(meshes), rays);
}

void add_query_options(CLI::App& app, Options& options) {
  add_choice<Query>(app, "--query", options.query,
                    {{"closest", Query::Closest},
                     {"any", Query::Any},
                     {"all", Query::All},
                     {"count", Query::Count},
                     {"crossings", Query::Crossings}},
                    "closest: the first hit of each ray; any: whether there is one; all: every "
                    "hit; count: how many there are; crossings: how often it passes through the "
                    "surface");
  add_choice<Sides>(app, "--sides", options.sides,
                    {{"both", Sides::Both}, {"front", Sides::Front}, {"back", Sides::Back}},
                    "front: only where rays meet the front of a triangle, and enter; back: only "
                    "where they leave");
  add_choice<Range>(app, "--range", options.range,
                    {{"closed", Range::Closed}, {"open-start", Range::OpenStart}},
                    "open-start: a hit exactly at t_min does not count");
  app.add_option("--max-hits", options.max_hits,
                 "With --query all: no more than the first K hits of each ray")
      ->check(CLI::Range(std::uint64_t{1}, kUnlimited - 1).description("K"));
}

}  // namespace

Command add_cast(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("cast", "Cast a file of rays at a mesh");
  const auto options = std::make_shared<Options>();
  add_mesh_arguments(*sub, options->meshes);
  sub->add_option("--rays", options->rays,
                  "Rays: .npy (2-D, float32 or float64) or .csv, with columns "
                  "ox oy oz dx dy dz [t_min t_max]")
      ->required();
  add_out_option(*sub, *options, "Answers: .npy or .csv, in the order of the rays");
  add_query_options(*sub, *options);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce cast bunny.obj --rays rays.npy --out hits.npy\n"
      "  pierce cast part.stl --rays rays.csv --query all --max-hits 2 --out hits.csv\n"
      "  pierce cast room.ply chair.obj --rays rays.npy --out hits.npy\n"
      "  pierce cast house.obj --parts --rays rays.npy --out hits.npy\n"
      "A record of closest is t u v w geometry triangle facing; a miss has t = inf and\n"
      "triangle 4294967295; facing is 0 for the front and 1 for the back. Records of all begin\n"
      "with the ray's row. A record of crossings is count signed_count origin_on_surface; for a\n"
      "closed mesh an odd count is inside.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
