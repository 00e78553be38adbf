// SPDX-License-Identifier: Apache-2.0
#include "point_options.h"

#include <CLI/CLI.hpp>

namespace pierce::tool {

void add_points_option(CLI::App& app, PointOptions& options) {
  app.add_option("--points", options.points,
                 "Points: .npy (2-D, float32 or float64) or .csv, with columns x y z")
      ->required();
}

}  // namespace pierce::tool
