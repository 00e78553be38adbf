// SPDX-License-Identifier: Apache-2.0
//
// Coherent rays, or all but coherent ones, past triangles that they only just meet, each alone in
// its box: what packets, streams and single rays of every kernel ask the resolver about, and what
// they answer.
#include "bounds/siege.h"

namespace pierce::siege {
namespace {

using Vec = Vec3<double>;

constexpr std::uint32_t kMostRays = 64;

/// A node over up to eight leaves of one triangle each.
bvh::Tree tree_over(const std::vector<TriangleD>& triangles, const attack::Corners& corners,
                    bvh::Layout layout) {
  const auto count = static_cast<std::uint32_t>(triangles.size());
  const std::uint32_t units = bvh::leaf_units(layout, 1);
  bvh::Tree tree;
  tree.layout = layout;
  tree.primitives = &corners;
  tree.leaves = bvh::HugeBuffer<std::byte>(count * units * bvh::kLeafUnit + bvh::kLeafSlack);
  std::memset(tree.leaves.data(), 0, tree.leaves.size());
  tree.nodes = bvh::HugeBuffer<bvh::Node>(1);
  bvh::Node& node = tree.nodes[0];
  for (std::uint32_t i = 0; i < bvh::kWidth; ++i) {
    const bool used = i < count;
    bvh::Box box;
    if (used) {
      const TriangleD& t = triangles[i];
      box = bvh::padded(bvh::box_of({t.a, t.b, t.c}));
      bvh::write_leaf_block(layout, tree.leaves.data() + std::size_t{i} * units * bvh::kLeafUnit,
                            corners, &i, 1);
    }
    bvh::set_child_box(node, static_cast<int>(i), box);
    node.child[i] = used ? bvh::make_leaf(i * units, 1) : bvh::kNoChild;
  }
  bvh::order_children(node);
  tree.root = 0;
  return tree;
}

/// Rays and triangles, and what is true of each pair.
struct Case {
  std::vector<RayD> rays;
  std::vector<TriangleD> triangles;
  std::vector<Line> lines;
  std::vector<std::vector<Pair>> pairs;  // by ray, then triangle
  std::vector<std::uint32_t> hit;        // by ray, a bit a triangle

  /// The first hit of a ray.
  [[nodiscard]] std::uint32_t closest(std::size_t ray) const {
    std::uint32_t first = kNone;
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      if (((hit[ray] >> i) & 1U) == 0) continue;
      if (first == kNone || before(ray, i, first)) first = i;
    }
    return first;
  }
  [[nodiscard]] bool before(std::size_t ray, std::uint32_t i, std::uint32_t other) const {
    const int order = pairs[ray][i].order(pairs[ray][other]);
    return order < 0 || (order == 0 && i < other);
  }
};

/// Tells the truth, save that it may deny all hits, so that a traversal asks about everything;
/// keeps what it was asked.
class Judge final : public kernels::Resolver {
 public:
  Judge(const Case& of, bool denies) : case_(of), denies_(denies), asked_(of.rays.size()) {}
  bool is_hit(std::uint32_t ray, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    asked_[ray] |= 1U << candidate.primitive;
    tau = {-space::kTauLimit, space::kTauLimit};
    return !denies_ && ((case_.hit[ray] >> candidate.primitive) & 1U) != 0;
  }
  bool is_before(std::uint32_t ray, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    return case_.before(ray, challenger.primitive, best.primitive);
  }
  /// The first ray that was not asked about a triangle that it hits, or kNone.
  [[nodiscard]] std::uint32_t first_not_asked() const {
    for (std::uint32_t i = 0; i < asked_.size(); ++i) {
      if ((case_.hit[i] & ~asked_[i]) != 0) return i;
    }
    return kNone;
  }

 private:
  const Case& case_;
  bool denies_;
  std::vector<std::uint32_t> asked_;
};

/// A ray of a case by itself.
class JudgeOfOne final : public kernels::Resolver {
 public:
  JudgeOfOne(Judge& judge, std::uint32_t ray) : judge_(judge), ray_(ray) {}
  bool is_hit(std::uint32_t, const kernels::Candidate& candidate,
              kernels::TauInterval& tau) override {
    return judge_.is_hit(ray_, candidate, tau);
  }
  bool is_before(std::uint32_t, const kernels::Candidate& challenger,
                 const kernels::Candidate& best) override {
    return judge_.is_before(ray_, challenger, best);
  }

