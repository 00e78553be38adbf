// SPDX-License-Identifier: Apache-2.0
//
// The table of unkind scenes, and the same with every round as JSON.
#include <fmt/format.h>

#include "io/json_writer.h"
#include "suite/samples.h"
#include "unkind/unkind.h"

namespace pierce::bench {
namespace {

std::string ns_text(double ns) {
  return ns > 0 ? fmt::format("{:>9.{}f}", ns, ns < 100 ? 1 : 0) : fmt::format("{:>9}", "-");
}

std::string ratio_text(double ratio) {
  return ratio > 0 ? fmt::format("{:>8.{}f}", ratio, ratio < 100 ? 2 : 0)
                   : fmt::format("{:>8}", "-");
}

void write_twin(io::JsonWriter& json, const char* key, const TwinResult& twin) {
  json.open_object(key);
  json.value("triangles", twin.triangles);
  json.value("questions", twin.questions);
  json.open_array("ways");
  for (const WayTiming& way : twin.ways) {
    json.open_object();
    json.value("way", way.way);
    json.value("questions", way.questions);
    json.value("different", way.different);
    json.value("ns", median(way.ns));
    json.values("rounds", way.ns);
    json.close_object();
  }
  json.close_array();
  json.close_object();
}

std::string names_where(const std::vector<UnkindRow>& rows, bool (UnkindRatios::*worse)() const) {
  std::string names;
  std::size_t count = 0;
  for (const UnkindRow& row : rows) {
    if (!(ratios_of(row).*worse)()) continue;
    names.append(count++ == 0 ? ": " : ", ").append(row.scene->name);
  }
  return fmt::format("{} of {}{}", count, rows.size(), names);
}

}  // namespace

std::string unkind_header() {
  return fmt::format(
      "ns a question (all hits: a hit); one: pierce, question by question; /peer: over the faster "
      "peer that answers alike (9 of 10);\n/kind: over the same of the kind twin; different: other "
      "answers than pierce's\n"
      "{:<20} {:<8}{:>9}{:>9}{:>9}{:>9} |{:>9}{:>9} |{:>8}{:>8}{:>8}{:>8}{:>8} | different\n",
      "scene", "query", "one", "batch", "embree", "cgal", "kind one", "batch", "1/peer", "b/peer",
      "1/kind", "b/kind", "b/1");
}

std::string unkind_text(const UnkindRow& row) {
  const UnkindRatios r = ratios_of(row);
  std::string different;
  for (const WayTiming& way : row.unkind.ways) {
    if (way.different > 0)
      different += fmt::format(" {} {}/{}", way.way, way.different, way.questions);
  }
  return fmt::format("{:<20} {:<8}{}{}{}{} |{}{} |{}{}{}{}{} |{}\n", row.scene->name,
                     name_of(row.scene->ask), ns_text(row.unkind.ns("one")),
                     ns_text(row.unkind.ns("batch")), ns_text(row.unkind.ns("embree")),
                     ns_text(row.unkind.ns("cgal")), ns_text(row.kind.ns("one")),
                     ns_text(row.kind.ns("batch")), ratio_text(r.one_peer),
                     ratio_text(r.batch_peer), ratio_text(r.one_kind), ratio_text(r.batch_kind),
                     ratio_text(r.batch_one), different.empty() ? " -" : different);
}

std::string unkind_summary(const std::vector<UnkindRow>& rows) {
  return fmt::format(
      "\nmore than 2 times the better peer    {}\nmore than 3 times the kind twin      {}\n"
      "a batch slower than singles by 20 %  {}\n",
      names_where(rows, &UnkindRatios::worse_than_peer),
      names_where(rows, &UnkindRatios::worse_than_kind),
      names_where(rows, &UnkindRatios::worse_than_loop));
}

std::string unkind_list() {
  std::string text = "unkind scenes, each beside its kind twin:\n";
  for (const UnkindScene& scene : unkind_scenes())
    text += fmt::format("    {:<20} {} (twin: {})\n", scene.name, scene.description, scene.twin);
  return text;
}

std::string unkind_json(const std::vector<UnkindRow>& rows, const UnkindOptions& options,
                        const std::vector<std::pair<std::string, std::string>>& machine) {
  io::JsonWriter json(6);
  json.open_object();
  json.open_object("machine");
  for (const auto& [name, value] : machine) json.value(name, value);
  json.close_object();
  json.value("rounds", options.rounds);
  json.value("detail", options.detail.percent);
  json.open_array("scenes");
  for (const UnkindRow& row : rows) {
    const UnkindRatios r = ratios_of(row);
    json.open_object();
    json.value("scene", row.scene->name);
    json.value("description", row.scene->description);
    json.value("twin", row.scene->twin);
    json.value("query", name_of(row.scene->ask));
    write_twin(json, "unkind", row.unkind);
    write_twin(json, "kind", row.kind);
    json.open_object("ratios");  // 0: nothing to compare with
    json.value("one_peer", r.one_peer);
    json.value("batch_peer", r.batch_peer);
    json.value("one_kind", r.one_kind);
    json.value("batch_kind", r.batch_kind);
    json.value("batch_one", r.batch_one);
    json.close_object();
    json.close_object();
  }
  json.close_array();
  json.close_object();
  return json.text();
}

}  // namespace pierce::bench
