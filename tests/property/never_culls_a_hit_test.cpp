// SPDX-License-Identifier: Apache-2.0
//
// The float rung may only lose a candidate or be certain too soon; this attacks both, through every
// kernel of this machine, with rays and triangles that come as near to the bounds as we know how
// (support/leaf_attacks.h). Truth comes from exact arithmetic on the same numbers before they were
// rounded. 10^5 attacks of each kind in ctest; the long run is
//   PIERCE_CASES=10000000 property_never_culls_a_hit_test
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>

#include "kernels/kernel.h"
#include "support/leaf_attacks.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using attack::Aim;
using attack::LeafCase;
using attack::Plan;
using attack::operator+;
using attack::operator*;
using hard::Rng;

constexpr std::uint64_t kAttacks = 40000;
constexpr int kDraws = 8;

// Most attacks are drawn, some climb.
int steps_of(Rng& rng) { return rng.one_in(64) ? 256 : 0; }

std::string text(const LeafCase& c) {
  std::string s;
  const auto add = [&s](const char* name, const Vec3<double>& p) {
    s += std::string(name) + show::text(p) + "\n";
  };
  add("origin ", c.ray.origin);
  add("direction ", c.ray.direction);
  s += "range " + show::text(c.ray.t_min) + " .. " + show::text(c.ray.t_max) + "\n";
  for (const predicate::TriangleD& t : c.triangles) {
    add("a ", t.a);
    add("b ", t.b);
    add("c ", t.c);
  }
  return s;
}

// The error of the first kernel that makes one, with its name; empty if none does.
std::string error_of(const LeafCase& c, bool exact, std::uint64_t& asked) {
  const bvh::Tree tree = attack::one_leaf(c.triangles);
  const attack::Truth truth(c);
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    const char* error = attack::first_error(*kernel, tree, c, truth, exact, asked);
    if (error != nullptr) return std::string(kernel->name) + ": " + error;
  }
  return {};
}

Plan draw_plan(Rng& rng, Aim aim) {
  const bool exact = rng.one_in(3);
  return {aim, exact, rng.one_in(4) ? rng.between(0, 25) : rng.between(4, 16)};
}

// `borders`: every hit is on a border, where nothing is certain.
void run(Aim aim, std::uint64_t salt, bool borders, LeafCase (*make)(Rng&, const Plan&)) {
  std::atomic<std::uint64_t> hits = 0;
  std::atomic<std::uint64_t> certain = 0;
  const auto attack_of = [&](std::uint64_t i, bool& exact) {
    Rng rng(hard::seed() + salt, i);
    const Plan plan = draw_plan(rng, aim);
    exact = plan.exact;
    return make(rng, plan);
  };
  const std::uint64_t count = hard::case_count(kAttacks);
  const auto failure = hard::first_failure(count, [&](std::uint64_t i) {
    bool exact = false;
    const LeafCase c = attack_of(i, exact);
    std::uint64_t asked = 0;
    const bool wrong = !error_of(c, exact, asked).empty();
    const attack::Truth truth(c);
    hits += truth.hits != 0 ? 1 : 0;
    certain += truth.hits != 0 && asked < kernels::kernels().size() ? 1 : 0;
    return wrong;
  });
  if (failure) {
    bool exact = false;
    std::uint64_t asked = 0;
    const LeafCase c = attack_of(*failure, exact);
    FAIL() << "seed " << hard::seed() << " attack " << *failure << ": " << error_of(c, exact, asked)
           << "\n"
           << text(c) << (exact ? "all floats" : "rounded");
  }
  if (!hard::enough_cases(kAttacks)) return;
  // What is attacked must be there to be lost.
  EXPECT_GT(hits, count / 50);
  if (kernels::kernels().size() > 1 && !borders) {
    EXPECT_GT(certain, count / 1000);
  }
}

TEST(NeverCullsAHit, hits_on_the_border_of_a_triangle_are_kept) {
  run(Aim::DiscardHit, 10, true, [](Rng& rng, const Plan& plan) {
    return attack::draw_attack(rng, plan, kDraws, steps_of(rng)).c;
  });
}

