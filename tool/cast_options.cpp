// SPDX-License-Identifier: Apache-2.0
#include "cast_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "choice.h"
#include "failure.h"
#include "interrupt.h"
#include "parse.h"
#include "support/parallel.h"

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

const Choices<Sides>& sides_words() {
  static const Choices<Sides> all = {
      {"both", Sides::Both}, {"front", Sides::Front}, {"back", Sides::Back}};
  return all;
}

const Choices<Range>& range_words() {
  static const Choices<Range> all = {{"closed", Range::Closed}, {"open-start", Range::OpenStart}};
  return all;
}

const Choices<Reduction>& reductions() {
  static const Choices<Reduction> all = {
      {"none", Reduction::None},           {"bits", Reduction::Bits},
      {"depth", Reduction::Depth},         {"histogram", Reduction::Histogram},
      {"triangles", Reduction::Triangles}, {"parts", Reduction::Parts}};
  return all;
}

template <class Value>
const char* word_of(const Choices<Value>& choices, Value wanted) {
  for (const auto& [name, value] : choices) {
    if (value == wanted) return name.c_str();
  }
  return "";
}

template <class Value>
void read_word(const io::JsonView& json, const Choices<Value>& choices, Value& value) {
  for (const auto& [name, of_name] : choices) {
    if (name == json.text()) {
      value = of_name;
      return;
    }
  }
  json.fail("is none of the words that this pierce knows");
}

bool fits(Query query, Reduction reduction) {
  return reduction == Reduction::None || query == Query::Closest ||
         (query == Query::Any && reduction == Reduction::Bits);
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
  add_choice<Sides>(app, "--sides", options.sides, sides_words(),
                    "front: only where rays meet the front of a triangle, and enter; back: only "
                    "where they leave");
  add_choice<Range>(app, "--range", options.range, range_words(),
                    "open-start: a hit exactly at t_min does not count");
  app.add_option("--max-hits", options.max_hits,
                 "With --query all: no more than the first K hits of each ray")
      ->check(CLI::Range(std::uint64_t{1}, kUnlimited - 1).description("K"));
  add_choice<Reduction>(app, "--reduce", options.reduce.reduction, reductions(),
                        "Of first hits keep but this, as a .npy array: bits: hit or not, eight "
                        "rays a byte (numpy.unpackbits); depth: t, in the shape of the picture; "
                        "histogram: how many have t in each part of --t-range; triangles, parts: "
                        "how many each triangle, or geometry, has");
  app.add_option("--bins", options.reduce.bins, "With --reduce histogram: how many parts")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 24).description("N"))
      ->default_str("100");
  app.add_option("--t-range", options.t_range, "With --reduce histogram: t from LOW on, below HIGH")
      ->type_name("LOW,HIGH");
}

const char* name_of(Query query) { return word_of(queries(), query); }
const char* name_of(Reduction reduction) { return word_of(reductions(), reduction); }
const char* name_of(Sides sides) { return word_of(sides_words(), sides); }
const char* name_of(Range range) { return word_of(range_words(), range); }

void parse_question(const io::JsonView& json, CastOptions& options) {
  read_word(json.at("query"), queries(), options.query);
  read_word(json.at("sides"), sides_words(), options.sides);
  read_word(json.at("range"), range_words(), options.range);
  options.max_hits = json.has("max_hits") ? json.at("max_hits").whole(kUnlimited - 1) : kUnlimited;
  read_word(json.at("reduce"), reductions(), options.reduce.reduction);
  constexpr std::uint64_t kMostBins = 1U << 24;
  options.reduce.bins = json.at("bins").whole(kMostBins);
  options.reduce.low = json.at("t_low").number();
  options.reduce.high = json.at("t_high").number();
  const Reduction reduction = options.reduce.reduction;
  if (!fits(options.query, reduction)) json.at("reduce").fail("does not fit the query");
  if (reduction != Reduction::Histogram) return;
  if (options.reduce.bins == 0) json.at("bins").fail("there must be one at least");
  if (!(options.reduce.low < options.reduce.high)) json.at("t_high").fail("is not above t_low");
}

std::size_t rays_at_a_time(unsigned threads) {
  constexpr std::size_t kLeast = std::size_t{1} << 20, kForEach = std::size_t{1} << 15;
  return std::max(kLeast, kForEach * parallel::thread_count(threads));
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

namespace {

void check_rays(const CastOptions& options) {
  const RayOptions& source = options.source;
  check_one_source(source);
  if (source.rays.empty() && !source.made() && options.ray.empty()) {
    throw UsageError("give --rays FILE, or --ray ox,oy,oz,dx,dy,dz");
  }
  if ((!source.rays.empty() || source.made()) && !options.ray.empty()) {
    throw UsageError(fmt::format("--ray: cannot be given together with --{}; choose one",
                                 source.made() ? "camera, --grid, --lidar or --sphere" : "rays"));
  }
}

io::RayFile open_rays(const CastOptions& options) {
  if (!options.ray.empty()) return {parse_rays(options.ray), "--ray"};
  io::RayFile file{std::filesystem::path(options.source.rays)};
  print_warnings(file.remarks(), options.meshes.strict);
  return file;
}

void check_reduction(CastOptions& options) {
  ReduceOptions& reduce = options.reduce;
  const Query query = options.query;
  if (reduce.reduction == Reduction::None) {
    if (!options.t_range.empty()) throw UsageError("--t-range: is for --reduce histogram");
    return;
  }
  if (!fits(query, reduce.reduction)) {
    throw UsageError(fmt::format("--reduce {}: is of first hits, not of --query {}",
                                 name_of(reduce.reduction), name_of(query)));
  }
  if (reduce.reduction != Reduction::Histogram) return;
  if (options.t_range.empty()) throw UsageError("--reduce histogram: give --t-range LOW,HIGH");
  const std::vector<double> range = parse_numbers(options.t_range, 2, "--t-range");
  if (!(range[0] < range[1])) throw UsageError("--t-range: LOW must be less than HIGH");
  reduce.low = range[0];
  reduce.high = range[1];
}

}  // namespace

void check_cast(CastOptions& options) {
  if (options.max_hits != kUnlimited && options.query != Query::All) {
    throw UsageError("--max-hits: only the lists of --query all can be cut short");
  }
  check_rays(options);
  check_reduction(options);
}

CastInputs read_inputs(const CastOptions& options) {
  CastInputs read;
  if (!options.source.made()) read.rays.emplace(open_rays(options));
  read.meshes = read_geometries(options.meshes);
  read.use_float =
      choose_float(options.precision, read.meshes, read.rays ? read.rays->name() : std::string(),
                   !read.rays || counts_as_single(*read.rays, options.precision));
  return read;
}

}  // namespace pierce::tool
