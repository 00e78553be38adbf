// SPDX-License-Identifier: Apache-2.0
//
// The hits of a ray that count, one by one, where the caller's filter has a say in it or only one
// counts for each t; and what else is asked of one ray at a time: to go on after a hit.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/rays/hit_steps.h"

namespace pierce::scene {

inline Hit<double> in_double(const Hit<double>& hit) { return hit; }
inline Hit<double> in_double(const Hit<float>& hit) {
  const auto widened = [](float x) { return static_cast<double>(x); };
  Hit<double> wide{widened(hit.t), widened(hit.u), widened(hit.v), widened(hit.w)};
  wide.geometry = hit.geometry;
  wide.triangle = hit.triangle;
  wide.facing = hit.facing;
  return wide;
}

/// A ray and what it sees, `after` included. The line hits that triangle, or it is none.
template <class Real>
class Asked {
 public:
  Asked(const Geometries<Real>& geometries, const Ray<Real>& ray, const Sight& sight,
        const TriangleRef& after, bool distinct, predicate::LadderCounts& counts)
      : ray_(ray), sight_(sight) {
    if (after.triangle == kNone) return;
    find_hit(geometries, line_of(ray), after, after_, counts);
    sight_.after = &after_;
    sight_.past_its_t = distinct;
    ray_ = from_below(ray, after_, counts);
  }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  /// From no later than the first hit that is seen.
  [[nodiscard]] const Ray<Real>& ray() const { return ray_; }
  [[nodiscard]] const Sight& sight() const { return sight_; }

 private:
  Ray<Real> ray_;
  Sight sight_;
  After after_;
};

/// Of a ray of a batch that has been validated.
template <class Real>
Asked<Real> asked_of(const Geometries<Real>& geometries, const Ray<Real>& ray,
                     const BatchOptions& options, std::size_t number,
                     predicate::LadderCounts& counts) {
  return {geometries,
          ray,
          sight_of(geometries, options, number),
          options.after.empty() ? TriangleRef{} : options.after[number],
          options.distinct,
          counts};
}

/// Whether the hits of a list have to be looked at one by one.
template <class Options>
[[nodiscard]] bool counts_one_by_one(const Options& options) {
  return options.distinct || options.filter != nullptr;
}

template <class Real>
class CountedHits {
 public:
  template <class Impl, class Counts, class Options>
  CountedHits(const Impl& impl, const Options& options, StopPoll stop, Counts& counts)
      : steps_(impl, stop, counts.ladder, counts.kernel_counts()),
        filter_(options.filter),
        range_(options.range),
        distinct_(options.distinct) {}

  /// Starts on another ray, `number` in its batch. `all`: all of its hits will be asked for.
  void start(const Asked<Real>& asked, std::uint64_t number, bool all) {
    steps_.start(asked.ray(), range_, asked.sight(), all);
    number_ = number;
  }

  /// Goes to the next hit that counts; false if there is none.
  bool next() {
    while (steps_.next()) {
      if (filter_ != nullptr && !filter_(number_, in_double(steps_.hit()))) continue;
      if (distinct_) steps_.pass();
      return true;
    }
    return false;
  }
  Hit<Real> hit() { return steps_.hit(); }

  /// Appends what is left, `most` at most.
  void append(std::uint64_t most, std::vector<Hit<Real>>& out) {
    for (; most > 0 && next(); --most) out.push_back(hit());
  }
  std::uint32_t count() {
    std::uint32_t counted = 0;
    while (next()) ++counted;
    return counted;
  }

 private:
  HitSteps<Real> steps_;
  const HitFilter& filter_;
  Range range_;
  bool distinct_;
  std::uint64_t number_ = 0;
};

}  // namespace pierce::scene
