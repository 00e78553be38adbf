// SPDX-License-Identifier: Apache-2.0
//
// Everything that was measured, every round of it, so that a page can be made of it later.
#include "io/json_writer.h"
#include "suite/report.h"
#include "suite/samples.h"

namespace pierce::bench {
namespace {

void write_build(io::JsonWriter& json, const MeshResult& mesh, const BuildResult& build) {
  const double triangles = static_cast<double>(mesh.triangles);
  json.open_object();
  json.value("engine", build.engine);
  json.values("seconds", build.seconds);
  json.value("mtri_per_second", 1e-6 * triangles / median(build.seconds));
  json.value("bytes_per_triangle", static_cast<double>(build.bytes) / triangles);
  if (build.sah_cost > 0) json.value("sah_cost", build.sah_cost);
  json.close_object();
}

void write_ladder(io::JsonWriter& json, const Statistics& s) {
  json.open_object("ladder");
  json.value("rays", s.rays);
  json.value("nodes", s.nodes);
  json.value("leaves", s.leaves);
  json.value("candidates", s.candidates);
  json.value("certified", s.certified);
  json.value("settled", s.settled);
  json.value("settled_big", s.settled_big);
  json.value("orders_certified", s.orders_certified);
  json.value("orders_settled", s.orders_settled);
  json.value("hits", s.hits);
  json.value("rounded_exactly", s.rounded_exactly);
  json.value("rays_placed_exactly", s.rays_placed_exactly);
  json.close_object();
}

void write_timing(io::JsonWriter& json, const Timing& timing) {
  const std::vector<double> speeds = timing.speeds();
  json.open_object();
  json.value("contender", timing.contender);
  json.value("threads", timing.threads);
  json.value("rays", timing.rays);
  json.values("seconds", timing.seconds);
  json.value("rays_per_second", median(speeds));
  json.value("lower_quartile", quantile(speeds, 0.25));
  json.value("upper_quartile", quantile(speeds, 0.75));
  json.value("compared", timing.differences.compared);
  json.value("missed", timing.differences.missed);
  json.value("invented", timing.differences.invented);
  json.value("other_triangle", timing.differences.other_triangle);
  json.value("tied", timing.differences.tied);
  json.close_object();
}

void write_cell(io::JsonWriter& json, const Cell& cell) {
  json.open_object();
  json.value("set", cell.set);
  json.value("query", name_of(cell.query));
  json.value("rays", cell.rays);
  json.value("hits", cell.hits);
  if (cell.ladder) write_ladder(json, *cell.ladder);
  json.open_array("timings");
  for (const Timing& timing : cell.timings) write_timing(json, timing);
  json.close_array();
  json.close_object();
}

}  // namespace

std::string to_json(const SuiteResult& result, const MachineLines& machine) {
  io::JsonWriter json(6);
  json.open_object();
  json.open_object("machine");
  for (const auto& [name, value] : machine) json.value(name, value);
  json.close_object();
  json.value("rounds", result.options.rounds);
  json.value("build_rounds", result.options.build_rounds);
  json.value("side", result.options.side);
  json.value("clock", result.options.clock == Clock::Wall ? "wall" : "cpu");
  json.open_array("meshes");
  for (const MeshResult& mesh : result.meshes) {
    json.open_object();
    json.value("mesh", mesh.mesh);
    json.value("triangles", mesh.triangles);
    json.value("vertices", mesh.vertices);
    json.open_array("builds");
    for (const BuildResult& build : mesh.builds)
      if (build.bytes > 0) write_build(json, mesh, build);
    json.close_array();
    json.open_array("cells");
    for (const Cell& cell : mesh.cells) write_cell(json, cell);
    json.close_array();
    json.close_object();
  }
  json.close_array();
  json.close_object();
  return json.text();
}

}  // namespace pierce::bench
