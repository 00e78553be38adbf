// SPDX-License-Identifier: Apache-2.0
//
// All hits of a ray, to be put in order and rounded; or only how many there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "predicate/decide.h"
#include "scene/rays/ladder_sink.h"

namespace pierce::scene {

struct FoundHit {
  predicate::DecidedHit hit;
  std::uint32_t primitive;
};

template <class Real>
class HitCollector final : public LadderSink<Real, FoundHit> {
 public:
  using LadderSink<Real, FoundHit>::LadderSink;

  void add(const kernels::Candidate& candidate) override {
    if (!this->sees(candidate)) return;
    FoundHit found;
    found.primitive = candidate.primitive;
    if (predicate::decide_hit(ray_, geometries_.triangle(candidate), found.hit, counts_) &&
        sight_.sees(ray_, found.hit, found.primitive, counts_)) {
      found_.push_back(found);
    }
  }

  /// Appends the hits of this ray to `out`, in order, each triangle once, and `most` at most.
  void append_ordered(std::uint64_t most, std::vector<Hit<Real>>& out) {
    // By number first; a stable order by t then leaves equal t in the order of the numbers.
    place_all();
    std::sort(places_.begin(), places_.end(), [this](std::uint32_t i, std::uint32_t j) {
      stop_.sometimes();
      return found_[i].primitive < found_[j].primitive;
    });
    const auto again = [this](std::uint32_t i, std::uint32_t j) {  // it stands in two leaves
      return found_[i].primitive == found_[j].primitive;
    };
    places_.erase(std::unique(places_.begin(), places_.end(), again), places_.end());
    const auto by_t = [this](std::uint32_t i, std::uint32_t j) {
      stop_.sometimes();
      return predicate::decide_order(ray_, found_[i].hit, found_[j].hit, counts_);
    };
    if (most < places_.size()) {
      const auto last = places_.begin() + static_cast<std::ptrdiff_t>(most);
      const auto before = [&](std::uint32_t i, std::uint32_t j) {
        const auto order = by_t(i, j);
        return order < 0 || (order == 0 && found_[i].primitive < found_[j].primitive);
      };
      std::partial_sort(places_.begin(), last, places_.end(), before);
      places_.erase(last, places_.end());
    } else if (places_.size() > 1) {  // a sort of one would still ask for memory
      const auto before = [&](std::uint32_t i, std::uint32_t j) { return by_t(i, j) < 0; };
      std::stable_sort(places_.begin(), places_.end(), before);
    }
    for (const std::uint32_t place : places_) out.push_back(rounded(found_[place]));
  }

  /// In place of append_ordered: makes ready for next().
  void arrange() {
    place_all();
    std::make_heap(places_.begin(), places_.end(), later());
    last_ = kNone;
  }
  /// The hits of this ray one by one, in order, each triangle once; nullptr when there are no more.
  const FoundHit* next() {
    while (!places_.empty()) {
      std::pop_heap(places_.begin(), places_.end(), later());
      const FoundHit& found = found_[places_.back()];
      places_.pop_back();
      if (found.primitive == last_) continue;  // it stands in two leaves
      last_ = found.primitive;
      return &found;
    }
    return nullptr;
  }

  /// The numbers and names of a hit of this ray.
  Hit<Real> rounded(const FoundHit& found) {
    stop_.sometimes();
    Hit<Real> hit = predicate::round_hit<Real>(ray_, found.hit.triangle, found.hit.zeros, counts_);
    const TriangleRef ref = geometries_.ref(found.primitive);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
    return hit;
  }

 private:
  // Hits are large: what is put in order are their places in found_.
  void place_all() {
    places_.resize(found_.size());
    std::iota(places_.begin(), places_.end(), 0U);
  }

  // A heap has the last of its order on top.
  auto later() {
    return [this](std::uint32_t i, std::uint32_t j) {
      stop_.sometimes();
      const FoundHit& a = found_[i];
      const FoundHit& b = found_[j];
      if (a.primitive == b.primitive) return false;
      const auto order = predicate::decide_order(ray_, a.hit, b.hit, counts_);
      return order > 0 || (order == 0 && a.primitive > b.primitive);
    };
  }

  std::vector<std::uint32_t> places_;
  std::uint32_t last_ = kNone;  // what next() has given out
  using LadderSink<Real, FoundHit>::geometries_;
  using LadderSink<Real, FoundHit>::stop_;
  using LadderSink<Real, FoundHit>::counts_;
  using LadderSink<Real, FoundHit>::ray_;
  using LadderSink<Real, FoundHit>::sight_;
  using LadderSink<Real, FoundHit>::found_;
};

struct FoundTriangle {
  std::uint32_t primitive;
};

template <class Real>
class HitCounter final : public LadderSink<Real, FoundTriangle> {
 public:
  using LadderSink<Real, FoundTriangle>::LadderSink;

  void add(const kernels::Candidate& candidate) override {
    if (!this->sees(candidate)) return;
    predicate::DecidedHit hit;
    if (predicate::decide_hit(this->ray_, this->geometries_.triangle(candidate), hit,
                              this->counts_) &&
        this->sight_.sees(this->ray_, hit, candidate.primitive, this->counts_)) {
      this->found_.push_back({candidate.primitive});
    }
  }

  /// How many triangles this ray hits.
  [[nodiscard]] std::uint32_t count() {
    return static_cast<std::uint32_t>(this->found_once().size());
  }
};

}  // namespace pierce::scene
