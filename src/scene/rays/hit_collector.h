// SPDX-License-Identifier: Apache-2.0
//
// All hits of a ray, to be put in order and rounded; or only how many there are.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "predicate/decide.h"
#include "scene/rays/hit_rounding.h"
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
  void append_ordered(std::uint64_t most, const kernels::Kernel& kernel,
                      std::vector<Hit<Real>>& out) {
    order(most);
    const std::size_t before = out.size();
    out.resize(before + places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      stop_.sometimes();
      const FoundHit& found = found_[places_[i]];
      Hit<Real>& hit = out[before + i];
      name(found, hit);
      if (found.hit.zeros != 0) {  // a weight is known, which in lanes it is not
        set_numbers(numbers(found), hit);
        continue;
      }
      if (!rounding_) rounding_.emplace();
      rounding_->add(ray_, found.hit.triangle, hit);
      if (rounding_->full()) rounding_->round(kernel, counts_);
    }
    if (rounding_) rounding_->round(kernel, counts_);
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

  // Puts the first `most` places in order of t, then of the triangles' numbers; each triangle once.
  // By the lower ends of their t first, in double: what has to be told apart exactly are then
  // neighbours whose intervals overlap.
  void order(std::uint64_t most) {
    keys_.resize(found_.size());
    for (std::uint32_t i = 0; i < keys_.size(); ++i) {
      keys_[i] = {found_[i].hit.t.low, found_[i].hit.t.high, i};
    }
    std::sort(keys_.begin(), keys_.end(), [this](const Key& a, const Key& b) {
      stop_.sometimes();
      return a.low < b.low;
    });
    places_.clear();
    for (auto first = keys_.begin(); first != keys_.end() && places_.size() < most;) {
      double high = first->high;
      auto last = first + 1;
      for (; last != keys_.end() && last->low <= high; ++last) high = std::max(high, last->high);
      const auto end = last - first > 1 ? order_run(first, last, most - places_.size()) : last;
      for (; first != end; ++first) places_.push_back(first->place);
      first = last;
    }
  }

  struct Key {
    double low, high;  // of t
    std::uint32_t place;
  };
  using Keys = std::vector<Key>;

  // By t, exactly, then by number; each triangle once, which may stand in two leaves. Returns the
  // end of those that are kept, `most` at most.
  typename Keys::iterator order_run(typename Keys::iterator first, typename Keys::iterator last,
                                    std::uint64_t most) {
    const auto by_number = [this](const Key& a, const Key& b) {
      return primitive(a.place) < primitive(b.place);
    };
    const auto order = [this](const Key& a, const Key& b) {
      stop_.sometimes();
      return predicate::decide_order(ray_, found_[a.place].hit, found_[b.place].hit, counts_);
    };
    std::sort(first, last, by_number);
    last = std::unique(first, last, [this](const Key& a, const Key& b) {
      return primitive(a.place) == primitive(b.place);
    });
    if (most < static_cast<std::uint64_t>(last - first)) {
      const auto end = first + static_cast<std::ptrdiff_t>(most);
      std::partial_sort(first, end, last, [&](const Key& a, const Key& b) {
        const auto before = order(a, b);
        return before < 0 || (before == 0 && by_number(a, b));
      });
      return end;
    }
    if (last - first > 1)  // a sort of one would still ask for memory
      std::stable_sort(first, last, [&](const Key& a, const Key& b) { return order(a, b) < 0; });
    return last;
  }

  [[nodiscard]] std::uint32_t primitive(std::uint32_t place) const {
    return found_[place].primitive;
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
  Keys keys_;
  std::optional<HitRounding<Real>> rounding_;  // once a list is asked for: it is large
  std::uint32_t last_ = kNone;                 // what next() has given out
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
