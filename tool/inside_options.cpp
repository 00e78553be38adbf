// SPDX-License-Identifier: Apache-2.0
#include "inside_options.h"

#include <fmt/format.h>

#include <string>

#include "choice.h"
#include "mesh/coincident.h"
#include "one_mesh.h"

namespace pierce::tool {

void add_inside_options(CLI::App& app, InsideOptions& options) {
  add_choice<InsideRule>(app, "--rule", options.rule,
                         {{"odd", InsideRule::Odd},
                          {"nonzero", InsideRule::NonZero},
                          {"unique", InsideRule::Unique},
                          {"winding", InsideRule::Winding}},
                         "odd: inside is where a ray leaves an odd number of times; nonzero: where "
                         "the surface winds around, so that overlapping parts unite; unique: odd, "
                         "but of triangles in the same place only the first counts, for files that "
                         "have every face twice; winding: where the winding number is above 1/2, "
                         "for meshes with holes");
  app.add_flag("--open-mesh", options.open_mesh,
               "Do not refuse a mesh that is not closed: take what the crossings of a ray from the "
               "point along +z say");
}

LocateOptions locate_options(const InsideOptions& options, unsigned threads) {
  LocateOptions result;
  result.work.threads = threads;
  result.rule = options.rule;
  result.open_mesh = options.open_mesh;
  return result;
}

void LocationCounts::add(std::span<const Location> locations) {
  for (const Location location : locations) {
    ++(location == Location::Inside      ? inside
       : location == Location::OnSurface ? on_surface
                                         : outside);
  }
}

void LocationCounts::add_to(Summary& table) const {
  const auto row = [&](const char* name, std::uint64_t count) {
    table.add(name, all() == 0 ? grouped(count)
                               : fmt::format("{} ({})", grouped(count), percentage(count, all())));
  };
  row("inside", inside);
  row("on the surface", on_surface);
  row("outside", outside);
}

void LocationCounts::add_to(io::JsonWriter& json) const {
  json.value("inside", inside);
  json.value("on_surface", on_surface);
  json.value("outside", outside);
}

template <class Real>
void remark_on_cancelling(const LocationCounts& counts, const InsideOptions& options,
                          const LoadedScene<Real>& scene) {
  if (counts.all() == 0 || counts.inside > 0 || options.rule == InsideRule::Unique) return;
  const OneMesh<Real> together(scene.views());
  const std::uint64_t cancelling = mesh::coincident_triangles(together.view(), {}).cancelling;
  if (cancelling == 0) return;
  remark(
      fmt::format("pierce: nothing is inside, and {} of {} triangles lie back to back and cancel: "
                  "--rule unique counts each place once\n",
                  grouped(cancelling), grouped(together.view().triangles.size())));
}

template void remark_on_cancelling(const LocationCounts&, const InsideOptions&,
                                   const LoadedScene<float>&);
template void remark_on_cancelling(const LocationCounts&, const InsideOptions&,
                                   const LoadedScene<double>&);

}  // namespace pierce::tool
