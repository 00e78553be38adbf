// SPDX-License-Identifier: Apache-2.0
//
// pierce info: what a mesh file holds, whether the mesh is closed, and the search tree over it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "command.h"
#include "loaded_scene.h"
#include "output.h"
#include "pierce/closed.h"

namespace pierce::tool {
namespace {

struct Options {
  std::string mesh;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
};

std::string bounds(MeshView<double> mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3<double> low = {kInf, kInf, kInf}, high = {-kInf, -kInf, -kInf};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3<double>& p = mesh.vertices[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  return fmt::format("{},{},{} to {},{},{}", low.x, low.y, low.z, high.x, high.y, high.z);
}

// Vertices that no triangle names.
std::uint64_t unused_vertices(MeshView<double> mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
}

// Triangles with the same three corner positions as an earlier one, in whatever order.
std::uint64_t duplicates(MeshView<double> mesh) {
  using Corners = std::array<std::array<double, 3>, 3>;
  std::vector<Corners> all;
  all.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<double>& p = mesh.vertices[t[k]];
      c[k] = {p.x + 0, p.y + 0, p.z + 0};  // -0 is 0
    }
    std::sort(c.begin(), c.end());
    all.push_back(c);
  }
  std::sort(all.begin(), all.end());
  const auto end = std::unique(all.begin(), all.end());
  return static_cast<std::uint64_t>(all.end() - end);
}

std::string place(const Vec3<double>& p) { return fmt::format("({}, {}, {})", p.x, p.y, p.z); }

// "edge 3-7 of triangle 12, (0, 0, 0) to (1, 0, 0), ..."
std::string describe(const EdgeUse& edge, MeshView<double> mesh) {
  std::string text =
      fmt::format("edge {}-{} of triangle {}, {} to {}, ", edge.from, edge.to, edge.triangle,
                  place(mesh.vertices[edge.from]), place(mesh.vertices[edge.to]));
  if (edge.other_triangle == kNone) return text + "belongs to no other triangle";
  if (edge.forward == 2 && edge.backward == 0) {
    return text + fmt::format("runs the same way in triangle {}", edge.other_triangle);
  }
  return text +
         fmt::format("is used {} times that way, {} times the other", edge.forward, edge.backward);
}

std::string describe(const Closedness& c, MeshView<double> mesh) {
  if (c.closed) return "yes";
  if (c.balanced) {
    return fmt::format("yes, but surfaces meet in {} of {} edges; the first: {}",
                       grouped(c.crowded_edges), grouped(c.edges),
                       describe(*c.first_crowded, mesh));
  }
  return fmt::format("no: {} of {} edges open, {} more not used once each way; the first: {}",
                     grouped(c.open_edges), grouped(c.edges),
                     grouped(c.unbalanced_edges - c.open_edges),
                     describe(*c.first_unbalanced, mesh));
}

std::string attributes(const io::Mesh& mesh) {
  std::string list;
  const auto add = [&](bool present, const char* name) {
    if (present) list += fmt::format("{}{}", list.empty() ? "" : ", ", name);
  };
  add(!mesh.normals.empty(), "normals");
  add(!mesh.colors.empty(), "colours");
  add(!mesh.texcoords.empty(), "texture coordinates");
  return list.empty() ? "none" : list;
}

void add_tree(Summary& table, const SceneInfo& info, double build_seconds) {
  table.add("without area", grouped(info.degenerate));
  table.add("build", seconds(build_seconds));
  table.add("tree nodes", grouped(info.nodes));
  table.add("tree leaves", fmt::format("{}, {:.3g} triangles each", grouped(info.leaves),
                                       info.leaves == 0 ? 0.0
                                                        : static_cast<double>(info.triangles) /
                                                              static_cast<double>(info.leaves)));
  table.add("SAH cost", fmt::format("{:.4g} node visits", info.sah_cost));
  table.add("tree memory",
            fmt::format("{}, {:.3g} bytes a triangle", memory(info.bytes),
                        static_cast<double>(info.bytes) / static_cast<double>(info.triangles)));
}

int run(const Options& options) {
  io::Mesh mesh = read_triangles(options.mesh);
  Summary table;
  table.add("file", options.mesh);
  table.add("format", mesh.format);
  table.add("coordinates", mesh.single_precision ? "32-bit" : "64-bit");
  table.add("attributes", attributes(mesh));
  table.add("vertices", fmt::format("{}, {} of them unused", grouped(mesh.vertices.size()),
                                    grouped(unused_vertices(mesh.view()))));
  table.add("triangles", grouped(mesh.triangles.size()));
  table.add("bounds", bounds(mesh.view()));
  table.add("duplicates", grouped(duplicates(mesh.view())));
  table.add("closed by index", describe(closedness(mesh.view(), SameVertex::Index), mesh.view()));
  table.add("closed by position",
            describe(closedness(mesh.view(), SameVertex::Position), mesh.view()));

  const BuildOptions build = {.work = {.threads = options.threads}};
  if (choose_float(options.precision, options.mesh, mesh.single_precision)) {
    const LoadedScene<float> file(options.mesh, std::move(mesh), build);
    add_tree(table, file.scene().info(), file.build_seconds());
  } else {
    const LoadedScene<double> file(options.mesh, std::move(mesh), build);
    add_tree(table, file.scene().info(), file.build_seconds());
  }
  print(table.text());
  return 0;
}

}  // namespace

Command add_info(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("info", "Describe a mesh and its search tree");
  const auto options = std::make_shared<Options>();
  sub->add_option("MESH", options->mesh, "Mesh file (PLY, STL, OBJ, OFF, glTF, 3DS, ...)")
      ->required();
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->footer(
      "Examples:\n"
      "  pierce info bunny.obj\n"
      "A mesh is closed if each edge is used once each way. By index: edges are the same if their\n"
      "vertex numbers are; by position: if their coordinates are.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
