// SPDX-License-Identifier: Apache-2.0
#include "cast_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "choice.h"
#include "failure.h"
#include "interrupt.h"
#include "parse.h"

namespace pierce::tool {
namespace {

const Choices<Query>& queries() {
  static const Choices<Query> all = {{"closest", Query::Closest},
                                     {"any", Query::Any},
                                     {"all", Query::All},
                                     {"count", Query::Count},
                                     {"crossings", Query::Crossings}};
  return all;
}

std::vector<double> parse_rays(const std::vector<std::string>& texts) {
  std::vector<double> rows;
  for (const std::string& text : texts) {
    std::vector<double> row = parse_row(text, "--ray");
    if (row.size() == 6) row.insert(row.end(), {0, kInfinity<double>});
    if (row.size() != 8) {
      throw UsageError(
          fmt::format("--ray: '{}' has {} numbers; give 6 or 8: "
                      "ox,oy,oz,dx,dy,dz[,t_min,t_max]",
                      text, row.size()));
    }
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

}  // namespace

void add_query_options(CLI::App& app, CastOptions& options) {
  add_choice<Query>(app, "--query", options.query, queries(),
                    "closest: the first hit of each ray; any: whether there is one; all: every "
                    "hit; count: how many there are; crossings: how often it passes through the "
                    "surface");
  add_choice<Sides>(app, "--sides", options.sides,
                    {{"both", Sides::Both}, {"front", Sides::Front}, {"back", Sides::Back}},
                    "front: only where rays meet the front of a triangle, and enter; back: only "
                    "where they leave");
  add_choice<Range>(app, "--range", options.range,
                    {{"closed", Range::Closed}, {"open-start", Range::OpenStart}},
                    "open-start: a hit exactly at t_min does not count");
  app.add_option("--max-hits", options.max_hits,
                 "With --query all: no more than the first K hits of each ray")
      ->check(CLI::Range(std::uint64_t{1}, kUnlimited - 1).description("K"));
}

const char* name_of(Query query) {
  for (const auto& [name, value] : queries()) {
    if (value == query) return name.c_str();
  }
  return "";
}

BatchOptions batch_options(const CastOptions& options) {
  BatchOptions batch;
  batch.work.threads = options.threads;
  batch.range = options.range;
  batch.sides = options.sides;
  batch.max_hits = options.max_hits;
  batch.work.stop = interrupt::stop();
  return batch;
}

void check_rays(const CastOptions& options) {
  if (options.rays.empty() && options.ray.empty()) {
    throw UsageError("give --rays FILE, or --ray ox,oy,oz,dx,dy,dz");
  }
  if (!options.rays.empty() && !options.ray.empty()) {
    throw UsageError("--ray: cannot be given together with --rays; choose one");
  }
}

io::RayFile open_rays(const CastOptions& options) {
  if (!options.ray.empty()) return {parse_rays(options.ray), "--ray"};
  io::RayFile file{std::filesystem::path(options.rays)};
  print_warnings(file.remarks(), options.meshes.strict);
  return file;
}

}  // namespace pierce::tool
