// SPDX-License-Identifier: Apache-2.0
//
// pierce info: what mesh files hold, whether the meshes are closed, and the search tree over them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bounds.h"
#include "closed_text.h"
#include "command.h"
#include "edge_widths.h"
#include "failure.h"
#include "file_options.h"
#include "info_json.h"
#include "loaded_scene.h"
#include "mesh/coincident.h"
#include "mesh_measures.h"
#include "one_mesh.h"
#include "open_edges.h"
#include "output.h"
#include "pierce/closed.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

struct InfoArguments {
  MeshOptions meshes;
  std::string open_edges;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool self_intersections = false;
  bool json = false;
};

template <class Real>
std::string bounds(MeshView<Real> mesh) {
  const Box box = box_of(std::span(&std::as_const(mesh), 1));
  const auto [low, high] = std::pair(convert<Real>(box.low), convert<Real>(box.high));
  return fmt::format("{},{},{} to {},{},{}", low.x, low.y, low.z, high.x, high.y, high.z);
}

// Vertices that no triangle names.
template <class Real>
std::uint64_t unused_vertices(MeshView<Real> mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) used[v] = true;
  }
  return static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
}

// Triangles with the same three corner positions as an earlier one, in whatever order; and of
// those, which lie back to back.
template <class Real>
std::string duplicates_text(MeshView<Real> mesh) {
  const mesh::Coincident found = mesh::coincident_triangles(mesh, {});
  std::string text = grouped(found.repeats.size());
  if (found.cancelling != 0) {
    text += fmt::format(
        "; {} lie back to back and cancel: what is inside may be found with --rule unique",
        counted(found.cancelling, "triangle", "triangles"));
  }
  return text;
}

std::vector<std::string> attributes(const io::Mesh& mesh) {
  std::vector<std::string> list;
  if (!mesh.normals.empty()) list.emplace_back("normals");
  if (!mesh.colors.empty()) list.emplace_back("colours");
  if (!mesh.texcoords.empty()) list.emplace_back("texture coordinates");
  return list;
}

void add_file(Summary& table, const io::Mesh& mesh, bool single_precision) {
  table.add("format", mesh.format);
  table.add("coordinates", single_precision ? "32-bit" : "64-bit");
  const std::vector<std::string> extras = attributes(mesh);
  table.add("attributes", extras.empty() ? "none" : fmt::format("{}", fmt::join(extras, ", ")));
  const io::PolygonCounts& polygons = mesh.polygons;
  if (polygons.all == 0) return;
  table.add("polygons", fmt::format("{}, {} of them concave and not fanned, {} not exactly flat",
                                    grouped(polygons.all), grouped(polygons.refanned),
                                    grouped(polygons.not_flat)));
}

// What is known of one mesh, or of all together, without a scene. Vertices of several meshes have
// no numbers in common.
template <class Real>
void add_mesh(Summary& table, const OneMesh<Real>& meshes, unsigned threads) {
  const MeshView<Real> mesh = meshes.view();
  table.add("vertices", fmt::format("{}, {} of them unused", grouped(mesh.vertices.size()),
                                    grouped(unused_vertices(mesh))));
  table.add("triangles", grouped(mesh.triangles.size()));
  table.add("bounds", bounds(mesh));
  table.add("duplicates", duplicates_text(mesh));
  if (meshes.meshes() == 1) {
    table.add("closed by index", closed_text(meshes, SameVertex::Index));
  }
  table.add("closed by position", closed_text(meshes, SameVertex::Position));
  add_measures(table, measure(mesh, SameVertex::Position, {.threads = threads}));
}

template <class Real>
std::vector<TrianglePair> pairs_of(const OneMesh<Real>& meshes, unsigned threads) {
  return self_intersections(meshes.view(), {.threads = threads});
}

template <class Real>
std::string pairs_text(const OneMesh<Real>& meshes, unsigned threads) {
  const std::vector<TrianglePair> pairs = pairs_of(meshes, threads);
  if (pairs.empty()) return "none";
  return fmt::format("{} of triangles; the first: {} and {}",
                     counted(pairs.size(), "pair", "pairs"), triangle_text(meshes, pairs[0].first),
                     triangle_text(meshes, pairs[0].second));
}

void add_file(io::JsonWriter& json, const io::Mesh& mesh) {
  json.value("format", mesh.format);
  json.value("coordinate_bits", mesh.single_precision ? 32 : 64);
  json.open_array("attributes");
  for (const std::string& extra : attributes(mesh)) json.value("", extra);
  json.close_array();
  json.value("polygons", mesh.polygons.all);
  json.value("polygons_not_fanned", mesh.polygons.refanned);
  json.value("polygons_not_flat", mesh.polygons.not_flat);
}

