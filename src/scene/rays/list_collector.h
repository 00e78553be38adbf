// SPDX-License-Identifier: Apache-2.0
//
// The list of a ray's hits: rounded as they are found, many at a time, then put in order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "predicate/decide.h"
#include "scene/rays/hit_order.h"
#include "scene/rays/hit_rounding.h"
#include "scene/rays/ladder_sink.h"

namespace pierce::scene {

/// What is kept of a hit while the list grows. Most are never decided but by the kernel.
struct ListedHit {
  kernels::Candidate candidate;
  std::uint32_t primitive;
  std::uint32_t decided = kNone;  // where in ListCollector::decided_
  std::uint32_t doubt = kNone;    // where in ListCollector::doubts_
};

template <class Real>
class ListCollector final : public LadderSink<Real, ListedHit> {
  using Base = LadderSink<Real, ListedHit>;

 public:
  ListCollector(const kernels::Kernel& kernel, const Geometries<Real>& geometries, StopPoll stop,
                predicate::LadderCounts& counts)
      : Base(geometries, stop, counts), kernel_(kernel) {}

  void start(const predicate::RayD& ray, const Sight& sight) {
    Base::start(ray, sight);
    hits_.clear();
    keys_.clear();
    decided_.clear();
    doubts_.clear();
    rounding_.clear();
  }

  void add(const kernels::Candidate& candidate, bool certain) override {
    if (!this->sees(candidate)) return;
    const predicate::TriangleD triangle = geometries_.triangle(candidate);
    if (certain && sight_.unlimited()) {
      note(candidate);
    } else {
      predicate::DecidedHit& hit = decided_.emplace_back();
      if (!predicate::decide_hit(ray_, triangle, hit, counts_) ||
          !sight_.sees(ray_, hit, candidate.primitive, counts_)) {
        decided_.pop_back();
        return;
      }
      note(candidate);
      found_.back().decided = static_cast<std::uint32_t>(decided_.size() - 1);
      if (hit.zeros != 0) {  // a weight is known, which in lanes it is not
        keys_.push_back({hit.t.low, hit.t.high, last()});
        found_.back().doubt = static_cast<std::uint32_t>(doubts_.size());
        doubts_.push_back({triangle, {}, false, false, hit.zeros});
        return;
      }
    }
    rounding_.add(ray_, triangle, last());
    if (rounding_.full()) round();
  }

  /// Appends the hits of this ray to `out`, in order, each triangle once, and `most` at most.
  void append_ordered(std::uint64_t most, std::vector<Hit<Real>>& out) {
    round();
    order(most);
    for (const std::uint32_t place : places_) {
      stop_.sometimes();
      const ListedHit& found = found_[place];
      Hit<Real>& hit = out.emplace_back(hits_[place]);
      if (found.doubt != kNone) dispel(doubts_[found.doubt], hit);
      const TriangleRef ref = geometries_.ref(found.primitive);
      hit.geometry = ref.geometry;
      hit.triangle = ref.triangle;
    }
  }

 private:
  // What is left to do of a hit's numbers once it is sure to be in the list.
  struct Doubt {
    predicate::TriangleD triangle;
    Hit<Real> high;  // of what hits_ has: the upper ends
    bool bounded;    // if there are ends
    bool wide;       // double has few bits to spare
    std::uint8_t zeros;
  };

  void note(const kernels::Candidate& candidate) {
    found_.push_back({candidate, candidate.primitive});
    hits_.emplace_back();
  }
  [[nodiscard]] std::uint32_t last() const { return static_cast<std::uint32_t>(found_.size() - 1); }

