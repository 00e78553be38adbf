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
#include "scene/validate_input.h"
#include "stopwatch.h"

namespace pierce::tool {

struct PointOptions : FileOptions {
  std::string points;
};

/// --points, required.
void add_points_option(CLI::App& app, PointOptions& options);

/// Opens what is to be read and calls `run<Real>(meshes, points)` with the type that --precision
/// says. `no_float`: an option whose number is no float, or nothing.
template <class Run>
int run_on_points(const PointOptions& options, const Run& run, const std::string& no_float = {}) {
  refuse_to_replace(options.out, inputs(options.meshes, {options.points}));
  const io::PointFile points(options.points);
  std::vector<Geometry> meshes = read_geometries(options.meshes);
  const bool single = points.single_precision();
  const std::string others = no_float.empty() ? options.points
                             : single         ? no_float
                                              : options.points + " and " + no_float;
  const bool use_float =
      choose_float(options.precision, meshes, others, single && no_float.empty());
  return use_float ? run.template operator()<float>(std::move(meshes), points)
                   : run.template operator()<double>(std::move(meshes), points);
}

/// Calls `ask(points, progress)` and then `write()` for one chunk of the file after another; also
/// for a file without points, of which the mesh may still be refused. Returns the seconds spent
/// asking. Begun inside a Graceful.
template <class Real, class Ask, class Write>
double for_point_chunks(const PointOptions& options, const io::PointFile& file, const char* label,
                        const Ask& ask, const Write& write) {
  constexpr std::size_t kChunk = std::size_t{1} << 22;
  ProgressBar bar(label);
  double seconds = 0;
  const double all = static_cast<double>(file.size());
  std::vector<Vec3<Real>> points;
  for (std::uint64_t first = 0; first == 0 || first < file.size(); first += points.size()) {
    interrupt::check();
    points.resize(std::min<std::uint64_t>(kChunk, file.size() - first));
    file.read(first, std::span(points));
    const Stopwatch watch;
    const Progress progress = bar.callback(static_cast<double>(first) / all,
                                           static_cast<double>(first + points.size()) / all);
    const std::span<const Vec3<Real>> chunk(points);
    try {
      ask(chunk, progress);
    } catch (const Error& e) {
      if (e.code() == ErrorCode::InvalidPoint) {
        refuse_row(options.points, first, chunk, scene::validate_point<Real>);
      }
      naming_meshes(options.meshes, [] { throw; });
    }
    seconds += watch.seconds();
    write();
    if (points.empty()) break;
  }
  interrupt::check();
  return seconds;
}

}  // namespace pierce::tool