template <class Real>
void add_mesh(io::JsonWriter& json, const OneMesh<Real>& meshes, unsigned threads) {
  const MeshView<Real> mesh = meshes.view();
  json.value("vertices", mesh.vertices.size());
  json.value("unused_vertices", unused_vertices(mesh));
  json.value("triangles", mesh.triangles.size());
  const Box box = box_of(std::span(&mesh, 1));
  add_bounds(json, box.low, box.high);
  const mesh::Coincident coincident = mesh::coincident_triangles(mesh, {});
  json.value("duplicates", coincident.repeats.size());
  json.value("back_to_back", coincident.cancelling);
  if (meshes.meshes() == 1) {
    add_closedness(json, "closed_by_index", closedness(mesh, SameVertex::Index));
  }
  add_closedness(json, "closed_by_position", closedness(mesh, SameVertex::Position));
  add_measures(json, measure(mesh, SameVertex::Position, {.threads = threads}));
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

struct OpenEdges {
  std::uint64_t edges;
  WidthSummary widths;
  Vec3<double> widest_at;  // the middle of that edge
};

// Writes the file of --open-edges.
template <class Real>
OpenEdges list_open_edges(const InfoArguments& options, const OneMesh<Real>& meshes) {
  const std::vector<EdgeUse> edges = open_edges(meshes.view());
  const std::vector<double> widths = edge_widths(meshes.view(), std::span(edges));
  write_open_edges(options.open_edges, meshes, edges, widths);
  OpenEdges open = {edges.size(), summary_of(widths), {}};
  if (edges.empty()) return open;
  const EdgeUse& widest = edges[open.widths.widest_edge];
  open.widest_at = 0.5 * convert<double>(meshes.view().vertices[widest.from]) +
                   0.5 * convert<double>(meshes.view().vertices[widest.to]);
  return open;
}

std::string widths_text(const OpenEdges& open) {
  const WidthSummary& w = open.widths;
  return fmt::format("{:.4g} to {:.4g} wide, median {:.4g}, {} of them 0; the widest at {}",
                     w.narrowest, w.widest, w.median, grouped(w.zero), place_text(open.widest_at));
}

// Triangles without area.
template <class Real>
std::uint64_t without_area(MeshView<Real> mesh, unsigned threads) {
  return Scene<Real>::build(mesh, {.work = {.threads = threads}}).info().degenerate;
}

// One geometry of several, by itself.
template <class Real>
std::string geometry_text(const LoadedScene<Real>& loaded, bool single, std::size_t i,
                          unsigned threads) {
  const Geometry& geometry = loaded.meshes().geometries()[i];
  const MeshView<Real> view = loaded.views()[i];
  Summary table;
  table.add(fmt::format("geometry {}", i), geometry.name());
  add_file(table, geometry.mesh, single);
  add_mesh(table, OneMesh<Real>(std::span(&view, 1)), threads);
  table.add("without area", grouped(without_area(view, threads)));
  return "\n" + table.text();
}

template <class Real>
void print_json(const InfoArguments& options, const LoadedScene<Real>& loaded,
                const OneMesh<Real>& together) {
  const auto all = loaded.meshes().geometries();
  io::JsonWriter json;
  json.open_object();
  json.value("command", "info");
  json.value("mesh", all.size() == 1 ? all[0].name() : name_of(options.meshes.files));
  add_meshes(json, options.meshes.files);
  if (all.size() == 1) add_file(json, all[0].mesh);
  add_mesh(json, together, options.threads);
  if (options.self_intersections) {
    json.value("self_intersections", pairs_of(together, options.threads).size());
  }
  add_tree(json, loaded.scene().info(), loaded.build_seconds());
  if (!options.open_edges.empty()) {
    json.open_object("open_edges");
    const OpenEdges open = list_open_edges(options, together);
    json.value("edges", open.edges);
    if (open.widths.finite > 0) {
      json.value("narrowest", open.widths.narrowest);
      json.value("median_width", open.widths.median);
      json.value("widest", open.widths.widest);
      json.value("zero_width", open.widths.zero);
    }
    json.value("out", options.open_edges);
    json.close_object();
  }
  if (all.size() > 1) {
    json.open_array("geometries");
    for (std::size_t i = 0; i < all.size(); ++i) {
      json.open_object();
      json.value("name", all[i].name());
      add_file(json, all[i].mesh);
      add_mesh(json, OneMesh<Real>(loaded.views().subspan(i, 1)), options.threads);
      json.value("without_area", without_area(loaded.views()[i], options.threads));
      json.close_object();
    }
    json.close_array();
  }
  finish_json(json);
}

template <class Real>
void print_text(const InfoArguments& options, const LoadedScene<Real>& loaded,
                const OneMesh<Real>& together) {
  const auto all = loaded.meshes().geometries();
  Summary table;
  if (all.size() == 1) {
    table.add("file", all[0].name());
    add_file(table, all[0].mesh, all[0].mesh.single_precision);
  } else {
    table.add("file", name_of(options.meshes.files));
    table.add("geometries", grouped(all.size()));
  }
  add_mesh(table, together, options.threads);
  if (options.self_intersections) {
    table.add("self-intersections", pairs_text(together, options.threads));
  }
  add_tree(table, loaded.scene().info(), loaded.build_seconds());
  if (!options.open_edges.empty()) {
    const OpenEdges open = list_open_edges(options, together);
    if (open.widths.finite > 0) table.add("cracks", widths_text(open));
    table.add("wrote", fmt::format("{}: {} not used as often one way as the other",
                                   options.open_edges, counted(open.edges, "edge", "edges")));
  }
  std::string text = table.text();
  for (std::size_t i = 0; all.size() > 1 && i < all.size(); ++i) {
    text += geometry_text(loaded, all[i].mesh.single_precision, i, options.threads);
  }
  print(text);
}

template <class Real>
int info_as(const InfoArguments& options, std::vector<Geometry> geometries) {
  const LoadedScene<Real> loaded(std::move(geometries), {.work = {.threads = options.threads}});
  const OneMesh<Real> together(loaded.views());
  if (options.json) {
    print_json(options, loaded, together);
  } else {
    print_text(options, loaded, together);
  }
  return 0;
}

int run(const InfoArguments& options) {
  if (!options.open_edges.empty()) {
    check_extension(options.open_edges, {".csv", ".ply"}, "--open-edges");
    refuse_to_replace(options.open_edges, inputs(options.meshes), "--open-edges");
  }
  std::vector<Geometry> geometries = read_geometries(options.meshes);
  return choose_float(options.precision, geometries)
             ? info_as<float>(options, std::move(geometries))
             : info_as<double>(options, std::move(geometries));
}

}  // namespace