TEST(NeverCullsAHit, misses_at_the_border_of_a_triangle_are_never_certain) {
  run(Aim::CertainMiss, 20, true, [](Rng& rng, const Plan& plan) {
    return attack::draw_attack(rng,
                               rng.coin() ? plan : Plan{Aim::DiscardHit, plan.exact, plan.size},
                               kDraws, steps_of(rng))
        .c;
  });
}

// The range ends at the hit, or within a few units of a float's last place.
LeafCase draw_end(Rng& rng, const Plan& plan) {
  LeafCase c = attack::draw_attack(rng, plan, kDraws, steps_of(rng)).c;
  predicate::RayD line = c.ray;
  line.t_min = -kInfinity<double>;
  line.t_max = kInfinity<double>;
  const predicate::TriangleD& triangle = c.triangles.front();
  const bool hit = predicate::settle_hit(line, triangle).hit;
  const double tau = hit ? predicate::settle_numbers<double>(line, triangle).t : 0;
  const double end =
      tau + (rng.coin() ? 0 : rng.symmetric() * std::ldexp(1.0, -rng.between(16, 52)));
  (rng.coin() ? c.ray.t_min : c.ray.t_max) = end;
  c.ray.open_start = rng.one_in(4);
  return c;
}

TEST(NeverCullsAHit, hits_at_the_ends_of_the_range_are_kept) {
  run(Aim::DiscardByRange, 30, false, draw_end);
}

// Two triangles through one point, or one all but behind the other.
TEST(NeverCullsAHit, the_first_of_two_near_hits_comes_first) {
  run(Aim::CertainOutOfRange, 40, false, [](Rng& rng, const Plan& plan) {
    LeafCase c = attack::draw_attack(rng, plan, kDraws, steps_of(rng)).c;
    predicate::TriangleD behind = c.triangles.front();
    const double by = rng.symmetric() * std::ldexp(1.0, -rng.between(14, 40));
    for (Vec3<double>* p : {&behind.a, &behind.b, &behind.c}) {
      Vec3<double> moved = *p + by * c.ray.direction;
      moved = plan.exact ? attack::rounded(moved) : attack::on_grid(moved);
      if (attack::max_norm(moved) <= 1) *p = moved;
    }
    if (rng.coin()) std::swap(behind.a, behind.b);
    c.triangles.insert(rng.coin() ? c.triangles.begin() : c.triangles.end(), behind);
    return c;
  });
}

// How near what is seen of the first triangle comes to a wrong answer.
double harm(const attack::BlurredCase& blurred, Aim aim, double tau) {
  const predicate::TriangleD& t = blurred.seen.triangles.front();
  const attack::CullModel model(blurred.seen.ray, t, false, false);
  const double edge = bvh::largest_edge({t.a, t.b, t.c});
  const double size =
      static_cast<double>(blurred.blur) * (edge + static_cast<double>(blurred.blur));
  const auto least = static_cast<double>(std::min({model.u, model.v, 0.5F * model.w}));
  if (aim == Aim::DiscardHit) return -least / size;
  if (aim == Aim::CertainMiss) return std::min(least, 0.5 * static_cast<double>(model.den)) / size;
  return std::fabs(static_cast<double>(model.tau) - tau) * static_cast<double>(model.den) / size;
}

