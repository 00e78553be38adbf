// SPDX-License-Identifier: Apache-2.0
//
// pierce bench: speeds beside those of others, after their answers were compared. The experiment
// itself lives in bench/; here is only what the user asks for and where the figures go.
#include "bench_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "choice.h"
#include "failure.h"
#include "interrupt.h"
#include "io/output_file.h"
#include "kernels/kernel.h"
#include "output.h"
#include "suite/failures.h"
#include "suite/machine.h"
#include "suite/report.h"
#include "suite/suite.h"
#include "unkind/unkind.h"

namespace pierce::tool {
namespace {

struct BenchArguments {
  std::vector<std::string> files, meshes, sets, contenders, against, kernels;
  std::vector<bench::Query> queries{bench::Query::Closest, bench::Query::Any};
  std::string json;
  bench::UnkindOptions unkind;
  bool suite = false, list = false, failures = false, cpu_clock = false, is_unkind = false;
  unsigned rounds = 5, build_rounds = 0, threads = 1, build_threads = 0, side = 1024;
};

template <class Value>
bool contains(const std::vector<Value>& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

template <class Kinds>
std::vector<std::string> default_names(const Kinds& kinds) {
  std::vector<std::string> names;
  for (const auto& kind : kinds)
    if (kind.by_default) names.push_back(kind.name);
  return names;
}

// Better to hear of a wrong name at once than after half an hour.
template <class Kinds>
void check_names(const char* option, const std::vector<std::string>& names, const Kinds& kinds) {
  for (const std::string& name : names) {
    if (std::any_of(kinds.begin(), kinds.end(),
                    [&](const auto& kind) { return kind.name == name; })) {
      continue;
    }
    std::vector<std::string> known;
    for (const auto& kind : kinds) known.push_back(kind.name);
    throw UsageError(fmt::format("{}: there is no '{}' in this build; there are: {}", option, name,
                                 fmt::join(known, ", ")));
  }
}

// Pierce and whoever it is to be compared with.
std::vector<std::string> contenders_against(const std::vector<std::string>& families) {
  const auto& kinds = bench::contender_kinds();
  for (const std::string& family : families) {
    if (std::none_of(kinds.begin(), kinds.end(),
                     [&](const bench::ContenderKind& kind) { return kind.family == family; })) {
      throw UsageError(
          fmt::format("--against {}: not in this build; see 'pierce bench --list'", family));
    }
  }
  std::vector<std::string> names;
  for (const bench::ContenderKind& kind : kinds) {
    const bool wanted = families.empty() ? kind.by_default
                                         : (kind.family == "pierce" && kind.by_default) ||
                                               contains(families, kind.family);
    if (wanted) names.push_back(kind.name);
  }
  return names;
}

// Each of pierce's contenders for each of the kernels, side by side.
std::vector<std::string> for_each_kernel(const std::vector<std::string>& contenders,
                                         const std::vector<std::string>& kernels) {
  if (kernels.empty()) return contenders;
  std::vector<std::string> known;
  for (const kernels::Kernel* kernel : kernels::kernels()) known.emplace_back(kernel->name);
  for (const std::string& name : kernels) {
    if (!contains(known, name))
      throw UsageError(fmt::format("--kernels: there is no '{}' on this machine; there are: {}",
                                   name, fmt::join(known, ", ")));
  }
  std::vector<std::string> names;
  for (const std::string& contender : contenders) {
    if (!contender.starts_with("pierce")) {
      names.push_back(contender);
      continue;
    }
    for (const std::string& kernel : kernels) names.push_back(contender + '@' + kernel);
  }
  return names;
}

bench::SuiteOptions suite_options(const BenchArguments& options) {
  bench::SuiteOptions suite;
  suite.meshes = options.meshes;
  if (options.suite && options.meshes.empty()) suite.meshes = default_names(bench::mesh_kinds());
  suite.files.assign(options.files.begin(), options.files.end());
  if (suite.meshes.empty() && suite.files.empty())
    throw UsageError(
        "name a mesh file, --meshes or --suite; 'pierce bench --list' tells the names");
  suite.sets = options.sets.empty() ? default_names(bench::ray_kinds()) : options.sets;
  suite.contenders =
      options.contenders.empty() ? contenders_against(options.against) : options.contenders;
  check_names("--meshes", suite.meshes, bench::mesh_kinds());
  check_names("--sets", suite.sets, bench::ray_kinds());
  check_names("--contenders", suite.contenders, bench::contender_kinds());
  suite.contenders = for_each_kernel(suite.contenders, options.kernels);
  suite.queries.clear();
  for (const bench::Query query : {bench::Query::Closest, bench::Query::Any}) {
    if (contains(options.queries, query)) suite.queries.push_back(query);
  }
  suite.rounds = options.rounds;
  suite.build_rounds = options.build_rounds != 0 ? options.build_rounds : options.suite ? 7 : 1;
  suite.threads = options.threads;
  suite.build_threads = options.build_threads;
  suite.side = options.side;
  suite.clock = options.cpu_clock ? bench::Clock::Cpu : bench::Clock::Wall;
  if ((suite.side & (suite.side - 1)) != 0) throw UsageError("--side must be a power of two");
  return suite;
}

template <class Kinds>
void list(const char* title, const Kinds& kinds) {
  print(fmt::format("{} (* unless told otherwise):\n", title));
  for (const auto& kind : kinds)
    print(
        fmt::format("  {} {:<20} {}\n", kind.by_default ? '*' : ' ', kind.name, kind.description));
}

int list_all() {
  list("meshes", bench::mesh_kinds());
  list("ray sets", bench::ray_kinds());
  list("contenders", bench::contender_kinds());
  print(bench::unkind_list());
  return 0;
}

// Prints what is told before the measuring starts; makes the file first: better to fail before an
// hour's work.
std::unique_ptr<io::OutputFile> open_reports(const BenchArguments& options,
                                             const bench::MachineLines& machine) {
  std::unique_ptr<io::OutputFile> json;
  if (!options.json.empty()) json = std::make_unique<io::OutputFile>(options.json);
  for (const auto& [name, value] : machine) print(fmt::format("{:<12} {}\n", name, value));
  return json;
}

int run_unkind(const BenchArguments& options) {
  if (options.suite || !options.files.empty() || !options.meshes.empty())
    throw UsageError("--unkind brings its own scenes: leave out --suite, --meshes and mesh files");
  bench::UnkindOptions unkind = options.unkind;
  unkind.rounds = options.rounds;
  check_names("--scenes", unkind.scenes, bench::unkind_scenes());
  const bench::MachineLines machine = bench::describe_machine();
  const interrupt::Graceful graceful;
  const auto json = open_reports(options, machine);
  print(bench::unkind_header());
  const auto rows = bench::run_unkind(
      unkind, [] { interrupt::check(); },
      [](const bench::UnkindRow& row) { print(bench::unkind_text(row)); });
  print(bench::unkind_summary(rows));
  if (json) {
    json->write(bench::unkind_json(rows, unkind, machine));
    json->commit();
  }
  return 0;
}

int run(const BenchArguments& options) {
  if (options.list) return list_all();
  if (options.failures) {
    print(bench::failures_text());
    return 0;
  }
  if (options.is_unkind) return run_unkind(options);
  if (!options.unkind.scenes.empty()) throw UsageError("--scenes goes with --unkind");
  refuse_to_replace(options.json, {options.files.begin(), options.files.end()}, "--json");
  const bench::SuiteOptions suite = suite_options(options);
  const bench::MachineLines machine = bench::describe_machine();
  const interrupt::Graceful graceful;
  const auto json = open_reports(options, machine);
  bench::SuiteListener listener;
  listener.step = [](const std::string&) { interrupt::check(); };
  listener.built = [&](const bench::MeshResult& mesh) { print(cells_header(mesh, suite)); };
  listener.measured = [](const bench::MeshResult&, const bench::Cell& cell) {
    print(cell_text(cell) + differences_text(cell));
  };
  const bench::SuiteResult result = run_suite(suite, listener);
  print(ratios_text(result) + ladder_text(result));
  if (json) {
    json->write(to_json(result, machine));
    json->commit();
  }
  return 0;
}

}  // namespace

Command add_bench(CLI::App& app) {
  CLI::App* bench = app.add_subcommand("bench", "Speeds beside those of others, answers compared");
  auto options = std::make_shared<BenchArguments>();
  bench->add_option("MESH", options->files, "Mesh files");
  bench->add_flag("--suite", options->suite, "The meshes of the project's own benchmark");
  bench->add_option("--meshes", options->meshes, "Only these of the suite")->delimiter(',');
  bench->add_option("--sets", options->sets, "Only these ray sets")->delimiter(',');
  add_choices<bench::Query>(*bench, "--queries", options->queries,
                            {{"closest", bench::Query::Closest}, {"any", bench::Query::Any}},
                            "Only these queries");
  bench->add_option("--contenders", options->contenders, "Only these contenders")->delimiter(',');
  bench
      ->add_option("--kernels", options->kernels,
                   "pierce's contenders with each of these kernels, avx512,avx2,..., side by side")
      ->delimiter(',');
  bench
      ->add_option("--against", options->against,
                   "embree, cgal, textbook: default all but the last")
      ->delimiter(',');
  bench->add_option("--json", options->json, "All figures, every round");
  bench->add_option("--rounds", options->rounds, "Timings of each cell [5]")
      ->check(CLI::Range(1U, 1000U));
  bench->add_option("--build-rounds", options->build_rounds, "Timings of builds [1; suite: 7]");
  bench->add_option("--threads", options->threads, "Threads of the queries [1]")
      ->check(CLI::Range(1U, 1024U));
  bench->add_option("--build-threads", options->build_threads, "Threads of builds [all]");
  bench->add_option("--side", options->side, "A set has side x side rays [1024]")
      ->check(CLI::Range(16U, 8192U));
  bench->add_flag("--cpu-clock", options->cpu_clock,
                  "Time of the thread instead of the clock on the wall: for a busy machine");
  bench->add_flag("--unkind", options->is_unkind,
                  "Scenes that engines dislike, each beside a kind twin, a minute or two");
  bench->add_option("--scenes", options->unkind.scenes, "Only these of --unkind")->delimiter(',');
  bench
      ->add_option("--detail", options->unkind.detail.percent,
                   "Size of the scenes of --unkind in percent [100]")
      ->check(CLI::Range(1U, 100U));
  bench->add_flag("--list", options->list, "Names of meshes, ray sets, contenders, unkind scenes");
  bench->add_flag("--failures", options->failures,
                  "What each contender misses from inside closed meshes");
  bench->footer(
      "Examples:\n"
      "  pierce bench --suite --json performance.json\n"
      "  pierce bench --meshes bunny --sets primary --queries closest --contenders pierce,embree\n"
      "  pierce bench model.ply --against embree\n"
      "  pierce bench --unkind --json unkind.json");
  return {bench, [options] { return run(*options); }};
}

}  // namespace pierce::tool
