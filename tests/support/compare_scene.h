// SPDX-License-Identifier: Apache-2.0
//
// All queries of a Scene against the brute-force oracle, bit by bit, in single and batch form.
// The first difference comes back as text, shrunk and ready to be pasted into a regression test,
// and is kept (save_failure.h).
#pragma once

#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/brute_force.h"
#include "support/hard_rays.h"
#include "support/save_failure.h"
#include "support/show.h"
#include "support/shrink.h"

namespace pierce::show {

template <class Real>
std::string text(std::span<const Hit<Real>> hits) {
  std::string all;
  for (const auto& hit : hits) all += joined("\n    ", text(hit));
  return all.empty() ? " none" : all;
}

template <class Real>
std::string text(const hard::Mesh<Real>& mesh) {
  std::ostringstream all;
  all << "vertices {";
  for (const auto& v : mesh.vertices) all << text(v) << ", ";
  all << "}\ntriangles {";
  for (const auto& [a, b, c] : mesh.triangles) all << "{" << a << ", " << b << ", " << c << "}, ";
  all << "}";
  return all.str();
}

template <class Real>
bool same_bits(std::span<const Hit<Real>> x, std::span<const Hit<Real>> y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Hit<Real>& p, const Hit<Real>& q) { return same_bits(p, q); });
}

}  // namespace pierce::show

namespace pierce::oracle {

/// What the scene says about one ray, without options, if it differs from what is true.
template <class Real>
std::optional<std::string> difference_on_one_ray(const Scene<Real>& scene,
                                                 const BruteForce<Real>& truth,
                                                 const Ray<Real>& ray) {
  const auto expected = truth.all_hits(ray);
  const Hit<Real> first = expected.empty() ? Hit<Real>{} : expected.front();
  const auto hits_text = show::joined("\n  true hits:", show::text<Real>(expected));
  if (const auto hit = scene.closest_hit(ray).value_or(Hit<Real>{}); !show::same_bits(hit, first)) {
    return show::joined("closest_hit: ", show::text(hit), hits_text);
  }
  if (scene.any_hit(ray) == expected.empty()) return show::joined("any_hit", hits_text);
  std::vector<Hit<Real>> all = {first};  // must be replaced
  scene.all_hits(ray, all);
  if (!show::same_bits<Real>(all, expected)) {
    return show::joined("all_hits:", show::text<Real>(all), hits_text);
  }
  return std::nullopt;
}

/// The batch queries with the given options; `expected[i]` are all true hits of ray i under them.
template <class Real>
std::optional<std::string> difference_on_batch(const Scene<Real>& scene,
                                               std::span<const Ray<Real>> rays,
                                               const std::vector<std::vector<Hit<Real>>>& expected,
                                               const BatchOptions& options) {
  const auto differs = [&](const std::string& query, std::size_t i) {
    std::string skipped;
    if (!options.skip.empty()) {
      skipped = show::joined(" skip ", options.skip[i].geometry, ':', options.skip[i].triangle);
    }
    return show::joined(query, " of ray ", i, ' ', show::text(rays[i]),
                        options.range == Range::Closed ? "" : " OpenStart", skipped, " threads ",
                        options.work.threads, "\n  true hits:", show::text<Real>(expected[i]));
  };
  std::vector<Hit<Real>> closest(rays.size(), Hit<Real>{7, 7, 7, 7, 7, 7, Facing::Back});
  scene.closest_hits(rays, closest, options);
  std::vector<std::uint8_t> any(rays.size(), 7);
  scene.any_hits(rays, any, options);
  const HitLists<Real> all = scene.all_hits(rays, options);
  if (all.offsets.size() != rays.size() + 1) return "all_hits: wrong number of offsets";
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit<Real> first = expected[i].empty() ? Hit<Real>{} : expected[i].front();
    if (!show::same_bits(closest[i], first)) {
      return differs(show::joined("closest_hits: ", show::text(closest[i])), i);
    }
    if (any[i] != (expected[i].empty() ? 0 : 1)) return differs("any_hits", i);
    if (!show::same_bits<Real>(all.of(i), expected[i])) {
      return differs(show::joined("all_hits:", show::text<Real>(all.of(i))), i);
    }
  }
  return std::nullopt;
}

/// All queries of one mesh; if one differs, the shrunk mesh and ray as text.
template <class Real>
std::optional<std::string> difference(const hard::Mesh<Real>& mesh,
                                      const std::vector<hard::AimedRay<Real>>& aimed,
                                      const BuildOptions& options = {}) {
  const auto scene = Scene<Real>::build(mesh.view(), options);
  const BruteForce<Real> truth(mesh.view());
  const auto on_one = [&](const hard::Mesh<Real>& m, const Ray<Real>& r) {
    return difference_on_one_ray(Scene<Real>::build(m.view(), options), BruteForce<Real>(m.view()),
                                 r);
  };
  std::vector<Ray<Real>> rays;
  std::vector<TriangleRef> skip;
  std::vector<std::vector<Hit<Real>>> plain, open, skipping;
  for (const auto& [ray, range, triangle] : aimed) {
    if (difference_on_one_ray(scene, truth, ray)) {
      hard::Mesh<Real> small = mesh;
      Ray<Real> r = ray;
      hard::shrink(small, r,
                   [&](const auto& m, const auto& s) { return on_one(m, s).has_value(); });
      return show::joined(*on_one(small, r), '\n',
                          hard::saved(show::joined(show::text(r), '\n', show::text(small))));
    }
    rays.push_back(ray);
    plain.push_back(truth.all_hits(ray));
    open.push_back(truth.all_hits(ray, Range::OpenStart));
    skip.push_back(range == Range::Closed ? TriangleRef{0, triangle} : TriangleRef{});
    skipping.push_back(truth.all_hits(ray, Range::OpenStart, skip.back()));
  }
  for (const unsigned threads : {1u, 2u}) {
    BatchOptions batch{.work = {.threads = threads}};
    auto d = difference_on_batch<Real>(scene, rays, plain, batch);
    batch.range = Range::OpenStart;
    if (!d) d = difference_on_batch<Real>(scene, rays, open, batch);
    batch.skip = skip;
    if (!d) d = difference_on_batch<Real>(scene, rays, skipping, batch);
    if (d) return hard::saved(show::joined(*d, '\n', show::text(mesh)));
  }
  return std::nullopt;
}

}  // namespace pierce::oracle