// What a ray sees in a space of its own: corners and origin off by as much as the blur allows, the
// most harmful of some draws.
attack::BlurredCase draw_blurred(Rng& rng, Aim aim) {
  const int size = rng.between(1, 14);
  const Plan plan{aim == Aim::CertainMiss ? aim : Aim::DiscardHit, rng.one_in(3), size};
  attack::BlurredCase blurred{attack::draw_attack(rng, plan, kDraws, 0).c, {}, 0};
  LeafCase& c = blurred.c;
  c.triangles.resize(1);
  double tau = 0;
  if (aim == Aim::DiscardByRange) {  // which ends where it is met
    const predicate::TriangleD& t = c.triangles.front();
    if (predicate::settle_hit(c.ray, t).hit) tau = predicate::settle_numbers<double>(c.ray, t).t;
    (rng.coin() ? c.ray.t_min : c.ray.t_max) = tau;
  }
  // From next to nothing up to many times as much as the edges are.
  const double all = std::ldexp(1 + rng.unit(), -std::clamp(size + rng.between(-6, 16), 9, 30));
  const double blur = std::min(all, bounds::kLargestBlur);
  const double of_corners = rng.coin() ? blur : rng.coin() ? 0 : blur * rng.unit();
  blurred.blur = static_cast<float>(blur);
  const auto off = [&](double by) { return rng.coin() ? by : -by; };
  const auto moved = [&](const Vec3<double>& p, const Vec3<double>& by, double limit) {
    const auto sum = [limit](double x, double y) { return std::clamp(x + y, -limit, limit); };
    return attack::on_grid(Vec3<double>{sum(p.x, by.x), sum(p.y, by.y), sum(p.z, by.z)});
  };
  // On the grid, which may round up.
  const double corner = 0.999 * of_corners, origin = 0.999 * (blur - of_corners);
  double most = -kInfinity<double>;
  LeafCase worst;
  for (int draw = 0; draw < 48; ++draw) {
    const bool same = rng.one_in(4);       // all corners the same way
    const bool collapsed = rng.one_in(4);  // or as near to one another as can be
    blurred.seen = c;
    const Vec3<double> together{off(corner), off(corner), off(corner)};
    predicate::TriangleD& t = blurred.seen.triangles.front();
    const Vec3<double> a = t.a;
    for (Vec3<double>* p : {&t.a, &t.b, &t.c}) {
      const auto towards = [&](double to, double from) {
        return std::clamp(to - from, -corner, corner);
      };
      const Vec3<double> by =
          collapsed ? Vec3<double>{towards(a.x, p->x), towards(a.y, p->y), towards(a.z, p->z)}
          : same    ? together
                    : Vec3<double>{off(corner), off(corner), off(corner)};
      *p = moved(*p, by, 1);
    }
    Vec3<double>& o = blurred.seen.ray.origin;
    o = moved(o, {off(origin), off(origin), off(origin)}, 2);
    const double harmful = harm(blurred, aim, tau);
    if (harmful < most) continue;
    most = harmful;
    worst = blurred.seen;
  }
  if (!worst.triangles.empty()) blurred.seen = worst;
  return blurred;
}

TEST(NeverCullsAHit, of_rays_that_are_blurred) {
  std::atomic<std::uint64_t> hits = 0, certain = 0;
  const auto attack_of = [](std::uint64_t i) {
    Rng rng(hard::seed() + 50, i);
    const Aim aims[] = {Aim::DiscardHit, Aim::CertainMiss, Aim::DiscardByRange};
    return draw_blurred(rng, aims[i % 3]);
  };
  const auto error_of_blurred = [&](const attack::BlurredCase& blurred,
                                    std::uint64_t& asked) -> std::string {
    const attack::Truth truth(blurred.c);
    for (const kernels::Kernel* kernel : kernels::kernels()) {
      const char* error = attack::first_error(*kernel, blurred, truth, asked);
      if (error != nullptr) return std::string(kernel->name) + ": " + error;
    }
    return {};
  };
  const std::uint64_t count = hard::case_count(kAttacks);
  const auto failure = hard::first_failure(count, [&](std::uint64_t i) {
    const attack::BlurredCase blurred = attack_of(i);
    std::uint64_t asked = 0;
    const bool wrong = !error_of_blurred(blurred, asked).empty();
    const attack::Truth truth(blurred.c);
    hits += truth.hits != 0 ? 1 : 0;
    certain += truth.hits != 0 && asked < kernels::kernels().size() ? 1 : 0;
    return wrong;
  });
  if (failure) {
    const attack::BlurredCase blurred = attack_of(*failure);
    std::uint64_t asked = 0;
    FAIL() << "seed " << hard::seed() << " attack " << *failure << ": "
           << error_of_blurred(blurred, asked) << "\n"
           << text(blurred.c) << "seen as\n"
           << text(blurred.seen) << "blur " << blurred.blur;
  }
  if (!hard::enough_cases(kAttacks)) return;
  EXPECT_GT(hits, count / 50);
  if (kernels::kernels().size() > 1) {
    EXPECT_GT(certain, count / 10000);
  }
}

}  // namespace
}  // namespace pierce
