// SPDX-License-Identifier: Apache-2.0
//
// pierce nearest: points against a mesh, to a file of the surface's nearest points, or to words.
#include "pierce/nearest.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
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
#include "support/progress.h"
#include "words.h"

namespace pierce::tool {
namespace {

struct NearestArguments : PointOptions {
  double radius = std::numeric_limits<double>::infinity();
  bool with_sign = false;
  InsideOptions inside;
};

struct NearestTotals {
  std::uint64_t points = 0, found = 0;
  LocationCounts locations;
  double seconds = 0;
  Statistics statistics;
};

template <class Real>
class Asker {
 public:
  Asker(const NearestArguments& options, const Scene<Real>& scene, NearestTotals& totals)
      : scene_(scene), with_sign_(options.with_sign), totals_(totals) {
    Statistics* const statistics = options.quiet && !options.json ? nullptr : &totals.statistics;
    locate_ = locate_options(options.inside, options.threads);
    locate_.work.stop = nearest_.work.stop = interrupt::stop();
    locate_.work.statistics = nearest_.work.statistics = statistics;
    nearest_.work.threads = options.threads;
    nearest_.radius = static_cast<Real>(options.radius);
  }

  void operator()(std::span<const Vec3<Real>> points, const Progress& progress) {
    const double located = with_sign_ ? 0.1 : 0;  // of the time, locating takes a small part
    locate_.work.progress = part_of(progress, 0, located);
    nearest_.work.progress = part_of(progress, located, 1);
    locations_.resize(with_sign_ ? points.size() : 0);
    if (with_sign_) scene_.locate(points, locations_, locate_);
    answers_.resize(points.size());
    scene_.nearest_points(points, answers_, nearest_);
    for (std::size_t i = 0; i < locations_.size(); ++i) {
      answers_[i].distance = with_sign(answers_[i].distance, locations_[i]);
    }
    count();
  }

  [[nodiscard]] std::span<const NearestPoint<Real>> answers() const { return answers_; }

 private:
  void count() {
    totals_.points += answers_.size();
    totals_.locations.add(locations_);
    totals_.found += static_cast<std::uint64_t>(std::count_if(
        answers_.begin(), answers_.end(), [](const auto& n) { return n.triangle != kNone; }));
  }

  const Scene<Real>& scene_;
  bool with_sign_;
  NearestTotals& totals_;
  LocateOptions locate_;
  NearestOptions<Real> nearest_;
  std::vector<Location> locations_;
  std::vector<NearestPoint<Real>> answers_;
};

template <class Real>
void summarise(const NearestArguments& options, const LoadedScene<Real>& mesh,
               const NearestTotals& totals) {
  Summary table;
  mesh.add_size_to(table);
  table.add("points", grouped(totals.points));
  table.add("within the radius",
            fmt::format("{} ({})", grouped(totals.found), percentage(totals.found, totals.points)));
  if (options.with_sign) totals.locations.add_to(table);
  mesh.add_to(table);
  table.add("nearest", timing(totals.seconds, totals.points, "points"));
  table.add("exact arithmetic",
            exact_decisions(totals.statistics) + ", " + exact_roundings(totals.statistics));
  table.add("wrote", out_name(options));
  remark(table.text());
}

template <class Real>
void summarise_json(const NearestArguments& options, const LoadedScene<Real>& scene,
                    const NearestTotals& totals) {
  io::JsonWriter json = begin_json("nearest", options, scene);
  json.value("points", totals.points);
  json.value("found", totals.found);
  if (options.with_sign) totals.locations.add_to(json);
  json.value("seconds", totals.seconds);
  add_decisions(json, totals.statistics);
  add_roundings(json, totals.statistics);
  json.value("out", options.out);
  finish_json(json);
}

template <class Real>
int nearest_as(const NearestArguments& options, std::vector<Geometry> meshes,
               const io::PointFile& points) {
  const LoadedScene<Real> scene(std::move(meshes), {.work = {.threads = options.threads}});
  NearestTotals totals;
  const interrupt::Graceful graceful;
  Asker<Real> ask(options, scene.scene(), totals);
  const auto each_chunk = [&](const auto& write) {
    totals.seconds = for_point_chunks(
        options, scene.scene(), points, "nearest",
        [&](auto chunk, const Progress& p) { ask(chunk, p); }, [&] { write(ask.answers()); });
  };
  if (answers_in_words(options)) {
    AnswerPrinter printer(options.json, begin_json("nearest", options, scene), "point",
                          points.size());
    each_chunk([&](std::span<const NearestPoint<Real>> answers) {
      for (const NearestPoint<Real>& answer : answers) {
        printer.answer([&](auto line) { line(to_words(answer)); },
                       [&](io::JsonWriter& json) { add_answer(json, answer); });
      }
    });
    printer.finish();
    return 0;
  }
  io::NearestWriter<Real> writer(answer_target(options));
  each_chunk([&](std::span<const NearestPoint<Real>> answers) { writer.append(answers); });
  writer.finish();
  if (options.json) {
    summarise_json(options, scene, totals);
  } else if (!options.quiet) {
    summarise(options, scene, totals);
  }
  return 0;
}

int run(const NearestArguments& options) {
  if (!(options.radius >= 0)) {
    throw UsageError(fmt::format("--radius: {} is not 0 or more", options.radius));
  }
  const bool radius_is_float =
      static_cast<double>(static_cast<float>(options.radius)) == options.radius;
  return run_on_points(options,
                       [&]<class Real>(std::vector<Geometry> meshes, const io::PointFile& points) {
                         return nearest_as<Real>(options, std::move(meshes), points);
                       },
                       {radius_is_float ? "" : "--radius"});
}

}  // namespace

Command add_nearest(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("nearest", "Find the surface's nearest points");
  const auto options = std::make_shared<NearestArguments>();
  add_mesh_arguments(*sub, options->meshes);
  add_point_options(
      *sub, *options,
      "Answers: .npy, .npz or .csv, in the order of the points; - is standard output");
  sub->add_option("--radius", options->radius,
                  "Surface farther away does not count; exactly as far away it does")
      ->option_text("R");
  CLI::Option* sign = sub->add_flag("--signed", options->with_sign,
                                    "Make the distance negative inside the mesh, which must be "
                                    "closed");
  add_inside_options(*sub, options->inside);
  for (const char* of_sign : {"--rule", "--open-mesh"}) sub->get_option(of_sign)->needs(sign);
  add_work_options(*sub, *options);
  sub->footer(
      "Examples:\n"
      "  pierce nearest bunny.obj --points points.npy --out nearest.npy\n"
      "  pierce nearest part.stl --points points.csv --out nearest.csv --signed --radius 0.5\n"
      "  pierce nearest bunny.obj --point 0,0.1,0\n"
      "A record is x y z distance u v w geometry triangle feature; feature is 0, 1, 2 for the\n"
      "vertices a, b, c, then 3, 4, 5 for the edges ab, bc, ca, and 6 for the face. Without a\n"
      "triangle within the radius distance is inf (-inf inside) and triangle 4294967295. Records\n"
      "in .npy are laid out as NearestPoint of pierce/nearest.h: 40 bytes in float, 72 in double.\n"
      "--json prints one object: command mesh meshes geometries triangles precision "
      "build_seconds,\n"
      "then points found (with --signed: inside on_surface outside) seconds decisions\n"
      "decisions_exact roundings roundings_exact out; or, for --point without --out, answers:\n"
      "an array with an object a point, of found point distance u v w geometry triangle\n"
      "feature.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
