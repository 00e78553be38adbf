// SPDX-License-Identifier: Apache-2.0
//
// What is true of a ray and a triangle, or a box: in 192 bits where all numbers lie on the grid
// (grid.h), else in numbers of any size (support/quick_oracle.h).
#pragma once

#include <array>
#include <optional>

#include "bounds/grid.h"
#include "space/filter_space.h"
#include "support/quick_oracle.h"

namespace pierce::siege {

/// A ray as its user gives it.
class Line {
 public:
  /// One whose parameter in filter space is t.
  explicit Line(const predicate::RayD& ray)
      : ray_(ray),
        tau_is_t_(true),
        on_grid_(on_the_grid(ray.origin) && on_the_grid(ray.direction)),
        origin_(on_grid_ ? to_grid(ray.origin) : Triple<Int>{}),
        direction_(on_grid_ ? to_grid(ray.direction) : Triple<Int>{}) {}

  /// One that was brought to filter space: tau = t 2^exponent - shift, where the shift of a ray
  /// that was transformed exactly is that of its point nearest to the centre, and the double merely
  /// near.
  Line(const predicate::RayD& ray, const space::TransformedRay& transformed,
       const Vec3<double>& center)
      : ray_(ray), tau_is_t_(false), on_grid_(false), origin_{}, direction_{} {
    grow_ = oracle::Dyadic(mpz_class(1), transformed.tau_exponent);
    shift_num_ = oracle::Dyadic(transformed.tau_shift);
    shift_den_ = oracle::Dyadic(1);
    if (!transformed.exactly) return;
    const oracle::DyadicVec d = oracle::exact(ray.direction);
    const oracle::DyadicVec back = oracle::exact(center) - oracle::exact(ray.origin);
    shift_num_ = dot(back, d) * grow_;
    shift_den_ = dot(d, d);
  }

  [[nodiscard]] const predicate::RayD& ray() const { return ray_; }
  [[nodiscard]] bool on_grid() const { return on_grid_; }
  [[nodiscard]] const Triple<Int>& origin() const { return origin_; }
  [[nodiscard]] const Triple<Int>& direction() const { return direction_; }
  [[nodiscard]] bool tau_is_t() const { return tau_is_t_; }

  /// The sign of the tau of a hit less the bound, where tau is not t.
  [[nodiscard]] int compare_tau(const oracle::QuickHit& hit, double bound) const {
    if (std::isinf(bound)) return bound > 0 ? -1 : 1;
    const oracle::Dyadic limit = oracle::Dyadic(bound) * shift_den_ + shift_num_;
    return compare(hit.t_num * grow_ * shift_den_, limit * hit.den) * hit.den.sign();
  }

 private:
  predicate::RayD ray_;
  bool tau_is_t_, on_grid_;
  Triple<Int> origin_, direction_;
  oracle::Dyadic grow_, shift_num_, shift_den_;  // the shift's denominator is positive
};

/// A ray and a triangle.
class Pair {
 public:
  Pair(const Line& line, const predicate::TriangleD& t) : line_(&line) {
    if (line.on_grid() && on_the_grid(t.a) && on_the_grid(t.b) && on_the_grid(t.c)) {
      grid_.emplace(line.origin(), line.direction(), t);
      line_hits_ = grid_->line_hits();
    } else {
      const predicate::RayD& ray = line.ray();
      const oracle::LineAndTriangle wide(Ray<double>{ray.origin, ray.direction, 0, 0}, t.a, t.b,
                                         t.c);
      line_hits_ = wide.line_hits();
      if (line_hits_) wide_.emplace(wide.hit_numbers());
    }
  }

  [[nodiscard]] bool line_hits() const { return line_hits_; }

  /// Whether the ray hits the triangle.
  [[nodiscard]] bool hit() const {
    if (!line_hits_) return false;
    const predicate::RayD& ray = line_->ray();
    const int start = compare_t(ray.t_min);
    return (start > 0 || (start == 0 && !ray.open_start)) && compare_t(ray.t_max) <= 0;
  }

  /// From where, for a line that hits.
  [[nodiscard]] Facing facing() const {
    const int den = grid_ ? grid_->den().sign() : wide_->den.sign();
    return den < 0 ? Facing::Front : Facing::Back;
  }

  /// The sign of t - bound, for a line that hits.
  [[nodiscard]] int compare_t(double bound) const {
    return grid_ ? grid_->compare_tau(bound) : oracle::compare_t(*wide_, bound);
  }

  /// The sign of tau - bound likewise.
  [[nodiscard]] int compare_tau(float bound_f) const {
    const auto bound = static_cast<double>(bound_f);
    if (line_->tau_is_t()) return compare_t(bound);
    return line_->compare_tau(*wide_, bound);
  }