 private:
  Judge& judge_;
  std::uint32_t ray_;
};

/// Keeps what it was told of.
struct Witness final : kernels::CandidateSink {
  void add(const kernels::Candidate& candidate, bool /*certain*/) override {
    told |= 1U << candidate.primitive;
  }
  std::uint32_t told = 0;
};

/// A kernel's traversals over one case; `wrong_ray` is the ray of an error.
struct Trial {
  const kernels::Kernel& kernel;
  const bvh::Tree& tree;
  const Case& of;
  std::vector<space::FilterRay> rays;
  std::vector<std::uint32_t> skips;
  std::uint32_t wrong_ray = 0;

  [[nodiscard]] kernels::RayBlock block() {
    return {rays.data(), skips.data(), static_cast<std::uint32_t>(rays.size())};
  }

  /// Nothing is certain and nothing is hit, so everything must be asked about.
  const char* lost() {
    for (space::FilterRay& ray : rays) space::doubt_all_hits(ray);
    const auto count = rays.size();
    std::vector<std::uint8_t> any(count);
    std::vector<kernels::Candidate> closest(count);
    Judge for_any(of, true), for_closest(of, true);
    kernel.any_block(tree, block(), for_any, any.data(), nullptr);
    wrong_ray = for_any.first_not_asked();
    if (wrong_ray != kNone) return "any, block: a hit is discarded";
    kernel.closest_block(tree, block(), for_closest, closest.data(), nullptr);
    wrong_ray = for_closest.first_not_asked();
    if (wrong_ray != kNone) return "closest, block: a hit is discarded";
    for (std::uint32_t i = 0; i < count; i += 16) {
      Witness witness;
      kernel.all(tree, rays[i], kNone, witness, nullptr);
      if ((of.hit[i] & ~witness.told) == 0) continue;
      wrong_ray = i;
      return "all, one ray: a hit is discarded";
    }
    return nullptr;
  }

