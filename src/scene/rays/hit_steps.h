// SPDX-License-Identifier: Apache-2.0
//
// The hits of a ray one by one, in order, no more of them found than are asked for: for who wants
// to look at each (HitFilter), or at one for each t (distinct).
//
// The first few are found as closest hits, each after the one before. Whoever refuses these may
// refuse ten thousand, so what comes then is found a portion at a time: all hits up to some t, put
// in order as they are asked for. Portions grow fourfold; so a ray takes a
// traversal for each of the first few hits, then at most as many as the type has exponents, and
// each hit is decided once.
#pragma once

#include <cstdint>
#include <limits>

#include "scene/rays/after.h"
#include "scene/rays/hit_collector.h"
#include "scene/rays/ray_query.h"

namespace pierce::scene {

/// One object can serve many rays, one after the other.
template <class Real>
class HitSteps {
 public:
  template <class Impl>
  HitSteps(const Impl& impl, StopPoll stop, predicate::LadderCounts& counts,
           kernels::KernelCounts* kernel_counts)
      : kernel_(*impl.kernel),
        tree_(impl.tree),
        two_level_(impl.two_level.get()),
        geometries_(impl.geometries),
        stop_(stop),
        counts_(counts),
        kernel_counts_(kernel_counts),
        collector_(impl.geometries, stop, counts) {}

  /// Starts on another ray. `all`: all hits will be asked for. What `sight` points to is kept by
  /// the caller.
  void start(const Ray<Real>& ray, Range range, const Sight& sight, bool all) {
    rest_ = sight.after == nullptr ? ray : from_below(ray, *sight.after, counts_);
    end_ = ray.t_max;
    range_ = range;
    sight_ = sight;
    steps_left_ = all ? 0 : kSteps;
    width_ = std::numeric_limits<double>::infinity();
    in_portion_ = false;
    passing_ = false;
    found_ = nullptr;
    start_ = ray.t_min;
  }

  /// Goes to the next hit; false if there is none.
  bool next() {
    if (steps_left_ > 0) return step();
    for (;;) {
      if (!in_portion_) collect();
      while (const FoundHit* found = collector_.next()) {
        const bool passed = passing_ && found_ != nullptr &&
                            predicate::decide_order(line_, found_->hit, found->hit, counts_) == 0;
        if (passed) continue;
        passing_ = false;
        found_ = found;
        return true;
      }
      if (!(rest_.t_max < end_)) return false;
      rest_.t_min = rest_.t_max;
      range_ = Range::OpenStart;
      sight_.after = nullptr;
      in_portion_ = false;
    }
  }

  /// The numbers of the hit that next() has come to.
  Hit<Real> hit() { return found_ == nullptr ? hit_ : collector_.rounded(*found_); }

  /// Of the hits at the t of that one, next() comes to no other.
  void pass() {
    passing_ = true;
    sight_.past_its_t = true;
  }

 private:
  static constexpr int kSteps = 4;
  static constexpr double kGrowth = 4;

  bool step() {
    RayQuery<Real> query(kernel_, geometries_, rest_, range_, sight_, &counts_, stop_);
    if (!query.closest(tree_, two_level_, kernel_counts_, hit_)) return false;
    // The next one comes after it.
    find_hit(geometries_, line_of(rest_), hit_, last_, counts_);
    sight_.after = &last_;
    sight_.past_its_t = false;
    passing_ = false;
    rest_ = from_below(rest_, hit_.t);
    if (steps_left_ == kSteps) first_t_ = hit_.t;
    if (--steps_left_ == 0) width_ = first_width();
    return true;
  }

  // As far as from the first to the last of the steps; where these coincide, as far as from the
  // start of the ray. (No number, or infinite, if that does not say either.)
  [[nodiscard]] double first_width() const {
    const auto t = static_cast<double>(hit_.t);
    const double steps = t - static_cast<double>(first_t_);
    return steps > 0 ? steps : t - static_cast<double>(start_);
  }

  // The hits of the next portion. Its end is a number of the type, beyond which the next begins:
  // none is lost and none comes twice, and hits at one t are all in one portion.
  void collect() {
    const auto end = static_cast<Real>(static_cast<double>(rest_.t_min) + width_);
    const bool portion = end > std::nextafter(rest_.t_min, kInfinity<Real>) && end < end_;
    rest_.t_max = portion ? end : end_;
    width_ *= kGrowth;
    in_portion_ = true;
    found_ = nullptr;
    line_ = predicate::to_double(rest_, range_);
    collector_.start(line_, sight_);
    space::FilterRay filter_ray;
    if (!transform(kernel_, geometries_, rest_, range_, filter_ray).misses) {
      tell_all(kernel_, tree_, two_level_, geometries_, line_, sight_, filter_ray, collector_,
               kernel_counts_);
    }
    collector_.arrange();
  }

  const kernels::Kernel& kernel_;
  const bvh::Tree& tree_;
  const TwoLevel<Real>* two_level_;
  const Geometries<Real>& geometries_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  kernels::KernelCounts* kernel_counts_;
  HitCollector<Real> collector_;

  Ray<Real> rest_;  // its range: of the next step, or of this portion
  Real end_;        // of the ray
  Range range_;
  Sight sight_;
  After last_;
  Hit<Real> hit_;
  Real start_, first_t_;
  int steps_left_ = 0;
  double width_;
  bool in_portion_ = false;
  bool passing_ = false;
  predicate::RayD line_;
  const FoundHit* found_ = nullptr;  // the hit, if it was found in a portion
};

}  // namespace pierce::scene
