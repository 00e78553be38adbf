// SPDX-License-Identifier: Apache-2.0
//
// next_origin against its promise, from the hits that the oracle found.
#include "campaign/check.h"
#include "campaign/start_oracle.h"

namespace pierce::campaign {
namespace {

/// Hits whose two sides are looked at: some of a case, for each is a walk through all triangles.
constexpr std::size_t kRays = 6, kHitsOfARay = 3;

template <class Real>
struct Start {
  const Built<Real>& built;
  const World& world;
  Tally& tally;

  void check(const Ray<Real>& ray, const Question& question, const ExactHit& hit, Side side,
             const World& near) const {
    const char* name = side == Side::Before ? "next_origin before" : "next_origin beyond";
    const auto start = built.scene.next_origin(ray, rounded_hit<Real>(hit), side);
    std::string fault;
    if (start) {
      tally.count(name);
      fault = fault_of_start(world, question, hit, side, as_point(*start));
    } else {
      tally.count(std::string(name) + ": none");
      if (must_have_start(near, question, hit, side) && !lies_on_any(world, question.origin)) {
        fault = "there is none, though the origin of the ray would do";
      }
    }
    if (fault.empty()) return;
    std::ostringstream text;
    text << std::hexfloat << name << ", " << built.name << ", hit of " << hit.ref.geometry << '/'
         << hit.ref.triangle << ", ray from " << ray.origin.x << ' ' << ray.origin.y << ' '
         << ray.origin.z << " along " << ray.direction.x << ' ' << ray.direction.y << ' '
         << ray.direction.z << ": " << fault;
    if (start) text << "; the start is " << start->x << ' ' << start->y << ' ' << start->z;
    tally.fail(text.str());
  }
};

}  // namespace

template <class Real>
void check_starts(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                  Tally& tally) {
  const std::size_t step = made.rays.size() / kRays + 1;
  for (std::size_t i = 0; i < made.rays.size(); i += step) {
    const auto& ray = made.rays[i];
    const Question question{as_point(ray.origin), as_point(ray.direction), double{ray.t_min},
                            double{ray.t_max}};
    const World near = candidates(world, question.origin, question.direction);
    auto hits = asked(line_hits(near, question.origin, question.direction), question);
    if (hits.size() > kHitsOfARay) hits.resize(kHitsOfARay);
    const Start<Real> start{scenes[i / step % scenes.size()], world, tally};
    for (const auto& hit : hits) {
      for (const Side side : {Side::Before, Side::Beyond}) {
        start.check(ray, question, hit, side, near);
      }
    }
  }
}

template void check_starts(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_starts(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
