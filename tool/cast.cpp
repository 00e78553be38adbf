// SPDX-License-Identifier: Apache-2.0
//
// pierce cast: rays against a mesh, to a file of answers or to words. Rays of a file are read,
// asked and answered a piece at a time, so that the size of the files does not matter.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cast_options.h"
#include "cast_piece.h"
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
#include "stopwatch.h"

namespace pierce::tool {
namespace {

struct Totals {
  std::uint64_t rays = 0, hits = 0;
  double query_seconds = 0;
  Statistics statistics;
};

template <class Real, class Asker>
Totals cast_all(const CastOptions& options, const Scene<Real>& scene, const RayStream& source,
                Asker asker) {
  Totals totals;
  BatchOptions batch = batch_options(options);
  if (options.json || !options.quiet) batch.work.statistics = &totals.statistics;

  ProgressBar bar("cast");
  const std::uint64_t size = source.size();
  const double all = static_cast<double>(size);
  const std::size_t most = rays_at_a_time(options.threads);
  for (std::uint64_t first = 0; first < size; first += most) {
    interrupt::check();
    const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(most, size - first));
    const Stopwatch watch;
    batch.work.progress =
        bar.callback(static_cast<double>(first) / all, static_cast<double>(first + piece) / all);
    totals.hits += cast_piece(scene, source, first, piece, asker, batch);
    totals.query_seconds += watch.seconds() - asker.seconds_writing();
    asker.write();
  }
  interrupt::check();
  asker.finish();
  totals.rays = size;
  return totals;
}

template <class Real>
Totals cast_query(const CastOptions& options, const Scene<Real>& scene, const RayStream& source) {
  const io::RecordTarget out = answer_target(options);
  const interrupt::Graceful graceful;  // before the askers open their output files
  const auto shape = source.shape();
  return with_asker(options, out, scene, 0, std::span<const std::uint64_t>(shape),
                    [&](auto asker) { return cast_all(options, scene, source, std::move(asker)); });
}

template <class Real>
void summarise(const CastOptions& options, const LoadedScene<Real>& mesh, const Totals& totals) {
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
  table.add("wrote", out_name(options));
  remark(table.text());
}

template <class Real>
void summarise_json(const CastOptions& options, const LoadedScene<Real>& scene,
                    const Totals& totals) {
  io::JsonWriter json = begin_json("cast", options, scene);
  json.value("query", name_of(options.query));
  json.value("rays", totals.rays);
  json.value(options.query == Query::Crossings ? "passages" : "hits", totals.hits);
  json.value("seconds", totals.query_seconds);
  add_decisions(json, totals.statistics);
  add_roundings(json, totals.statistics);
  json.value("out", options.out);
  finish_json(json);
}

template <class Real>
int cast_as(const CastOptions& options, std::vector<Geometry> meshes,
            std::optional<io::RayFile> rays) {
  const LoadedScene<Real> scene(std::move(meshes), {.work = {.threads = options.threads}});
  if (options.out.empty()) {
    print_answers(options, scene, *rays);
    return 0;
  }
  const RayStream source = rays ? RayStream(*std::move(rays))
                                : RayStream(make_rays<Real>(options.source, scene.views(),
                                                            has_z_up(options.meshes.files)));
  const Totals totals = cast_query(options, scene.scene(), source);
  if (options.json) {
    summarise_json(options, scene, totals);
  } else if (!options.quiet) {
    summarise(options, scene, totals);
  }
  return 0;
}

int run(CastOptions options) {
  check_cast(options);
  refuse_to_replace(options.out, inputs(options.meshes, {options.source.rays}));
  if (options.ray.empty() || !options.out.empty()) check_answer_options(options);
  if (options.reduce.reduction != Reduction::None) {
    if (options.out.empty()) throw UsageError("--reduce: name a .npy file with --out");
    require_npy(options.out);
  }
  CastInputs read = read_inputs(options);
  return read.use_float ? cast_as<float>(options, std::move(read.meshes), std::move(read.rays))
                        : cast_as<double>(options, std::move(read.meshes), std::move(read.rays));
}

}  // namespace

Command add_cast(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("cast", "Cast rays at a mesh");
  const auto options = std::make_shared<CastOptions>();
  add_mesh_arguments(*sub, options->meshes);
  add_ray_options(*sub, options->source);
  sub->add_option("--ray", options->ray,
                  "A ray, ox,oy,oz,dx,dy,dz[,t_min,t_max], answered in words if there is no --out; "
                  "may be repeated")
      ->allow_extra_args(false)
      ->type_name("NUMBERS");
  add_answers_option(*sub, *options,
                     "Answers: .npy, .npz or .csv, in the order of the rays; - is standard output");
  add_query_options(*sub, *options);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce cast bunny.obj --rays rays.npy --out hits.npy\n"
      "  pierce cast part.stl --rays rays.csv --query all --max-hits 2 --out hits.csv\n"
      "  pierce cast room.ply chair.obj --rays rays.npy --out hits.npy\n"
      "  pierce cast house.obj --parts --rays rays.npy --out hits.npy\n"
      "  pierce cast bunny.obj --ray 0,0.1,5,0,0,-1 --ray '0 0.1 5  0 0 -1  0 100'\n"
      "  pierce rays bunny.obj --out - | pierce cast bunny.obj --rays - --out - > hits.csv\n"
      "  pierce cast city.pierce --camera --size 4000x3000 --reduce depth --out depth.npy\n"
      "  pierce cast city.pierce --sphere 1000000000 --reduce triangles --out seen.npy\n"
      "Rays that are made (--camera, --grid, --lidar, --sphere) are stored nowhere: ray i is the\n"
      "same on every machine, and --reduce keeps what is wanted of a billion answers.\n"
      "Rays in .npy, or alone in an .npz: an array (n, 6), (n, 8) or (n, 2, 3), with more\n"
      "indices in front if need be, or records with fields by the names above, or origin and\n"
      "direction of three numbers each; float16, float32, float64, or integers that the scene's\n"
      "numbers hold exactly. In .csv: these columns in this order, or in any order if the first\n"
      "line, or a comment above it, names them; others are not used, and named. Commas,\n"
      "semicolons, tabs or blanks stand between numbers; unless it is commas, commas may be\n"
      "decimal signs. What kind of file it is its content tells.\n"
      "A record of closest is t u v w geometry triangle facing; a miss has t = inf and\n"
      "triangle 4294967295; facing is 0 for the front and 1 for the back. Records of all begin\n"
      "with the ray's row. A record of crossings is count signed_count origin_on_surface; for a\n"
      "closed mesh an odd count is inside. Records in .npy are laid out as the structs of\n"
      "pierce/types.h: 28 bytes for closest in float, 48 in double. .npz has an array a column,\n"
      "which NumPy goes through some ten times as fast.\n"
      "--json prints one object: command mesh meshes geometries triangles precision build_seconds\n"
      "query, then rays, hits (of crossings: passages) seconds decisions decisions_exact\n"
      "roundings roundings_exact out; or, for --ray without --out, answers: an array with an\n"
      "object a ray, of hit t u v w geometry triangle facing feature; hits; count; or count\n"
      "signed_count origin_on_surface.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
