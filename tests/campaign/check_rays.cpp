// SPDX-License-Identifier: Apache-2.0
//
// Every ray by every road: alone, in a batch on one thread and on two, on every quality of tree.
#include <memory>

#include "campaign/check.h"
#include "campaign/hit_oracle.h"
#include "pierce/intersect.h"

namespace pierce::campaign {
namespace {

template <class Real>
struct Expected {
  std::vector<Hit<Real>> all;
  Crossings crossings;
  [[nodiscard]] Hit<Real> closest() const { return all.empty() ? Hit<Real>{} : all[0]; }
  [[nodiscard]] bool any() const { return !all.empty(); }
};

/// What a ray should find alone, and what in the batch with its range and skip.
template <class Real>
struct BothExpected {
  Expected<Real> single, batch;
};

template <class Real>
Question question_of(const Ray<Real>& ray) {
  return {as_point(ray.origin), as_point(ray.direction), double{ray.t_min}, double{ray.t_max}};
}

template <class Real>
Expected<Real> expected_of(const World& world, const World& near, const std::vector<ExactHit>& line,
                           const Question& question) {
  Expected<Real> expected;
  for (const auto& hit : asked(line, question)) expected.all.push_back(rounded_hit<Real>(hit));
  expected.crossings = crossings_of(world, near, question);
  return expected;
}

template <class Real>
std::vector<BothExpected<Real>> expectations(const Case<Real>& made, const World& world) {
  std::vector<BothExpected<Real>> expected;
  for (std::size_t i = 0; i < made.rays.size(); ++i) {
    Question question = question_of(made.rays[i]);
    const World near = candidates(world, question.origin, question.direction);
    const auto line = line_hits(near, question.origin, question.direction);
    auto single = expected_of<Real>(world, near, line, question);
    question.range = made.range;
    if (!made.skip.empty()) question.skip = made.skip[i];
    expected.push_back({std::move(single), expected_of<Real>(world, near, line, question)});
  }
  return expected;
}

/// One scene, and what it should answer.
template <class Real>
struct Trial {
  const Case<Real>& made;
  const Built<Real>& built;
  const std::vector<BothExpected<Real>>& expected;
  Tally& tally;

  [[nodiscard]] auto where(const char* how, std::size_t i) const {
    return [this, how, i] {
      return std::string(how) + ", " + built.name + ", ray " + std::to_string(i);
    };
  }
  void single() const;
  void batch(unsigned threads) const;
};

template <class Real>
void Trial<Real>::single() const {
  std::vector<Hit<Real>> all;
  for (std::size_t i = 0; i < made.rays.size(); ++i) {
    const auto& ray = made.rays[i];
    const auto& wanted = expected[i].single;
    const auto at = where("single", i);
    const auto closest = built.scene.closest_hit(ray);
    tally.compare("closest_hit", wanted.closest(), closest.value_or(Hit<Real>{}), at);
    tally.compare("closest_hit found", wanted.any(), closest.has_value(), at);
    tally.compare("any_hit", wanted.any(), built.scene.any_hit(ray), at);
    built.scene.all_hits(ray, all);
    tally.compare("all_hits", wanted.all, all, at);
    tally.compare("crossings", wanted.crossings, built.scene.crossings(ray), at);
  }
}

template <class Real>
void Trial<Real>::batch(unsigned threads) const {
  const BatchOptions options{.threads = threads, .range = made.range, .skip = made.skip};
  const std::size_t count = made.rays.size();
  std::vector<Hit<Real>> closest(count);
  std::vector<std::uint8_t> any(count, 7);
  std::vector<Crossings> crossings(count);
  built.scene.closest_hits(made.rays, closest, options);
  built.scene.any_hits(made.rays, any, options);
  built.scene.crossings(made.rays, crossings, options);
  const auto lists = built.scene.all_hits(made.rays, options);
  const char* how = threads == 1 ? "1 thread" : "2 threads";
  for (std::size_t i = 0; i < count; ++i) {
    const auto& wanted = expected[i].batch;
    const auto at = where(how, i);
    tally.compare("closest_hits", wanted.closest(), closest[i], at);
    if (any[i] > 1) tally.fail("any_hits is neither 0 nor 1: " + at());
    tally.compare("any_hits", wanted.any(), any[i] != 0, at);
    tally.compare("crossings of a batch", wanted.crossings, crossings[i], at);
    const auto list = lists.of(i);
    tally.compare("all_hits of a batch", wanted.all,
                  std::vector<Hit<Real>>(list.begin(), list.end()), at);
  }
}

/// One ray, one triangle, no scene: those that are near, and a few that need not be.
template <class Real>
void check_intersect(const Case<Real>& made, const World& world, Tally& tally) {
  for (std::size_t i = 0; i < std::min<std::size_t>(made.rays.size(), 20); ++i) {
    Question question = question_of(made.rays[i]);
    question.range = made.range;
    World some = candidates(world, question.origin, question.direction);
    if (some.size() > 6) some.resize(6);
    for (std::size_t k = 0; k < 3 && !world.empty(); ++k) {
      some.push_back(world[(i * 3 + k) % world.size()]);
    }
    for (const Placed& placed : some) {
      const auto line = line_hits({placed}, question.origin, question.direction);
      const auto hits = asked(line, question);
      Hit<Real> wanted;
      if (!hits.empty()) wanted = rounded_hit<Real>(hits[0]);
      if (!hits.empty()) wanted.geometry = wanted.triangle = 0;
      const Triangle& t = made.meshes[placed.ref.geometry].triangles[placed.ref.triangle];
      const auto& v = made.meshes[placed.ref.geometry].vertices;
      const auto got = intersect(made.rays[i], v[t[0]], v[t[1]], v[t[2]], made.range);
      tally.compare("intersect", wanted, got.value_or(Hit<Real>{}), [&] {
        return "ray " + std::to_string(i) + ", triangle " + std::to_string(placed.ref.triangle);
      });
    }
  }
}

}  // namespace

template <class Real>
void check_rays(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                Tally& tally) {
  const auto expected = expectations(made, world);
  for (const auto& built : scenes) {
    const Trial<Real> trial{made, built, expected, tally};
    trial.single();
    trial.batch(1);
    trial.batch(2);
  }
  check_intersect(made, world, tally);
}

template void check_rays(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_rays(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