Command add_info(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("info", "Describe a mesh and its search tree");
  const auto options = std::make_shared<InfoArguments>();
  add_mesh_arguments(*sub, options->meshes);
  sub->add_option(
         "--open-edges", options->open_edges,
         "Write every edge that is not used as often one way as the other, by position: "
         ".csv with its vertices, first triangle, uses, ends and width (how far its middle is "
         "from the nearest other one), or .ply for a viewer")
      ->type_name("FILE");
  sub->add_flag("--self-intersections", options->self_intersections,
                "Count the pairs of triangles that share more than their common corners, or edge");
  sub->add_flag("--verify", options->meshes.verify,
                "Of scene files look at every byte: checksums, and that nothing leads out of them");
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->add_flag("--json", options->json,
                "Print one JSON object; numbers that are not finite are null");
  sub->footer(
      "Examples:\n"
      "  pierce info bunny.obj\n"
      "  pierce info house.obj --parts\n"
      "  pierce info scan.ply --open-edges edges.csv --self-intersections\n"
      "  pierce info bunny.obj --json\n"
      "  pierce info city.pierce --verify\n"
      "A mesh is closed if each edge is used once each way. By index: edges are the same if their\n"
      "vertex numbers are; by position: if their coordinates are. With T-junctions, edges of "
      "which\n"
      "others are parts, it is closed if every piece is used once each way. Several geometries are "
      "told of\n"
      "together, as a scene sees them, and each by itself. Volume (of what is open: with cones\n"
      "from the origin), area, components, Euler number and facing go by position.\n"
      "The members of --json: command mesh meshes format coordinate_bits attributes polygons\n"
      "polygons_not_fanned polygons_not_flat vertices unused_vertices triangles bounds\n"
      "duplicates back_to_back closed_by_index closed_by_position (each with closed balanced\n"
      "watertight edges open_edges unbalanced_edges crowded_edges in_pieces) volume area\n"
      "components euler consistent orientable, with --self-intersections self_intersections;\n"
      "without_area build_seconds nodes leaves sah_cost tree_bytes, with --open-edges open_edges\n"
      "(edges narrowest median_width widest zero_width out);\n"
      "of several geometries, what is of one is in geometries, an array.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
