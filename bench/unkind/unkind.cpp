// SPDX-License-Identifier: Apache-2.0
#include "unkind/unkind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <stdexcept>

#include "pierce/error.h"
#include "suite/samples.h"
#include "unkind/ways.h"
#include "workloads/names.h"

namespace pierce::bench {
namespace {

constexpr double kSample = 4e6;  // ns: a sample repeats its questions for so long
constexpr double kEnough = 4e8;  // ns: a way that took so long is not sampled again

double processor_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

// One twin: its ways, and what they take.
class Twin {
 public:
  Twin(const UnkindScene& scene, const Subject& subject) : ask_(scene.ask) {
    add_pierce_ways(subject, ask_, ways_);
#ifdef PIERCE_BENCH_EMBREE
    add_embree_way(subject, ask_, ways_);
#endif
#ifdef PIERCE_BENCH_CGAL
    add_cgal_way(subject, ask_, ways_);
#endif
    result_.triangles = subject.shape.triangles.size();
    result_.questions = ways_.front().questions;
    spent_.assign(ways_.size(), 0);
    for (const Way& way : ways_) result_.ways.push_back({way.name, way.questions, 0, {}});
    compare(scene);
  }

  [[nodiscard]] std::size_t ways() const { return ways_.size(); }
  [[nodiscard]] const TwinResult& result() const { return result_; }

  void sample(std::size_t w) {
    if (spent_[w] > kEnough && !result_.ways[w].ns.empty()) return;
    answers_.resize(ways_[w].questions);
    const double start = processor_ns();
    double time = 0;
    int passes = 0;
    do {
      ways_[w].ask(answers_);
      ++passes;
      time = processor_ns() - start;
    } while (time < kSample);
    spent_[w] += time;
    result_.ways[w].ns.push_back(time / passes / units(answers_));
  }

 private:
  // What a time is divided by.
  [[nodiscard]] double units(const std::vector<double>& answers) const {
    if (ask_ != Ask::AllHits) return static_cast<double>(answers.size());
    return std::max(1.0, std::accumulate(answers.begin(), answers.end(), 0.0));
  }

  [[nodiscard]] bool alike(double ours, double theirs) const {
    if (ask_ == Ask::Closest) return std::isinf(ours) == std::isinf(theirs);
    if (ask_ == Ask::Nearest) return std::abs(ours - theirs) <= 1e-5 * std::abs(ours);
    return ours == theirs;
  }

  // The first way's answers are the reference. Is the warm-up, too.
  void compare(const UnkindScene& scene) {
    std::vector<double> reference(ways_.front().questions);
    ways_.front().ask(reference);
    for (std::size_t w = 1; w < ways_.size(); ++w) {
      answers_.assign(ways_[w].questions, 0);
      ways_[w].ask(answers_);
      if (ways_[w].name == "batch" && answers_ != reference) {
        throw std::runtime_error(
            fmt::format("{}: a batch answers otherwise than singles", scene.name));
      }
      for (std::size_t i = 0; i < answers_.size(); ++i)
        result_.ways[w].different += alike(reference[i], answers_[i]) ? 0 : 1;
    }
  }

  Ask ask_;
  std::vector<Way> ways_;
  std::vector<double> answers_, spent_;
  TwinResult result_;
};

UnkindRow measure(const UnkindScene& scene, const UnkindOptions& options,
                  const std::function<void()>& step) {
  step();
  Twin unkind(scene, scene.unkind(options.detail));
  step();
  Twin kind(scene, scene.kind(options.detail));
  for (unsigned round = 0; round < options.rounds; ++round) {
    for (std::size_t w = 0; w < std::max(unkind.ways(), kind.ways()); ++w) {
      step();
      if (w < unkind.ways()) unkind.sample(w);
      if (w < kind.ways()) kind.sample(w);
    }
  }
  return {&scene, unkind.result(), kind.result()};
}

// The time of the faster of the peers that answer alike, or nearly so; 0 if there is none.
double best_peer(const TwinResult& twin) {
  double best = 0;
  for (const WayTiming& way : twin.ways) {
    if (way.way == "one" || way.way == "batch" || 10 * way.different > way.questions) continue;
    const double ns = median(way.ns);
    if (best == 0 || ns < best) best = ns;
  }
  return best;
}

double over(double time, double other) { return other > 0 ? time / other : 0; }

}  // namespace

const char* name_of(Ask ask) {
  switch (ask) {
    case Ask::Closest:
      return "closest";
    case Ask::AllHits:
      return "all hits";
    case Ask::Count:
      return "count";
    case Ask::NextOrigin:
      return "origin";
    case Ask::Locate:
      return "locate";
    case Ask::SignedDistance:
      return "signed";
    case Ask::Nearest:
      return "nearest";
    case Ask::Voxelise:
      break;
  }
  return "voxelise";
}

const std::vector<UnkindScene>& unkind_scenes() {
  static const std::vector<UnkindScene> scenes = [] {
    std::vector<UnkindScene> all;
    add_outliers(all);
    add_dense(all);
    add_far_rays(all);
    add_numbers(all);
    add_points(all);
    add_seen(all);
    add_features(all);
    add_vertices(all);
    add_walls(all);
    return all;
  }();
  return scenes;
}

double TwinResult::ns(const std::string& way) const {
  for (const WayTiming& timing : ways)
    if (timing.way == way) return median(timing.ns);
  return 0;
}

bool UnkindRatios::worse_than_peer() const { return one_peer > 2 || batch_peer > 2; }
bool UnkindRatios::worse_than_kind() const { return one_kind > 3 || batch_kind > 3; }
bool UnkindRatios::worse_than_loop() const { return batch_one > 1.2; }

UnkindRatios ratios_of(const UnkindRow& row) {
  const double one = row.unkind.ns("one");
  const double batch = row.unkind.ns("batch");
  const double peer = best_peer(row.unkind);
  return {over(one, peer), over(batch, peer), over(one, row.kind.ns("one")),
          over(batch, row.kind.ns("batch")), over(batch, one)};
}

std::vector<UnkindRow> run_unkind(const UnkindOptions& options, const std::function<void()>& step,
                                  const std::function<void(const UnkindRow&)>& measured) {
  for (const std::string& name : options.scenes) {
    if (std::none_of(unkind_scenes().begin(), unkind_scenes().end(),
                     [&](const UnkindScene& scene) { return scene.name == name; })) {
      throw Error(ErrorCode::InvalidArgument, "there is no unkind scene '" + name +
                                                  "'; there are: " + names_of(unkind_scenes()));
    }
  }
  std::vector<UnkindRow> rows;
  for (const UnkindScene& scene : unkind_scenes()) {
    if (!options.scenes.empty() && std::find(options.scenes.begin(), options.scenes.end(),
                                             scene.name) == options.scenes.end()) {
      continue;
    }
    rows.push_back(measure(scene, options, step));
    measured(rows.back());
  }
  return rows;
}

}  // namespace pierce::bench
