// SPDX-License-Identifier: Apache-2.0
//
// What is true of a ray under every option of QueryOptions, and what a filter is to be asked on the
// way: from all hits of the whole line, put in order by exact arithmetic.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "pierce/options.h"
#include "pierce/types.h"
#include "support/quick_oracle.h"

namespace pierce::oracle {

template <class Real>
class StepTruth {
 public:
  struct Answer {
    std::vector<Hit<Real>> hits, asked;  // those that count, those that the filter is asked about
  };

  /// `masks`: one a mesh, or none.
  StepTruth(std::span<const MeshView<Real>> meshes, std::vector<std::uint32_t> masks,
            const Ray<Real>& ray)
      : masks_(std::move(masks)), ray_(ray) {
    for (std::uint32_t g = 0; g < meshes.size(); ++g) {
      for (std::uint32_t i = 0; i < meshes[g].triangles.size(); ++i) {
        const auto& [a, b, c] = meshes[g].triangles[i];
        const auto& v = meshes[g].vertices;
        const LineAndTriangle pair(ray, v[a], v[b], v[c]);
        if (pair.line_hits()) {
          line_.push_back({pair.hit_numbers(), rounded<Real>(pair.hit_numbers(), g, i)});
        }
      }
    }
    std::stable_sort(line_.begin(), line_.end(), [](const LineHit& p, const LineHit& q) {
      return compare_t(p.exact, q.exact) < 0;
    });
  }

  /// Those triangles that `after` may name.
  [[nodiscard]] std::vector<TriangleRef> on_line() const {
    std::vector<TriangleRef> refs;
    for (const LineHit& hit : line_) refs.push_back(hit.hit);
    return refs;
  }

  /// `most`: how many hits are wanted.
  [[nodiscard]] Answer answer(const QueryOptions& o, std::uint64_t most) const {
    Answer answer;
    const LineHit* last = nullptr;  // at whose t nothing more counts
    auto from = line_.begin();
    if (o.after.triangle != kNone) {
      from = std::find_if(line_.begin(), line_.end(),
                          [&](const LineHit& hit) { return TriangleRef(hit.hit) == o.after; });
      if (o.distinct) last = &*from;
      ++from;
    }
    for (; from != line_.end() && answer.hits.size() < most; ++from) {
      if (!sees(*from, o)) continue;
      if (last != nullptr && compare_t(last->exact, from->exact) == 0) continue;
      if (o.filter) {
        answer.asked.push_back(from->hit);
        const Hit<Real>& h = from->hit;
        if (!o.filter(0, {h.t, h.u, h.v, h.w, h.geometry, h.triangle, h.facing})) continue;
      }
      answer.hits.push_back(from->hit);
      if (o.distinct) last = &*from;
    }
    return answer;
  }

 private:
  struct LineHit {
    QuickHit exact;
    Hit<Real> hit;
  };

  [[nodiscard]] bool sees(const LineHit& hit, const QueryOptions& o) const {
    const int start = compare_t(hit.exact, ray_.t_min);
    if (start < 0 || (start == 0 && o.range == Range::OpenStart)) return false;
    if (compare_t(hit.exact, ray_.t_max) > 0 || TriangleRef(hit.hit) == o.skip) return false;
    const std::uint32_t mask = masks_.empty() ? kAllBits : masks_[hit.hit.geometry];
    return (mask & o.mask) != 0 && (o.sides == Sides::Both ||
                                    (o.sides == Sides::Front) == (hit.hit.facing == Facing::Front));
  }

  std::vector<std::uint32_t> masks_;
  Ray<Real> ray_;
  std::vector<LineHit> line_;
};

}  // namespace pierce::oracle