  // Of a hit whose numbers are not all certain.
  void dispel(const Doubt& doubt, Hit<Real>& hit) {
    if constexpr (std::is_same_v<Real, float>) {
      if (Hit<float> finer; doubt.wide && kernel_.round_finely(ray_, doubt.triangle, 0, finer)) {
        hit = finer;
        return;
      }
    }
    if (doubt.bounded) {
      predicate::round_bounded_hit(ray_, doubt.triangle, 0, doubt.high, hit, counts_);
    } else {
      hit = round_one<Real>(kernel_, ray_, doubt.triangle, doubt.zeros, counts_);
    }
  }

  // All that wait for it.
  void round() {
    rounding_.round(kernel_, [this](std::uint32_t place, const RoundedHit<Real>& rounded) {
      rounded.set_low(hits_[place]);
      const predicate::Interval t = rounded.bounded ? rounded.t() : decided(place).t;
      keys_.push_back({t.low, t.high, place});
      if (rounded.sure) return;
      doubts_.push_back(
          {rounded.triangle(), rounded.high(), rounded.bounded, rounded.is_wide(), 0});
      found_[place].doubt = static_cast<std::uint32_t>(doubts_.size() - 1);
    });
  }

  const predicate::DecidedHit& decided(std::uint32_t place) {
    ListedHit& found = found_[place];
    if (found.decided == kNone) {
      found.decided = static_cast<std::uint32_t>(decided_.size());
      predicate::LadderCounts uncounted;  // whether it is a hit is known
      predicate::decide_hit(ray_, geometries_.triangle(found.candidate), decided_.emplace_back(),
                            uncounted);
    }
    return decided_[found.decided];
  }

  // Puts the first `most` places in order of t, then of the triangles' numbers; each triangle once.
  // By the lower ends of their t first: what has to be told apart exactly are then neighbours whose
  // intervals overlap.
  void order(std::uint64_t most) {
    sorter_.sort(keys_, stop_);
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

  // By t, exactly, then by number; each triangle once, which may stand in two leaves. Returns the
  // end of those that are kept, `most` at most.
  OrderKeys::iterator order_run(OrderKeys::iterator first, OrderKeys::iterator last,
                                std::uint64_t most) {
    const auto by_number = [this](const OrderKey& a, const OrderKey& b) {
      stop_.sometimes();
      return primitive(a.place) < primitive(b.place);
    };
    const auto order = [this](const OrderKey& a, const OrderKey& b) {
      stop_.sometimes();
      return predicate::decide_order(ray_, decided_[found_[a.place].decided],
                                     decided_[found_[b.place].decided], counts_);
    };
    std::sort(first, last, by_number);
    last = std::unique(first, last, [this](const OrderKey& a, const OrderKey& b) {
      return primitive(a.place) == primitive(b.place);
    });
    if (last - first == 1) return last;
    for (auto key = first; key != last; ++key) {
      stop_.sometimes();
      decided(key->place);
    }
    if (most < static_cast<std::uint64_t>(last - first)) {
      const auto end = first + static_cast<std::ptrdiff_t>(most);
      std::partial_sort(first, end, last, [&](const OrderKey& a, const OrderKey& b) {
        const auto before = order(a, b);
        return before < 0 || (before == 0 && by_number(a, b));
      });
      return end;
    }
    std::stable_sort(first, last,
                     [&](const OrderKey& a, const OrderKey& b) { return order(a, b) < 0; });
    return last;
  }

  [[nodiscard]] std::uint32_t primitive(std::uint32_t place) const {
    return found_[place].primitive;
  }

  using Base::counts_;
  using Base::found_;
  using Base::geometries_;
  using Base::ray_;
  using Base::sight_;
  using Base::stop_;
  const kernels::Kernel& kernel_;
  HitRounding<Real, std::uint32_t> rounding_;
  std::vector<Hit<Real>> hits_;  // one for each of found_, without names
  OrderKeys keys_;               // likewise, in no order
  std::vector<predicate::DecidedHit> decided_;
  std::vector<Doubt> doubts_;
  HitSorter sorter_;
  std::vector<std::uint32_t> places_;
};

}  // namespace pierce::scene