  /// The sign of this t less the other's, of two pairs of one line, which hits both.
  [[nodiscard]] int order(const Pair& other) const {
    if (grid_ && other.grid_) return grid_->order(*other.grid_);
    return oracle::compare_t(wide(), other.wide());
  }

 private:
  [[nodiscard]] oracle::QuickHit wide() const {
    if (wide_) return *wide_;
    oracle::QuickHit hit;
    hit.t_num = oracle::Dyadic(grid_->t().exact(), 0);
    hit.den = oracle::Dyadic(grid_->den().exact(), 0);
    return hit;
  }

  const Line* line_;
  std::optional<GridPair> grid_;
  std::optional<oracle::QuickHit> wide_;
  bool line_hits_ = false;
};

/// Where a ray runs within a box: entry <= tau <= exit.
template <class N>
struct Passage {
  N entry_num, entry_den, exit_num, exit_den;  // denominators are positive
};

/// Whether the line is within the planes of one axis, and if so between which tau.
template <class N, class Less>
bool clip(const N& lower, const N& upper, const N& origin, const N& direction, int sign,
          const N& minus_direction, Passage<N>& p, const Less& less) {
  if (sign == 0) return !less(origin, lower) && !less(upper, origin);
  const N in = sign > 0 ? lower - origin : origin - upper;
  const N out = sign > 0 ? upper - origin : origin - lower;
  const N& size = sign > 0 ? direction : minus_direction;
  if (less(p.entry_num * size, in * p.entry_den)) p.entry_num = in, p.entry_den = size;
  if (less(out * p.exit_den, p.exit_num * size)) p.exit_num = out, p.exit_den = size;
  return true;
}

/// A box of floats as true triangles fill it: they may stick out by 2^-53.
struct FloatBox {
  float lower[3], upper[3];
};
inline constexpr double kStickOut = 0x1p-53;

/// A ray and a box, within [tau_min, tau_max]; for lines whose tau is t.
class BoxPair {
 public:
  BoxPair(const Line& line, const FloatBox& box, double tau_min, double tau_max) {
    bool grid = line.on_grid() && on_the_grid(tau_min) && on_the_grid(tau_max);
    for (int k = 0; k < 3; ++k) {
      grid = grid && on_the_grid(static_cast<double>(box.lower[k])) &&
             on_the_grid(static_cast<double>(box.upper[k]));
    }
    if (grid)
      run<Int2>(line, box, tau_min, tau_max, [](double x) { return Int2{to_grid(x)}; });
    else
      run<oracle::Dyadic>(line, box, tau_min, tau_max, [](double x) { return oracle::Dyadic(x); });
  }

  /// Whether the ray touches the box.
  [[nodiscard]] bool touches() const { return touches_; }
  /// Not below the tau at which it first does, and all but that.
  [[nodiscard]] double entry() const { return entry_; }

 private:
  static double approximate(Int2 x) { return static_cast<double>(x) * kGrid; }
  static double approximate(const oracle::Dyadic& x) {
    long exponent = 0;
    const double m = mpz_get_d_2exp(&exponent, x.mantissa().get_mpz_t());
    return std::ldexp(m, static_cast<int>(exponent + x.exponent()));
  }
  static bool less(Int2 a, Int2 b) { return a < b; }
  static bool less(const oracle::Dyadic& a, const oracle::Dyadic& b) { return compare(a, b) < 0; }

  template <class N, class Read>
  void run(const Line& line, const FloatBox& box, double tau_min, double tau_max,
           const Read& read) {
    const auto order = [](const N& a, const N& b) { return less(a, b); };
    const Vec3<double>& o = line.ray().origin;
    const Vec3<double>& d = line.ray().direction;
    const double origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z};
    Passage<N> p{read(tau_min), read(1), read(tau_max), read(1)};
    const N stick_out = read(kStickOut);
    touches_ = true;
    for (int k = 0; k < 3 && touches_; ++k) {
      const int sign = direction[k] > 0 ? 1 : direction[k] < 0 ? -1 : 0;
      touches_ = clip<N>(read(static_cast<double>(box.lower[k])) - stick_out,
                         read(static_cast<double>(box.upper[k])) + stick_out, read(origin[k]),
                         read(direction[k]), sign, read(-direction[k]), p, order);
    }
    touches_ = touches_ && !less(p.exit_num * p.entry_den, p.entry_num * p.exit_den);
    const double entry = approximate(p.entry_num) / approximate(p.entry_den);
    entry_ = entry + 0x1p-48 * std::fabs(entry);
  }

  bool touches_ = false;
  double entry_ = 0;
};

}  // namespace pierce::siege
