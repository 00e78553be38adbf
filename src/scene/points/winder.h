// SPDX-License-Identifier: Apache-2.0
//
// Winding numbers of points. Of the surface less its fill, which is closed, the passages of a ray
// along an axis are counted; what the fill winds is summed by its tree. Triangles that hold the
// point, of the surface or of the fill, count 0: they are left out of both, and strips from their
// edges on, against the ray, stand in for them (docs/algorithm.md, "Winding numbers").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "kernels/kernel.h"
#include "pierce/winding.h"
#include "predicate/passage.h"
#include "predicate/solid_angle.h"
#include "scene/points/fill.h"
#include "scene/points/sorted_points.h"

namespace pierce::scene {

/// A triangle that holds a point.
struct HeldBy {
  std::uint32_t point;      ///< of the packet
  std::uint32_t primitive;  ///< of the surface, or of the fill
  bool of_fill;
};

/// A point and what its ray has told.
struct WindingAsked {
  Vec3<double> point;
  AxisDirection along;
  std::int32_t whole = 0;  ///< what the surface less its fill winds, without what holds the point
  bool on_surface = false;
  std::span<const HeldBy> held = {};
};

/// Passages of a packet of points through the surface or the fill.
template <class Real>
class WindingPassages final : public kernels::AxisResolver {
 public:
  WindingPassages(const Geometries<Real>& geometries, bool of_fill, StopPoll stop,
                  predicate::LadderCounts& counts)
      : geometries_(geometries), of_fill_(of_fill), stop_(stop), counts_(counts) {}

  int passage(std::uint32_t point, const kernels::Candidate& candidate) override {
    stop_.sometimes();
    const predicate::AxisPassage passage = predicate::decide_axis_passage(
        points[point], along, geometries_.triangle(candidate), counts_);
    if (passage != predicate::AxisPassage::OnTriangle) return static_cast<int>(passage);
    held.push_back({number[point], candidate.primitive, of_fill_});
    return 0;
  }

  AxisDirection along;
  std::uint32_t count = 0;
  std::array<Vec3<double>, kernels::kAxisPoints> points;
  std::array<std::uint32_t, kernels::kAxisPoints> number{};  ///< in the whole packet
  std::vector<HeldBy> held;

 private:
  const Geometries<Real>& geometries_;
  bool of_fill_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
};

/// A thread's way through points. `answer(number, winder, asked)` is called for each.
template <class Real, class Counts, class Answer>
class Winder {
 public:
  template <class Impl>
  Winder(const Impl& impl, const Fill<Real>& fill, const AxisSpace& space, const WorkOptions& work,
         Counts& counts, const Answer& answer)
      : kernel_(*impl.kernel),
        tree_(impl.tree),
        geometries_(impl.geometries),
        fill_(fill),
        space_(space),
        fill_space_(fill.geometries.space(), fill.tree, fill.geometries.copies_exact(), false),
        stop_(work.stop),
        counts_(counts),
        answer_(answer),
        surface_passages_(impl.geometries, false, stop_, counts.ladder),
        fill_passages_(fill.geometries, true, stop_, counts.ladder) {}

  /// Points one by one; all of a packet look the same way.
  void add(const Vec3<double>& point, bool looks, AxisDirection along, std::size_t number) {
    if (!looks) {
      answer_(number, *this, WindingAsked{point, along});
      return;
    }
    if (size_ == kernels::kAxisPoints ||
        (size_ != 0 && (along.axis != along_.axis || along.forward != along_.forward))) {
      flush();
    }
    along_ = along;
    points_[size_] = point;
    numbers_[size_++] = number;
  }

  void flush() {
    if (size_ == 0) return;
    std::array<std::int32_t, kernels::kAxisPoints> whole{};
    const auto all = [](std::uint32_t) { return true; };
    const auto met = [this](std::uint32_t i) { return fill_space_.meets(points_[i], along_); };
    traverse(tree_, space_, surface_passages_, 1, all, whole);
    traverse(fill_.tree, fill_space_, fill_passages_, -1, met, whole);
    std::uint32_t on_surface = 0;
    for (const HeldBy& held : surface_passages_.held) on_surface |= 1U << held.point;
    for (std::uint32_t i = 0; i < size_; ++i) {
      held_.clear();
      for (const auto* passages : {&surface_passages_, &fill_passages_}) {
        for (const HeldBy& held : passages->held) {
          if (held.point == i) held_.push_back(held);
        }
      }
      answer_(numbers_[i], *this,
              WindingAsked{points_[i], along_, whole[i], (on_surface >> i & 1U) != 0, held_});
    }
    size_ = 0;
  }

