// SPDX-License-Identifier: Apache-2.0
//
// All hits of a ray, to be asked for one by one, in order; or only how many there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "predicate/decide.h"
#include "predicate/round.h"
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

  void add(const kernels::Candidate& candidate, bool /*certain*/) override {
    if (!this->sees(candidate)) return;
    FoundHit found;
    found.primitive = candidate.primitive;
    if (predicate::decide_hit(ray_, geometries_.triangle(candidate), found.hit, counts_) &&
        sight_.sees(ray_, found.hit, found.primitive, counts_)) {
      found_.push_back(found);
    }
  }

  /// Makes ready for next().
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
    Hit<Real> hit = numbers(found);
    name(found, hit);
    return hit;
  }

 private:
  Hit<Real> numbers(const FoundHit& found) {
    return predicate::round_hit<Real>(ray_, found.hit.triangle, found.hit.zeros, counts_);
  }
  void name(const FoundHit& found, Hit<Real>& hit) {
    const TriangleRef ref = geometries_.ref(found.primitive);
    hit.geometry = ref.geometry;
    hit.triangle = ref.triangle;
  }

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

  void add(const kernels::Candidate& candidate, bool certain) override {
    if (!this->sees(candidate)) return;
    if (certain && this->sight_.unlimited()) {
      this->found_.push_back({candidate.primitive});
      return;
    }
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
