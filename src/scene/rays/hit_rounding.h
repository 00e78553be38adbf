// SPDX-License-Identifier: Apache-2.0
//
// Hits of a block, queued to be rounded 32 at a time: in lanes, with a scalar fallback for the few
// of which that is not certain.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "kernels/kernel.h"
#include "pierce/types.h"
#include "predicate/round.h"
#include "predicate/types.h"

namespace pierce::scene {

/// Sets t, u, v, w and facing.
template <class Real>
void set_numbers(const Hit<Real>& from, Hit<Real>& to) {
  to.t = from.t;
  to.u = from.u;
  to.v = from.v;
  to.w = from.w;
  to.facing = from.facing;
}

template <class Real>
class HitRounding {
 public:
  /// The numbers of this pair, surely a hit, will be set in `hit`. Not when full.
  template <class AnyRay>
  void add(const AnyRay& ray, const predicate::TriangleD& triangle, Hit<Real>& hit) {
    put(0, triangle.a);
    put(3, triangle.b);
    put(6, triangle.c);
    put(9, ray.origin);
    put(12, ray.direction);
    hits_[size_++] = &hit;
  }

  [[nodiscard]] bool full() const { return size_ == kernels::kRoundBatch; }

  /// Rounds all that are queued.
  void round(const kernels::Kernel& kernel, predicate::LadderCounts& counts) {
    if (size_ == 0) return;
    kernel.of<Real>().round(columns_, size_, rounded_);
    for (std::size_t i = 0; i < size_; ++i) {
      Hit<Real>& hit = *hits_[i];
      hit.t = rounded_.t[i];
      hit.u = rounded_.u[i];
      hit.v = rounded_.v[i];
      hit.w = rounded_.w[i];
      hit.facing = ((rounded_.front >> i) & 1U) != 0 ? Facing::Front : Facing::Back;
    }
    const auto all = static_cast<std::uint32_t>((std::uint64_t{1} << size_) - 1);
    for (std::uint32_t rest = ~rounded_.sure & all; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      const predicate::RayD ray{point(9, i), point(12, i)};
      const predicate::TriangleD triangle{point(0, i), point(3, i), point(6, i)};
      Hit<Real> hit;
      if (!kernel.of<Real>().round_one(ray, triangle, hit))
        hit = predicate::round_hit<Real>(ray, triangle, 0, counts);
      set_numbers(hit, *hits_[i]);
    }
    size_ = 0;
  }

 private:
  template <class Number>
  void put(std::size_t row, const Vec3<Number>& p) {
    columns_.number[row][size_] = static_cast<double>(p.x);
    columns_.number[row + 1][size_] = static_cast<double>(p.y);
    columns_.number[row + 2][size_] = static_cast<double>(p.z);
  }
  [[nodiscard]] Vec3<double> point(std::size_t row, std::size_t i) const {
    return {columns_.number[row][i], columns_.number[row + 1][i], columns_.number[row + 2][i]};
  }

  std::size_t size_ = 0;
  kernels::HitColumns columns_{};  // the columns that are not used are read, too
  kernels::RoundedColumns<Real> rounded_;
  std::array<Hit<Real>*, kernels::kRoundBatch> hits_;
};

}  // namespace pierce::scene
