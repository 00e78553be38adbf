// SPDX-License-Identifier: Apache-2.0
//
// What the commands about points share: a file of points against a mesh, to a file of answers.
// Points go through a chunk at a time, so that their number does not matter.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/mesh.h"
#include "io/rays.h"
#include "progress_bar.h"
#include "stopwatch.h"

namespace pierce::tool {

struct PointOptions : FileOptions {
  std::string points;
};

/// --points, required.
void add_points_option(CLI::App& app, PointOptions& options);

/// Opens what is to be read and calls `run<Real>(mesh, points)` with the type that --precision
/// says. `no_float`: an option whose number is no float, or nothing.
template <class Run>
int run_on_points(const PointOptions& options, const Run& run, const std::string& no_float = {}) {
  refuse_to_replace(options.out, {options.mesh, options.points});
  const io::PointFile points(options.points);
  io::Mesh mesh = read_triangles(options.mesh);
  const bool single = points.single_precision();
  const std::string others = no_float.empty() ? options.points
                             : single         ? no_float
                                              : options.points + " and " + no_float;
  const bool use_float = choose_float(options.precision, options.mesh, mesh.single_precision,
                                      others, single && no_float.empty());
  return use_float ? run.template operator()<float>(std::move(mesh), points)
                   : run.template operator()<double>(std::move(mesh), points);
}

/// The batch knows its points, but not where in the file they came from: of the error that is
/// under way, says so.
template <class Real>
[[noreturn]] void rethrow_naming_row(const PointOptions& options, std::uint64_t first,
                                     std::span<const Vec3<Real>> points) {
  try {
    throw;
  } catch (const Error& e) {
    for (std::size_t i = 0; e.code() == ErrorCode::InvalidPoint && i < points.size(); ++i) {
      const Vec3<Real>& p = points[i];
      if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
      throw Error(e.code(), fmt::format("{}: row {} (counted from 0): the point is not finite; "
                                        "correct or remove it",
                                        options.points, first + i));
    }
    naming_file(options.mesh, [] { throw; });
    throw;
  }
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
    try {
      ask(std::span<const Vec3<Real>>(points), progress);
    } catch (const Error&) {
      rethrow_naming_row<Real>(options, first, points);
    }
    seconds += watch.seconds();
    write();
    if (points.empty()) break;
  }
  interrupt::check();
  return seconds;
}

}  // namespace pierce::tool
