// SPDX-License-Identifier: Apache-2.0
//
// Every ray in every way: alone, in a batch on one thread and on two, on every quality of tree.
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
  [[nodiscard]] std::uint64_t count() const { return all.size(); }
  [[nodiscard]] std::vector<Hit<Real>> first(std::uint64_t most) const {
    const auto count = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(most, all.size()));
    return {all.begin(), all.begin() + count};
  }
};

/// What a ray should find by itself, and what with all the options of the case.
template <class Real>
struct BothExpected {
  Expected<Real> plain, limited;
};

template <class Real>
Question question_of(const Ray<Real>& ray) {
  return {as_point(ray.origin), as_point(ray.direction), double{ray.t_min}, double{ray.t_max}};
}

template <class Real>
QueryOptions options_of(const Case<Real>& made, std::size_t i) {
  return {.range = made.range,
          .skip = made.skip.empty() ? TriangleRef{} : made.skip[i],
          .sides = made.sides,
          .mask = made.ray_masks.empty() ? made.mask : made.ray_masks[i],
          .max_hits = made.max_hits};
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
    auto plain_question = question;
    plain_question.masks = made.geometry_masks;
    auto plain = expected_of<Real>(world, near, line, plain_question);
    const QueryOptions options = options_of(made, i);
    question.range = options.range;
    question.skip = options.skip;
    question.sides = options.sides;
    question.mask = options.mask;
    question.masks = made.geometry_masks;
    expected.push_back({std::move(plain), expected_of<Real>(world, near, line, question)});
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
  void single(std::size_t i, const QueryOptions& options, const Expected<Real>& wanted) const;
  void singles() const;
  void batch(unsigned threads) const;
  void streamed(const BatchOptions& options) const;
};

template <class Real>
void Trial<Real>::single(std::size_t i, const QueryOptions& options,
                         const Expected<Real>& wanted) const {
  const auto& ray = made.rays[i];
  const auto& scene = built.scene;
  const auto at = where("single", i);
  const auto closest = scene.closest_hit(ray, options);
  tally.compare("closest_hit", wanted.closest(), closest.value_or(Hit<Real>{}), at);
  tally.compare("closest_hit found", wanted.any(), closest.has_value(), at);
  tally.compare("any_hit", wanted.any(), scene.any_hit(ray, options), at);
  std::vector<Hit<Real>> all(3);
  scene.all_hits(ray, all, options);
  tally.compare("all_hits", wanted.first(options.max_hits), all, at);
  tally.compare("count_hits", wanted.count(), std::uint64_t{scene.count_hits(ray, options)}, at);
  tally.compare("crossings", wanted.crossings, scene.crossings(ray, options), at);
}

template <class Real>
void Trial<Real>::singles() const {
  for (std::size_t i = 0; i < made.rays.size(); ++i) {
    single(i, {}, expected[i].plain);
    single(i, options_of(made, i), expected[i].limited);
  }
}

template <class Real>
void Trial<Real>::batch(unsigned threads) const {
  const BatchOptions options{.range = made.range,
                             .skip = made.skip,
                             .sides = made.sides,
                             .mask = made.mask,
                             .masks = made.ray_masks,
                             .max_hits = made.max_hits,
                             .work = {.threads = threads}};
  const std::size_t count = made.rays.size();
  std::vector<Hit<Real>> closest(count);
  std::vector<std::uint8_t> any(count, 7);
  std::vector<std::uint32_t> counts(count);
  std::vector<Crossings> crossings(count);
  built.scene.closest_hits(made.rays, closest, options);
  built.scene.any_hits(made.rays, any, options);
  built.scene.count_hits(made.rays, counts, options);
  built.scene.crossings(made.rays, crossings, options);
  const auto lists = built.scene.all_hits(made.rays, options);
  const char* how = threads == 1 ? "1 thread" : "2 threads";
  for (std::size_t i = 0; i < count; ++i) {
    const auto& wanted = expected[i].limited;
    const auto at = where(how, i);
    tally.compare("closest_hits", wanted.closest(), closest[i], at);
    if (any[i] > 1) tally.fail("any_hits is neither 0 nor 1: " + at());
    tally.compare("any_hits", wanted.any(), any[i] != 0, at);
    tally.compare("count_hits of a batch", wanted.count(), std::uint64_t{counts[i]}, at);
    tally.compare("crossings of a batch", wanted.crossings, crossings[i], at);
    const auto list = lists.of(i);
    tally.compare("all_hits of a batch", wanted.first(made.max_hits),
                  std::vector<Hit<Real>>(list.begin(), list.end()), at);
  }
  streamed(options);
}

template <class Real>
void Trial<Real>::streamed(const BatchOptions& options) const {
  std::uint64_t next = 0;
  const auto consume = [&](std::uint64_t first, const HitLists<Real>& lists) {
    if (first != next)
      tally.fail("all_hits in pieces: ray " + std::to_string(next) + " is left out");
    for (std::size_t i = 0; i + 1 < lists.offsets.size(); ++i, ++next) {
      const auto list = lists.of(i);
      tally.compare("all_hits in pieces", expected[next].limited.first(made.max_hits),
                    std::vector<Hit<Real>>(list.begin(), list.end()), where("pieces", next));
    }
  };
  built.scene.all_hits(made.rays, options, consume);
  if (next != made.rays.size()) tally.fail("all_hits in pieces ends too early");
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
    trial.singles();
    trial.batch(1);
    trial.batch(2);
  }
  check_intersect(made, world, tally);
}

template void check_rays(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_rays(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
