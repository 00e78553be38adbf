// SPDX-License-Identifier: Apache-2.0
//
// What the commands about inside and outside share: their options, and the counts in their
// summaries.
#pragma once

#include <cstdint>
#include <span>

#include "io/json_writer.h"
#include "loaded_scene.h"
#include "output.h"
#include "pierce/options.h"
#include "pierce/types.h"

namespace CLI {
class App;
}

namespace pierce::tool {

struct InsideOptions {
  InsideRule rule = InsideRule::Odd;
  bool open_mesh = false;
};

/// --rule and --open-mesh.
void add_inside_options(CLI::App& app, InsideOptions& options);

[[nodiscard]] LocateOptions locate_options(const InsideOptions& options, unsigned threads);

struct LocationCounts {
  std::uint64_t inside = 0, on_surface = 0, outside = 0;

  [[nodiscard]] std::uint64_t all() const { return inside + on_surface + outside; }
  void add(std::span<const Location> locations);
  void add_to(Summary& table) const;
  void add_to(io::JsonWriter& json) const;
};

/// If nothing is inside: remarks upon triangles that lie back to back and cancel, if there are any.
template <class Real>
void remark_on_cancelling(const LocationCounts& counts, const InsideOptions& options,
                          const LoadedScene<Real>& scene);

extern template void remark_on_cancelling(const LocationCounts&, const InsideOptions&,
                                          const LoadedScene<float>&);
extern template void remark_on_cancelling(const LocationCounts&, const InsideOptions&,
                                          const LoadedScene<double>&);

}  // namespace pierce::tool
