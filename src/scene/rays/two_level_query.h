// SPDX-License-Identifier: Apache-2.0
//
// One ray's way through two levels: the traversal of the top tree, and, for each place that it may
// enter, that of the mesh's tree by the ray brought to its space. Hits of different places are held
// against each other by the scene's tau, and by the ladder where that cannot tell.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "kernels/kernel.h"
#include "scene/rays/ladder_resolver.h"
#include "scene/two_level.h"

namespace pierce::scene {

/// What a scene's tau from a t may be off by.
inline constexpr double kTauOff = 0x1p-49;

/// The end of a ray's range in the top tree; infinite ones, of either sign, stay what they are.
inline float float_end(const space::TransformedRay& ray, double end) {
  return std::abs(end) <= 4 * static_cast<double>(space::kTauLimit)
             ? static_cast<float>(end + ray.tau_pad(end))
             : static_cast<float>(end);
}

/// Whether the ray hits a triangle, by the scene's number; fills the scene's tau, within kTauOff.
template <class Real>
bool is_scene_hit(RayLadder<Real>& ladder, const space::TransformedRay& ray,
                  const kernels::Candidate& candidate, double& low, double& high) {
  predicate::Interval t;
  if (!ladder.is_hit(candidate, t)) return false;
  if (ray.exactly) {  // its shift is rounded: tau is not to be had from t
    low = -static_cast<double>(space::kTauLimit);
    high = -low;
  } else {
    low = ray.tau(t.low);
    high = ray.tau(t.high);
  }
  return true;
}

/// The first hit of a ray over several places, by the scene's numbers, as far as it is known.
struct FirstOfPlaces {
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  kernels::Candidate hit;
  double low = kNever, high = kNever;  // where it lies, in the scene's tau
  double end = kNever;                 // nothing beyond matters any more

  /// Takes another hit if it comes before; asks `is_before(found, hit)` if their places do not
  /// tell.
  template <class IsBefore>
  void offer(const kernels::Candidate& found, double its_low, double its_high,
             const IsBefore& is_before) {
    if (its_low > high) return;
    if (its_high >= low && !is_before(found, hit)) return;
    hit = found;
    low = its_low;
    high = its_high;
    end = std::min(end, its_high);
  }

  /// Of a ray that was brought to a place, what is left of its range. `unlimited`: kernels may be
  /// certain of its hits.
  void limit(space::LocalRay& local, bool unlimited) const {
    if (!unlimited) space::doubt_all_hits(local.ray);
    if (end < kNever) local.ray.tau_max = std::min(local.ray.tau_max, local.rounded_high(end));
  }
};

/// `there(placed, local_ray)` is called for each place that the ray may enter, `unknown(placed)`
/// for one of which nothing can be told; both return where the ray ends from now on, in the scene's
/// tau.
template <class Real, class There, class Unknown>
class PlaceVisitor final : public kernels::LeafVisitor {
 public:
  PlaceVisitor(const TwoLevel<Real>& two_level, const space::TransformedRay& ray,
               const There& there, const Unknown& unknown)
      : two_level_(two_level), ray_(ray), there_(there), unknown_(unknown) {
    first = reinterpret_cast<const std::byte*>(two_level.all_placed().data());
    stride = sizeof(Placed);
  }

  float visit(std::uint32_t number) override {
    const Placed& placed = two_level_.placed(number);
    space::LocalRay local;
    switch (placed.space.bring(ray_, local)) {
      case space::Brought::Misses:
        return kGoOn;
      case space::Brought::Unknown:
        return float_end(ray_, unknown_(placed));
      case space::Brought::There:
        break;
    }
    return float_end(ray_, there_(placed, local));
  }

 private:
  static constexpr float kGoOn = std::numeric_limits<float>::infinity();

  const TwoLevel<Real>& two_level_;
  const space::TransformedRay& ray_;
  const There& there_;
  const Unknown& unknown_;
};

template <class Real, class There, class Unknown>
void visit_places(const kernels::Kernel& kernel, const TwoLevel<Real>& two_level,
                  const space::FilterRay& top, const space::TransformedRay& ray,
                  kernels::KernelCounts* counts, const There& there, const Unknown& unknown) {
  PlaceVisitor<Real, There, Unknown> visitor(two_level, ray, there, unknown);
  kernel.blurred.visit(two_level.top(), top, visitor, counts);
}

/// The ladder of one ray, asked about the triangles of one place after the other.
template <class Real, class GetLadder>
class PlaceResolver final : public kernels::Resolver {
 public:
  /// `get_ladder()` is asked once the ladder is needed.
  PlaceResolver(const space::TransformedRay& ray, const GetLadder& get_ladder)
      : ray_(ray), get_ladder_(get_ladder) {}

  void enter(const Placed& placed, const space::LocalRay& local) {
    placed_ = &placed;
    local_ = &local;
  }

  bool is_hit(std::uint32_t, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    double low = 0, high = 0;
    if (!is_scene_hit(of_scene(candidate), low, high)) return false;
    const space::LocalRay::Ends ends = local_->outward(low, high);
    tau = {ends.low, ends.high};
    return true;
  }
  bool is_before(std::uint32_t, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    return get_ladder_().is_before(of_scene(challenger), of_scene(best));
  }

  /// Of a triangle by the scene's number: fills the scene's tau.
  bool is_scene_hit(const kernels::Candidate& candidate, double& low, double& high) {
    return scene::is_scene_hit(get_ladder_(), ray_, candidate, low, high);
  }

