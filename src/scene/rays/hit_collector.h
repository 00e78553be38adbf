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
    this->found_once();
    const auto by_t = [this](const FoundHit& a, const FoundHit& b) {
      stop_.sometimes();
      return predicate::decide_order(ray_, a.hit, b.hit, counts_);
    };
    if (most < found_.size()) {
      const auto last = found_.begin() + static_cast<std::ptrdiff_t>(most);
      const auto before = [&](const FoundHit& a, const FoundHit& b) {
        const auto order = by_t(a, b);
        return order < 0 || (order == 0 && a.primitive < b.primitive);
      };
      std::partial_sort(found_.begin(), last, found_.end(), before);
      found_.erase(last, found_.end());
    } else if (found_.size() > 1) {  // a sort of one would still ask for memory
      const auto before = [&](const FoundHit& a, const FoundHit& b) { return by_t(a, b) < 0; };
      std::stable_sort(found_.begin(), found_.end(), before);
    }
    for (const FoundHit& found : found_) out.push_back(rounded(found));
  }

  /// In place of append_ordered: makes ready for next().
  void arrange() {
    heap_.resize(found_.size());
    std::iota(heap_.begin(), heap_.end(), 0U);
    std::make_heap(heap_.begin(), heap_.end(), later());
    last_ = kNone;
  }
  /// The hits of this ray one by one, in order, each triangle once; nullptr when there are no more.
  const FoundHit* next() {
    while (!heap_.empty()) {
      std::pop_heap(heap_.begin(), heap_.end(), later());
      const FoundHit& found = found_[heap_.back()];
      heap_.pop_back();
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

  std::vector<std::uint32_t> heap_;  // places in found_
  std::uint32_t last_ = kNone;       // what next() has given out
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
