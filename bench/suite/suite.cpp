// SPDX-License-Identifier: Apache-2.0
//
// How the experiment is run.
#include "suite/suite.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <thread>

#include "pierce/error.h"
#include "workloads/rays.h"

namespace pierce::bench {
namespace {

double now(Clock clock) {
  if (clock == Clock::Wall) {
    const auto time = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double>(time).count();
  }
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// One mesh: its engines, its judge, its cells.
class MeshRun {
 public:
  MeshRun(const Mesh& mesh, const SuiteOptions& options, const SuiteListener& listener)
      : mesh_(mesh), options_(options), listener_(listener) {
    result_.mesh = mesh.name;
    result_.triangles = mesh.triangles.size();
    result_.vertices = mesh.vertices.size();
    choose_contenders();
  }

  MeshResult run() {
    build();
    listener_.built(result_);
    RayMaker maker(
        mesh_,
        [this](std::span<const Ray<float>> rays, std::span<Hit<float>> hits) { cast(rays, hits); },
        options_.side);
    for (const std::string& name : options_.sets) {
      listener_.step("rays " + name);
      const RaySet set = maker.make(name);
      thinned_.clear();
      for (const Query query : options_.queries) {
        result_.cells.push_back(measure(set, query));
        listener_.measured(result_, result_.cells.back());
      }
    }
    return std::move(result_);
  }

 private:
  void choose_contenders() {
    std::vector<std::string> names = options_.contenders;
    field_ = make_field(names);
    const auto is_exact = [](const auto& c) { return c->kind() == Kind::Exact; };
    const auto place = std::find_if(field_.contenders.begin(), field_.contenders.end(), is_exact);
    if (place != field_.contenders.end()) {
      judge_ = place->get();
    } else {  // nobody here is exact: one who is not timed judges
      judge_field_ = make_field({"pierce-batch"});
      judge_ = judge_field_.contenders.front().get();
      judge_->engine().build(mesh_, options_.build_threads);
    }
    for (const auto& contender : field_.contenders)
      if (contender->engine().most_triangles() >= mesh_.triangles.size())
        runners_.push_back(contender.get());
  }

  void build() {
    for (unsigned round = 0; round < options_.build_rounds; ++round) {
      for (std::size_t turn = 0; turn < field_.engines.size(); ++turn) {
        // Another one begins each round: the first finds memory and threads cold.
        const auto& engine = field_.engines[(turn + round) % field_.engines.size()];
        if (engine->most_triangles() < mesh_.triangles.size()) continue;
        listener_.step("build " + engine->name());
        const BuildFigures figures = engine->build(mesh_, options_.build_threads);
        auto place = std::find_if(result_.builds.begin(), result_.builds.end(),
                                  [&](const BuildResult& b) { return b.engine == engine->name(); });
        if (place == result_.builds.end())
          place = result_.builds.insert(place, {engine->name(), {}, 0, 0});
        place->seconds.push_back(figures.seconds);
        place->bytes = figures.bytes;
        place->sah_cost = figures.sah_cost;
      }
    }
  }

  void cast(std::span<const Ray<float>> rays, std::span<Hit<float>> hits) {
    const RaySet set{"", {rays.begin(), rays.end()}, {}};
    Answers answers;
    ask(*judge_, set, Query::Closest, std::thread::hardware_concurrency(), answers);
    std::copy(answers.hits.begin(), answers.hits.end(), hits.begin());
  }

  static void ask(Contender& contender, const RaySet& set, Query query, unsigned threads,
                  Answers& answers) {
    contender.prepare(set, query, threads);
    contender.run();
    contender.collect(answers);
  }

  // The set itself, or as much of it as a slow contender takes; kept while the set is in use.
  const RaySet& smaller_set(const RaySet& set, std::size_t most) {
    if (set.rays.size() <= most) return set;
    for (const RaySet& few : thinned_)
      if (few.rays.size() == most) return few;
    thinned_.push_back(thinned(set, most));
    return thinned_.back();
  }

  // Everybody answers once, and is judged; that is the warm-up, too.
  Cell measure(const RaySet& set, Query query) {
    Cell cell{set.name, query, set.rays.size(), 0, {}, {}};
    Answers reference, answers;
    listener_.step("compare " + set.name + " " + name_of(query));
    ask(*judge_, set, query, options_.threads, reference);
    cell.hits =
        query == Query::Closest
            ? static_cast<std::uint64_t>(
                  std::count_if(reference.hits.begin(), reference.hits.end(),
                                [](const auto& hit) { return hit.triangle != kNone; }))
            : static_cast<std::uint64_t>(std::count(reference.any.begin(), reference.any.end(), 1));
    if (Statistics statistics; judge_->statistics(statistics)) cell.ladder = statistics;
    for (Contender* contender : runners_) {
      const RaySet& asked = smaller_set(set, contender->most_rays());
      ask(*contender, asked, query, options_.threads, answers);
      cell.timings.push_back({contender->name(),
                              contender->threads(),
                              asked.rays.size(),
                              {},
                              compare_answers(mesh_, set, query, reference, *contender, answers)});
    }
    for (unsigned round = 0; round < options_.rounds; ++round) {
      listener_.step("time " + set.name + " " + name_of(query));
      take_turns(cell, round);
    }
    return cell;
  }

  // Another one begins each round, so that nobody always follows the same neighbour. A few rays are
  // cast once before, not timed: to fetch the tree again from where the neighbours have driven it
  // takes as long as to cast some ten thousand rays, which wrongs whoever is fastest.
  void take_turns(Cell& cell, unsigned round) {
    constexpr std::size_t kFew = std::size_t{1} << 19;
    const std::size_t n = runners_.size();
    for (std::size_t turn = 0; turn < n; ++turn) {
      const std::size_t i = (turn + round) % n;
      if (cell.timings[i].rays < kFew) runners_[i]->run();
      const Clock clock = runners_[i]->threads() == 1 ? options_.clock : Clock::Wall;
      const double start = now(clock);
      runners_[i]->run();
      cell.timings[i].seconds.push_back(now(clock) - start);
    }
  }

  const Mesh& mesh_;
  const SuiteOptions& options_;
  const SuiteListener& listener_;
  Field field_, judge_field_;
  Contender* judge_ = nullptr;
  std::list<RaySet> thinned_;  // a list: references to its sets stay good
  std::vector<Contender*> runners_;
  MeshResult result_;
};

}  // namespace

std::vector<double> Timing::speeds() const {
  std::vector<double> all;
  for (std::size_t r = 0; r < seconds.size(); ++r) all.push_back(speed(r));
  return all;
}

const Timing* Cell::find(const std::string& contender) const {
  for (const Timing& timing : timings)
    if (timing.contender == contender) return &timing;
  return nullptr;
}

std::vector<double> paired_ratios(const Timing& one, const Timing& other) {
  std::vector<double> ratios;
  for (std::size_t r = 0; r < std::min(one.seconds.size(), other.seconds.size()); ++r)
    ratios.push_back(one.speed(r) / other.speed(r));
  return ratios;
}

SuiteResult run_suite(const SuiteOptions& options, const SuiteListener& listener) {
  SuiteResult result{options, {}};
  const auto add = [&](const Mesh& mesh) {
    result.meshes.push_back(MeshRun(mesh, options, listener).run());
  };
  for (const std::string& name : options.meshes) {
    listener.step("make " + name);
    add(make_mesh(name));
  }
  for (const std::filesystem::path& file : options.files) {
    listener.step("read " + file.string());
    add(load_mesh(file));
  }
  return result;
}

}  // namespace pierce::bench