 private:
  [[nodiscard]] kernels::Candidate of_scene(kernels::Candidate candidate) const {
    candidate.primitive += placed_->first;
    return candidate;
  }

  const space::TransformedRay& ray_;
  const GetLadder& get_ladder_;
  const Placed* placed_ = nullptr;
  const space::LocalRay* local_ = nullptr;
};

/// What a query about one ray needs in two levels.
template <class Real>
struct TwoLevelRay {
  const kernels::Kernel& kernel;
  const TwoLevel<Real>& two_level;
  const space::FilterRay& top;
  const space::TransformedRay& ray;
  std::uint32_t skip;
  bool unlimited;  // kernels may be certain of hits
  kernels::KernelCounts* counts;

  /// The first hit, by the scene's number.
  template <class GetLadder>
  kernels::Candidate closest(const GetLadder& get_ladder) const {
    PlaceResolver<Real, GetLadder> resolver(ray, get_ladder);
    FirstOfPlaces first;
    const auto is_before = [&](const auto& challenger, const auto& best) {
      return get_ladder().is_before(challenger, best);
    };
    const auto there = [&](const Placed& placed, space::LocalRay& local) {
      first.limit(local, unlimited);
      resolver.enter(placed, local);
      kernels::TauInterval tau;
      kernels::Candidate found = kernel.blurred.closest(two_level.bottom(placed).tree, local.ray,
                                                        placed.local(skip), resolver, tau, counts);
      if (found.primitive == kNone) return first.end;
      found.primitive += placed.first;
      first.offer(found, local.scene_low(tau.low), local.scene_high(tau.high), is_before);
      return first.end;
    };
    const auto unknown = [&](const Placed& placed) {
      for_each_triangle(placed, [&](const kernels::Candidate& candidate) {
        double low = 0, high = 0;
        if (resolver.is_scene_hit(candidate, low, high)) {
          first.offer(candidate, low - kTauOff, high + kTauOff, is_before);
        }
        return false;
      });
      return first.end;
    };
    visit_places(kernel, two_level, top, ray, counts, there, unknown);
    return first.hit;
  }

  /// Whether there is a hit.
  template <class GetLadder>
  bool any(const GetLadder& get_ladder) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    PlaceResolver<Real, GetLadder> resolver(ray, get_ladder);
    bool found = false;
    const auto there = [&](const Placed& placed, space::LocalRay& local) {
      if (found) return -kNever;
      if (!unlimited) space::doubt_all_hits(local.ray);
      resolver.enter(placed, local);
      found = kernel.blurred.any(two_level.bottom(placed).tree, local.ray, placed.local(skip),
                                 resolver, counts);
      return found ? -kNever : kNever;
    };
    const auto unknown = [&](const Placed& placed) {
      double low = 0, high = 0;
      found = found || for_each_triangle(placed, [&](const kernels::Candidate& candidate) {
                return resolver.is_scene_hit(candidate, low, high);
              });
      return found ? -kNever : kNever;
    };
    visit_places(kernel, two_level, top, ray, counts, there, unknown);
    return found;
  }

  /// Has the sink hear of every triangle that may be hit.
  void all(kernels::CandidateSink& sink) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    struct Forward final : kernels::CandidateSink {
      kernels::CandidateSink& to;
      std::uint32_t first = 0;
      explicit Forward(kernels::CandidateSink& sink_of_scene) : to(sink_of_scene) {}
      void add(const kernels::Candidate& candidate, bool certain) override {
        kernels::Candidate of_scene = candidate;
        of_scene.primitive += first;
        to.add(of_scene, certain);
      }
    } forward(sink);
    const auto there = [&](const Placed& placed, space::LocalRay& local) {
      forward.first = placed.first;
      kernel.blurred.all(two_level.bottom(placed).tree, local.ray, placed.local(skip), forward,
                         counts);
      return kNever;
    };
    const auto unknown = [&](const Placed& placed) {
      for_each_triangle(placed, [&](const kernels::Candidate& candidate) {
        sink.add(candidate, false);
        return false;
      });
      return kNever;
    };
    visit_places(kernel, two_level, top, ray, counts, there, unknown);
  }

 private:
  template <class Visit>
  bool for_each_triangle(const Placed& placed, const Visit& visit) const {
    return two_level.for_each_triangle(placed, [&](std::uint32_t primitive) {
      return primitive != skip && visit(kernels::Candidate{primitive, 0, nullptr});
    });
  }
};

/// Has the sink hear of every triangle that the ray, which has been transformed, may hit; of two
/// levels, if there are, else of the tree.
template <class Real>
void tell_all(const kernels::Kernel& kernel, const bvh::Tree& tree, const TwoLevel<Real>* two_level,
              const Geometries<Real>& geometries, const predicate::RayD& ray, const Sight& sight,
              const space::FilterRay& filter_ray, kernels::CandidateSink& sink,
              kernels::KernelCounts* counts) {
  if (two_level == nullptr) [[likely]] {
    kernel.all(tree, filter_ray, sight.skip, sink, counts);
    return;
  }
  const space::TransformedRay transformed = geometries.space().transform(ray);
  TwoLevelRay<Real>{kernel,     *two_level,        filter_ray, transformed,
                    sight.skip, sight.unlimited(), counts}
      .all(sink);
}

}  // namespace pierce::scene
