// SPDX-License-Identifier: Apache-2.0
//
// pierce locate: a file of points against a closed mesh, to a file that says which are inside, on
// the surface and outside. Points go through a chunk at a time, so that their number does not
// matter.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "command.h"
#include "failure.h"
#include "inside_options.h"
#include "interrupt.h"
#include "io/hits.h"
#include "io/rays.h"
#include "output.h"
#include "progress_bar.h"
#include "scene_file.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

constexpr std::size_t kChunk = std::size_t{1}
                               << 22;  // points; some 200 MB with what belongs to them

struct Options {
  std::string mesh, points, out;
  InsideOptions inside;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool quiet = false;
};

struct Totals {
  LocationCounts counts;
  double seconds = 0;
  Statistics statistics;
};

// The batch knows its points, but not where in the file they came from.
template <class Real>
[[noreturn]] void rethrow_naming_row(const Error& e, const std::string& path, std::uint64_t first,
                                     std::span<const Vec3<Real>> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3<Real>& p = points[i];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    throw Error(e.code(), fmt::format("{}: row {} (counted from 0): the point is not finite; "
                                      "correct or remove it",
                                      path, first + i));
  }
  throw e;
}

template <class Real>
Totals locate_all(const Options& options, const Scene<Real>& scene, const io::PointFile& file) {
  const interrupt::Graceful graceful;
  Totals totals;
  LocateOptions locate = locate_options(options.inside, options.threads);
  locate.stop = interrupt::token();
  if (!options.quiet) locate.statistics = &totals.statistics;

  io::LocationWriter writer(options.out);
  ProgressBar bar("locate");
  const double all = static_cast<double>(file.size());
  std::vector<Vec3<Real>> points;
  std::vector<Location> locations;
  // An empty file still asks whether the mesh is closed.
  for (std::uint64_t first = 0; first == 0 || first < file.size(); first += points.size()) {
    interrupt::check();
    points.resize(std::min<std::uint64_t>(kChunk, file.size() - first));
    locations.resize(points.size());
    file.read(first, std::span(points));
    const Stopwatch watch;
    locate.progress = bar.callback(static_cast<double>(first) / all,
                                   static_cast<double>(first + points.size()) / all);
    try {
      scene.locate(points, locations, locate);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::InvalidPoint) {
        rethrow_naming_row<Real>(e, options.points, first, points);
      }
      naming_file(options.mesh, [] { throw; });
    }
    totals.seconds += watch.seconds();
    totals.counts.add(locations);
    writer.append(locations);
    if (points.empty()) break;
  }
  interrupt::check();
  writer.finish();
  return totals;
}

template <class Real>
void summarise(const Options& options, const SceneFile<Real>& mesh, const Totals& totals) {
  const Statistics& s = totals.statistics;
  Summary table;
  table.add("triangles", grouped(mesh.view().triangles.size()));
  table.add("points", grouped(totals.counts.all()));
  totals.counts.add_to(table);
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add("build", seconds(mesh.build_seconds()));
  table.add(
      "locate",
      totals.counts.all() == 0
          ? seconds(0)
          : fmt::format("{}, {}", seconds(totals.seconds),
                        rate(static_cast<double>(totals.counts.all()) / totals.seconds, "points")));
  table.add("exact arithmetic",
            fmt::format("{} of {} decisions", grouped(s.settled + s.settled_big),
                        grouped(s.certified + s.settled + s.settled_big)));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int locate_as(const Options& options, io::Mesh mesh, const io::PointFile& points) {
  const SceneFile<Real> scene(options.mesh, std::move(mesh), {.threads = options.threads});
  const Totals totals = locate_all(options, scene.scene(), points);
  if (!options.quiet) summarise(options, scene, totals);
  return 0;
}

int run(const Options& options) {
  refuse_to_replace(options.out, {options.mesh, options.points});
  const io::PointFile points(options.points);
  io::Mesh mesh = read_triangles(options.mesh);
  const bool use_float = choose_float(options.precision, options.mesh, mesh.single_precision,
                                      options.points, points.single_precision());
  return use_float ? locate_as<float>(options, std::move(mesh), points)
                   : locate_as<double>(options, std::move(mesh), points);
}

}  // namespace

Command add_locate(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("locate", "Tell which points are inside a closed mesh");
  const auto options = std::make_shared<Options>();
  sub->add_option("MESH", options->mesh, "Mesh file (PLY, STL, OBJ, OFF, glTF, 3DS, ...)")
      ->required();
  sub->add_option("--points", options->points,
                  "Points: .npy (2-D, float32 or float64) or .csv, with columns x y z")
      ->required();
  sub->add_option("--out", options->out,
                  "Answers: .npy or .csv, one int8 a point: 1 inside, 0 on the surface, -1 outside")
      ->required();
  add_inside_options(*sub, options->inside);
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->add_flag("--quiet", options->quiet, "Print no summary");
  sub->footer(
      "Examples:\n"
      "  pierce locate bunny.obj --points points.npy --out inside.npy\n"
      "  pierce locate scan.ply --points points.csv --out inside.csv --open-mesh\n"
      "A mesh that is not closed is refused: its inside is not defined. `pierce info` lists what "
      "is\n"
      "open.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
