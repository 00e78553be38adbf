// SPDX-License-Identifier: Apache-2.0
#include "point_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "parse.h"

namespace pierce::tool {

void add_point_options(CLI::App& app, PointOptions& options, const std::string& text) {
  app.add_option("--points", options.points,
                 "Points: .npy or .csv, with columns x y z, in all the forms that `pierce cast "
                 "--help` tells of rays; .xyz or .pts, whatever follows x y z; or a .ply, whose "
                 "vertices they are; - is standard input");
  app.add_option("--point", options.point,
                 "A point, x,y,z, answered in words if there is no --out; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NUMBERS");
  add_answers_option(app, options, text);
}

void check_points(const PointOptions& options) {
  if (options.points.empty() && options.point.empty()) {
    throw UsageError("give --points FILE, or --point x,y,z");
  }
  if (!options.points.empty() && !options.point.empty()) {
    throw UsageError("--point: cannot be given together with --points; choose one");
  }
}

io::PointFile open_points(const PointOptions& options) {
  if (options.point.empty()) {
    io::PointFile file{std::filesystem::path(options.points)};
    print_warnings(file.remarks(), options.meshes.strict);
    return file;
  }
  std::vector<double> rows;
  for (const std::string& text : options.point) {
    const std::vector<double> row = parse_row(text, "--point");
    if (row.size() != 3) {
      throw UsageError(
          fmt::format("--point: '{}' has {} numbers; give 3: x,y,z", text, row.size()));
    }
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return {rows, "--point"};
}

}  // namespace pierce::tool
