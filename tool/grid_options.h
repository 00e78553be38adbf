// SPDX-License-Identifier: Apache-2.0
//
// The options that say which cells a grid has, and the grid that they make for a mesh.
#pragma once

#include <string>

#include "bounds.h"
#include "pierce/voxelise.h"

namespace CLI {
class App;
}

namespace pierce::tool {

struct GridOptions {
  std::string size, origin, spacing;  // as typed; the last two may be empty
};

/// --size, --origin and --spacing.
void add_grid_options(CLI::App& app, GridOptions& options);

/// Throws UsageError if --size makes no sense.
void check_grid_options(const GridOptions& options);

/// Whether the numbers on the command line are floats: a float scene takes them as they are.
[[nodiscard]] bool grid_is_float(const GridOptions& options);

/// The cells that are wanted; by default they cover the box.
template <class Real>
[[nodiscard]] Grid<Real> make_grid(const GridOptions& options, const Box& box);

extern template Grid<float> make_grid(const GridOptions&, const Box&);
extern template Grid<double> make_grid(const GridOptions&, const Box&);

}  // namespace pierce::tool
