// SPDX-License-Identifier: Apache-2.0
//
// What the commands about points share: a file of points against a mesh, to a file of answers.
// Points go through a chunk at a time, so that their number does not matter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/rays.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {

struct PointOptions : FileOptions {
  std::string points;              ///< a file
  std::vector<std::string> point;  ///< or the points themselves
};

/// --points and --point, --out and --format; `text` says what is written.
void add_point_options(CLI::App& app, PointOptions& options, const std::string& text);

/// Throws UsageError unless there is one of --points and --point.
void check_points(const PointOptions& options);

/// --point, or else the file of --points, with its remarks printed.
[[nodiscard]] io::PointFile open_points(const PointOptions& options);

/// Whether the answers are to be printed, in words or as JSON, rather than written.
[[nodiscard]] inline bool answers_in_words(const PointOptions& options) {
  return options.out.empty();
}

/// Opens what is to be read and calls `run<Real>(meshes, points)` with the type that --precision
/// says. `no_float`: an option whose number is no float, or nothing.
template <class Run>
int run_on_points(const PointOptions& options, const Run& run, const std::string& no_float = {}) {
  check_points(options);
  refuse_to_replace(options.out, inputs(options.meshes, {options.points}));
  if (options.point.empty() || !options.out.empty()) check_answer_options(options);
  const io::PointFile points = open_points(options);
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  const bool single = counts_as_single(points, options.precision);
  const std::string others = no_float.empty() ? points.name()
                             : single         ? no_float
                                              : points.name() + " and " + no_float;
  const bool use_float =
      choose_float(options.precision, meshes, others, single && no_float.empty());
  return use_float ? run.template operator()<float>(std::move(meshes), points)
                   : run.template operator()<double>(std::move(meshes), points);
}

/// Calls `ask(points, progress)` and then `write()` for one chunk of the file after another; also
/// for a file without points, of which the mesh may still be refused. Returns the seconds spent
/// asking. Begun inside a Graceful.
template <class Real, class Ask, class Write>
double for_point_chunks(const PointOptions& options, const Scene<Real>& scene,
                        const io::PointFile& file, const char* label, const Ask& ask,
                        const Write& write) {
  constexpr std::size_t kPointsAtOnce = std::size_t{1} << 22;
  ProgressBar bar(label);
  double seconds = 0;
  const double all = static_cast<double>(file.size());
  std::vector<Vec3<Real>> points;
  for (std::uint64_t first = 0; first == 0 || first < file.size(); first += points.size()) {
    interrupt::check();
    points.resize(std::min<std::uint64_t>(kPointsAtOnce, file.size() - first));
    file.read(first, std::span(points));
    const Stopwatch watch;
    const Progress progress = bar.callback(static_cast<double>(first) / all,
                                           static_cast<double>(first + points.size()) / all);
    const std::span<const Vec3<Real>> chunk(points);
    naming_rows(
        file.name(), first, ErrorCode::InvalidPoint,
        [&] { naming_meshes(options.meshes, [&] { ask(chunk, progress); }); },
        [&](std::uint64_t i) { (void)scene.nearest_point(chunk[i]); });
    seconds += watch.seconds();
    write();
    if (points.empty()) break;
  }
  interrupt::check();
  return seconds;
}

}  // namespace pierce::tool