  /// Told the truth, every traversal must find it.
  const char* untrue() {
    const auto count = rays.size();
    std::vector<std::uint8_t> any(count);
    std::vector<kernels::Candidate> closest(count);
    Judge truthful(of, false);
    kernel.any_block(tree, block(), truthful, any.data(), nullptr);
    kernel.closest_block(tree, block(), truthful, closest.data(), nullptr);
    for (wrong_ray = 0; wrong_ray < count; ++wrong_ray) {
      const std::uint32_t i = wrong_ray, truth = of.closest(i);
      if ((any[i] != 0) != (truth != kNone)) return "any, block: untrue";
      if (closest[i].primitive != truth) return "closest, block: untrue";
      if (i % 16 != 0) continue;
      JudgeOfOne judge(truthful, i);
      if (kernel.any(tree, rays[i], kNone, judge, nullptr) != (truth != kNone))
        return "any, one ray: untrue";
      if (kernel.closest(tree, rays[i], kNone, judge, nullptr).primitive != truth)
        return "closest, one ray: untrue";
    }
    return nullptr;
  }
};

/// Rays as near to the first as `spread` says, or that one itself; some through the same point.
std::vector<RayD> draw_bundle(Rng& rng, const Plan& plan, const RayD& first, const Vec& through,
                              double tau) {
  const auto count = rng.coin() ? 16U : static_cast<std::uint32_t>(rng.between(3, kMostRays));
  const double spread = rng.one_in(4) ? 0 : std::ldexp(0.1, -rng.between(0, 50));
  const auto moved = [&](const Vec& p) {
    return Vec{p.x + spread * rng.symmetric(), p.y + spread * rng.symmetric(),
               p.z + spread * rng.symmetric()};
  };
  std::vector<RayD> rays(count, first);
  for (std::uint32_t i = 1; i < count; ++i) {
    Vec d = moved(first.direction), o = moved(first.origin);
    if (rng.one_in(4)) o = {through.x - tau * d.x, through.y - tau * d.y, through.z - tau * d.z};
    for (std::size_t k = 0; k < 3; ++k) {  // zeros stay
      Vec was = first.direction;
      if (hard::component(was, k) == 0) hard::component(d, k) = hard::component(was, k);
    }
    const double size = attack::max_norm(d);
    if (!(attack::max_norm(o) <= 2) || size < 1 || size >= 2) continue;
    rays[i].origin = plan.exact ? attack::rounded(o) : attack::on_grid(o);
    rays[i].direction = plan.exact ? attack::rounded(d) : attack::on_grid(d);
    if (attack::max_norm(rays[i].direction) >= 2) rays[i].direction = first.direction;
  }
  return rays;
}

Case draw_case(Rng& rng, const Plan& plan) {
  Case c;
  const Vec target = attack::on_grid(attack::draw_place(rng));
  RayD first =
      !plan.exact && rng.coin() ? draw_exact_ray(rng, target) : draw_ray(rng, plan, target);
  const auto count = rng.coin() ? bvh::kWidth : rng.between(1, bvh::kWidth);
  double tau = 0;
  Vec through = target;
  for (int i = 0; i < count; ++i) {
    const Vec point = i == 0 ? target : draw_point(rng, first);
    TriangleD t = rng.coin() ? draw_box_corner(rng, plan, first, point)
                             : draw_touched(rng, plan, first, point);
    if (!plan.exact && rng.one_in(4)) round_edge_badly(rng, i == 0, first, t);
    c.triangles.push_back(t);
    if (i == 0) tau = place_of(first, t);
  }
  if (!(std::fabs(tau) <= 4)) tau = 0, through = first.origin;
  c.rays = draw_bundle(rng, plan, first, through, tau);
  for (RayD& ray : c.rays) {
    if (rng.one_in(4)) end_near(rng, tau, ray);
  }
  if (rng.one_in(3)) {
    const int k = rng.between(1, 26);
    std::vector<TriangleD> none;
    for (RayD& ray : c.rays) attack::make_smaller(k, ray, &ray == &c.rays[0] ? c.triangles : none);
  }
  c.lines.reserve(c.rays.size());
  for (const RayD& ray : c.rays) {
    c.lines.emplace_back(ray);
    std::vector<Pair>& pairs = c.pairs.emplace_back();
    pairs.reserve(c.triangles.size());
    std::uint32_t hit = 0;
    for (const TriangleD& t : c.triangles) {
      pairs.emplace_back(c.lines.back(), t);
      hit |= (pairs.back().hit() ? 1U : 0U) << (pairs.size() - 1);
    }
    c.hit.push_back(hit);
  }
  return c;
}

}  // namespace

std::string attack_block(Rng& rng, Counts& counts) {
  const Plan plan = draw_plan(rng);
  const Case c = draw_case(rng, plan);
  const attack::Corners corners(c.triangles);
  const bvh::Tree tree =
      tree_over(c.triangles, corners, rng.one_in(4) ? bvh::Layout::Compact : bvh::Layout::Full);
  bool exact = plan.exact;
  for (const TriangleD& t : c.triangles) exact = exact && attack::is_float(t);
  const bool tight = rng.coin();
  std::vector<space::FilterRay> rays;
  for (const RayD& ray : c.rays) {
    rays.push_back(attack::filter_ray(ray, exact));
    if (tight) set_tight_range(ray, rays.back());
  }
  counts.in_blocks += c.rays.size() * c.triangles.size();
  for (const std::uint32_t hit : c.hit) {
    counts.hit_in_blocks += static_cast<std::uint64_t>(std::popcount(hit));
  }
  for (const kernels::Kernel* kernel : kernels::kernels()) {
    Trial trial{*kernel, tree, c, rays, std::vector<std::uint32_t>(kMostRays, kNone)};
    const char* error = trial.untrue();
    if (error == nullptr) error = trial.lost();
    if (error == nullptr) continue;
    return std::string(kernel->name) + ": " + error + "\n" +
           text_of(c.rays[trial.wrong_ray], c.triangles);
  }
  return {};
}

}  // namespace pierce::siege