  WindingNumber number(const WindingAsked& asked, double tolerance) const;
  Location location(const WindingAsked& asked) const;

 private:
  template <class Wanted>
  void traverse(const bvh::Tree& tree, const AxisSpace& space, WindingPassages<Real>& passages,
                int sign, const Wanted& wanted,
                std::array<std::int32_t, kernels::kAxisPoints>& whole) {
    passages.held.clear();
    passages.along = along_;
    passages.count = 0;
    for (std::uint32_t i = 0; i < size_; ++i) {
      if (!wanted(i)) continue;
      passages.points[passages.count] = points_[i];
      passages.number[passages.count++] = i;
    }
    if (passages.count == 0) return;
    space.fill(std::span(passages.points).first(passages.count), along_, packet_);
    kernel_.axis(tree, packet_, passages, counts_.kernel_counts());
    for (std::uint32_t i = 0; i < passages.count; ++i) {
      whole[passages.number[i]] += sign * packet_.winding[i];
    }
  }

  [[nodiscard]] predicate::TriangleD triangle_of(const HeldBy& held) const {
    return (held.of_fill ? fill_.geometries : geometries_).triangle(held.primitive);
  }
  /// `use(from, to, negative)` for each edge from which a strip starts.
  template <class Use>
  void each_strip(const WindingAsked& asked, const Use& use) const {
    for (const HeldBy& held : asked.held) {
      const predicate::TriangleD t = triangle_of(held);
      use(t.a, t.b, !held.of_fill);
      use(t.b, t.c, !held.of_fill);
      use(t.c, t.a, !held.of_fill);
    }
  }
  [[nodiscard]] int settle(const WindingAsked& asked) const;

  const kernels::Kernel& kernel_;
  const bvh::Tree& tree_;
  const Geometries<Real>& geometries_;
  const Fill<Real>& fill_;
  const AxisSpace& space_;
  AxisSpace fill_space_;
  StopPoll stop_;
  Counts& counts_;
  const Answer& answer_;
  WindingPassages<Real> surface_passages_, fill_passages_;
  kernels::AxisPacket packet_;
  AxisDirection along_;
  std::array<Vec3<double>, kernels::kAxisPoints> points_;
  std::array<std::size_t, kernels::kAxisPoints> numbers_{};
  std::vector<HeldBy> held_;
  std::uint32_t size_ = 0;
};

/// Sums what the kernel finds too near. An angle that is off by `good_enough` at most needs no more
/// bits.
template <class Real>
class NearAngles final : public kernels::WindingResolver {
 public:
  NearAngles(const Fill<Real>& fill, const Vec3<double>& point, double good_enough, StopPoll stop,
             predicate::LadderCounts& counts)
      : fill_(fill), point_(point), good_enough_(good_enough), stop_(stop), counts_(counts) {}

  void near(std::uint32_t number) override {
    stop_.sometimes();
    const predicate::TriangleD triangle = fill_.geometries.triangle(number);
    predicate::Angle angle = predicate::certify_half_angle(point_, triangle);
    if (angle.error > good_enough_) {
      if (predicate::decide_on_triangle(point_, triangle)) return;  // a strip stands in for it
      angle = predicate::half_angle(point_, triangle, counts_);
    }
    add(angle, false);
  }
  void add(const predicate::Angle& angle, bool negative) {
    sum_.value += negative ? -angle.value : angle.value;
    sum_.error += angle.error + 0x1p-48;
  }
  [[nodiscard]] const predicate::Angle& sum() const { return sum_; }

