// SPDX-License-Identifier: Apache-2.0
//
// pierce info: what a mesh file holds, whether the mesh is closed, and the search tree over it.
#include <fmt/format.h>
#include <fmt/ranges.h>

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
#include "file_options.h"
#include "info_json.h"
#include "output.h"
#include "pierce/closed.h"
#include "scene_file.h"

namespace pierce::tool {
namespace {

struct Options {
  std::string mesh;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool json = false;
};

struct Bounds {
  Vec3<double> low, high;
};

Bounds bounds(MeshView<double> mesh) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec3<double> low = {kInf, kInf, kInf}, high = {-kInf, -kInf, -kInf};
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) {
      const Vec3<double>& p = mesh.vertices[v];
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  return {low, high};
}

std::string to_text(const Bounds& b) {
  return fmt::format("{},{},{} to {},{},{}", b.low.x, b.low.y, b.low.z, b.high.x, b.high.y,
                     b.high.z);
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

std::vector<std::string> attributes(const io::Mesh& mesh) {
  std::vector<std::string> list;
  if (!mesh.normals.empty()) list.emplace_back("normals");
  if (!mesh.colors.empty()) list.emplace_back("colours");
  if (!mesh.texcoords.empty()) list.emplace_back("texture coordinates");
  return list;
}

using tool::add_tree;  // the one for JSON

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

Summary describe(const Options& options, const io::Mesh& mesh) {
  const std::vector<std::string> extras = attributes(mesh);
  Summary table;
  table.add("file", options.mesh);
  table.add("format", mesh.format);
  table.add("coordinates", mesh.single_precision ? "32-bit" : "64-bit");
  table.add("attributes", extras.empty() ? "none" : fmt::format("{}", fmt::join(extras, ", ")));
  table.add("vertices", fmt::format("{}, {} of them unused", grouped(mesh.vertices.size()),
                                    grouped(unused_vertices(mesh.view()))));
  table.add("triangles", grouped(mesh.triangles.size()));
  table.add("bounds", to_text(bounds(mesh.view())));
  table.add("duplicates", grouped(duplicates(mesh.view())));
  table.add("closed by index", describe(closedness(mesh.view(), SameVertex::Index), mesh.view()));
  table.add("closed by position",
            describe(closedness(mesh.view(), SameVertex::Position), mesh.view()));
  return table;
}

io::JsonWriter describe_as_json(const Options& options, const io::Mesh& mesh) {
  const Bounds box = bounds(mesh.view());
  io::JsonWriter json;
  json.open_object();
  json.value("command", "info");
  json.value("mesh", options.mesh);
  json.value("format", mesh.format);
  json.value("coordinate_bits", mesh.single_precision ? 32 : 64);
  json.open_array("attributes");
  for (const std::string& extra : attributes(mesh)) json.value("", extra);
  json.close_array();
  json.value("vertices", mesh.vertices.size());
  json.value("unused_vertices", unused_vertices(mesh.view()));
  json.value("triangles", mesh.triangles.size());
  add_bounds(json, box.low, box.high);
  json.value("duplicates", duplicates(mesh.view()));
  add_closedness(json, "closed_by_index", closedness(mesh.view(), SameVertex::Index));
  add_closedness(json, "closed_by_position", closedness(mesh.view(), SameVertex::Position));
  return json;
}

/// Adds what is known of the search tree.
template <class Out>
void add_tree_of(Out& out, const Options& options, io::Mesh mesh) {
  const BuildOptions build = {.threads = options.threads};
  if (choose_float(options.precision, options.mesh, mesh.single_precision)) {
    const SceneFile<float> file(options.mesh, std::move(mesh), build);
    add_tree(out, file.scene().info(), file.build_seconds());
  } else {
    const SceneFile<double> file(options.mesh, std::move(mesh), build);
    add_tree(out, file.scene().info(), file.build_seconds());
  }
}

int run(const Options& options) {
  io::Mesh mesh = read_triangles(options.mesh);
  if (options.json) {
    io::JsonWriter json = describe_as_json(options, mesh);
    add_tree_of(json, options, std::move(mesh));
    finish_json(json);
  } else {
    Summary table = describe(options, mesh);
    add_tree_of(table, options, std::move(mesh));
    print(table.text());
  }
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
  sub->add_flag("--json", options->json,
                "Print one JSON object; numbers that are not finite are null");
  sub->footer(
      "Examples:\n"
      "  pierce info bunny.obj\n"
      "  pierce info bunny.obj --json\n"
      "A mesh is closed if each edge is used once each way. By index: edges are the same if their\n"
      "vertex numbers are; by position: if their coordinates are.\n"
      "The members of --json: command mesh format coordinate_bits attributes vertices\n"
      "unused_vertices triangles bounds duplicates closed_by_index closed_by_position (each with\n"
      "closed balanced edges open_edges unbalanced_edges crowded_edges) without_area\n"
      "build_seconds nodes leaves sah_cost tree_bytes.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