 private:
  const Fill<Real>& fill_;
  const Vec3<double>& point_;
  double good_enough_;
  StopPoll stop_;
  predicate::LadderCounts& counts_;
  predicate::Angle sum_;
};

template <class Real, class Counts, class Answer>
WindingNumber Winder<Real, Counts, Answer>::number(const WindingAsked& asked,
                                                   double tolerance) const {
  constexpr double kTurn = 2 * std::numbers::pi;
  constexpr int kAttempts = 5;
  const auto whole = static_cast<double>(asked.whole);
  const kernels::WindingTree& winding = fill_.winding;
  if (winding.root == bvh::kNoChild && asked.held.empty()) return {whole, 0};
  const double point[3] = {asked.point.x * winding.scale, asked.point.y * winding.scale,
                           asked.point.z * winding.scale};
  const double reach = std::max({std::fabs(point[0]), std::fabs(point[1]), std::fabs(point[2])});
  if (reach > 0x1p60) return {whole, winding.area * 0x1p-100};
  WindingNumber best{0, kInfinity<double>};
  double share = tolerance * winding.share;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    // At first a part of the tolerance for each: few are so near.
    const double good_enough =
        std::max(attempt == 0 ? 0x1p-8 * tolerance : 0, predicate::kAngleGoodEnough);
    NearAngles<Real> near(fill_, asked.point, good_enough, stop_, counts_.ladder);
    each_strip(asked, [&](const Vec3<double>& from, const Vec3<double>& to, bool negative) {
      near.add(predicate::half_angle_of_strip(asked.point, from, to, asked.along, counts_.ladder),
               negative);
    });
    const kernels::WindingSum sum = kernel_.winding(winding, point, share, near);
    const double angle = (near.sum().value + sum.angle) / kTurn;
    const double rest = angle + sum.far;
    const WindingNumber found{
        whole + rest,
        ((near.sum().error + sum.angle_error) / kTurn + sum.far_error) * (1 + 0x1p-40) +
            0x1p-50 * (std::fabs(whole) + std::fabs(angle) + std::fabs(sum.far))};
    if (found.error < best.error) best = found;
    if (found.error <= tolerance) break;
    if (share == 0 && good_enough == predicate::kAngleGoodEnough) break;
    share = attempt + 2 == kAttempts ? 0 : share * (tolerance / found.error / 2);
  }
  return best;
}

template <class Real, class Counts, class Answer>
int Winder<Real, Counts, Answer>::settle(const WindingAsked& asked) const {
  const auto tell = [&](predicate::AngleSink& sink) {
    each_strip(asked, [&](const Vec3<double>& from, const Vec3<double>& to, bool negative) {
      sink.strip(from, to, negative);
    });
    for (std::uint32_t i = 0; i < fill_.geometries.size(); ++i) {
      stop_.now();
      bool held = false;
      for (const HeldBy& by : asked.held) held |= by.of_fill && by.primitive == i;
      if (!held) sink.triangle(fill_.geometries.triangle(i));
    }
  };
  return predicate::compare_with_half_turn(asked.point, asked.along, tell, counts_.ladder);
}

template <class Real, class Counts, class Answer>
Location Winder<Real, Counts, Answer>::location(const WindingAsked& asked) const {
  if (asked.on_surface) return Location::OnSurface;
  for (const double tolerance : {0x1p-8, 0x1p-30}) {
    const WindingNumber found = number(asked, tolerance);
    const double above = found.value - 0.5;
    if (std::fabs(above) > found.error) return above > 0 ? Location::Inside : Location::Outside;
  }
  return settle(asked) > 0 ? Location::Inside : Location::Outside;
}

/// `answer(0, winder, asked)` for one point.
template <class Real, class Impl, class Answer>
void ask_winding(const Impl& impl, const AxisSpace& space, const Vec3<Real>& point,
                 const WorkOptions& work, const Answer& answer) {
  using Counts = typename Impl::Counts;
  CountSum<Counts> sum(work.statistics);
  Counts counts = sum.start();
  ++counts.rays;
  const Vec3<double> p = predicate::to_double(point);
  AxisDirection along;
  const bool looks = space.direction(p, Look::NearestExit, along);
  const Fill<Real>& fill = impl.fill->of(impl.geometries, work);
  Winder<Real, Counts, Answer> winder(impl, fill, space, work, counts, answer);
  winder.add(p, looks, along, 0);
  winder.flush();
  sum.add(counts);
}

/// `answer(i, winder, asked)` for each point i, on threads.
template <class Real, class Impl, class Answer>
void ask_windings(const Impl& impl, AxisSpace& space, const PointSource<Real>& points,
                  const WorkOptions& work, const Answer& answer) {
  using Counts = typename Impl::Counts;
  CountSum<Counts> sum(work.statistics);
  const Fill<Real>& fill = impl.fill->of(impl.geometries, work);
  const auto chunk = [&](std::size_t first, std::span<const std::uint64_t> entries) {
    Counts counts = sum.start();
    counts.rays += entries.size();
    const StopPoll stop(work.stop);
    Winder<Real, Counts, Answer> winder(impl, fill, space, work, counts, answer);
    for (const std::uint64_t entry : entries) {
      stop.now();
      const SortedPoint at(entry);
      const std::size_t number = first + at.number;
      winder.add(predicate::to_double(points[number]), at.looks, at.along, number);
    }
    winder.flush();
    sum.add(counts);
  };
  const auto nothing = [](std::size_t, std::size_t) {};
  for_sorted_points(points, space, Look::NearestExit, work, nothing, chunk, nothing);
}

}  // namespace pierce::scene
