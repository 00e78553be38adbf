// SPDX-License-Identifier: Apache-2.0
//
// Comparison of answers: bit by bit among pierce's own, counted for the others.
#include "suite/compare.h"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>

#include "pierce/scene.h"

namespace pierce::bench {
namespace {

bool same_bits(const Hit<float>& a, const Hit<float>& b) {
  return std::memcmp(&a.t, &b.t, sizeof a.t) == 0 && std::memcmp(&a.u, &b.u, sizeof a.u) == 0 &&
         std::memcmp(&a.v, &b.v, sizeof a.v) == 0 && std::memcmp(&a.w, &b.w, sizeof a.w) == 0 &&
         a.geometry == b.geometry && a.triangle == b.triangle && a.facing == b.facing;
}

// A double correctly rounded from x rounds on to the float nearest x, unless it lies exactly
// between two floats: then x itself decided, and either of the two may be right.
bool rounds_to(double x, float expected) {
  const auto rounded = static_cast<float>(x);
  if (rounded == expected) return true;
  return x - static_cast<double>(rounded) == static_cast<double>(expected) - x;
}

bool same_decisions(const Hit<float>& a, const Hit<double>& b) {
  return a.geometry == b.geometry && a.triangle == b.triangle && a.facing == b.facing &&
         rounds_to(b.t, a.t) && rounds_to(b.u, a.u) && rounds_to(b.v, a.v) && rounds_to(b.w, a.w);
}

// The contender chose another triangle: is it as near as the reference's?
bool is_tie(const Mesh& mesh, const Ray<float>& ray, const Hit<float>& best,
            std::uint32_t triangle) {
  if (triangle >= mesh.triangles.size()) return false;
  const auto& [a, b, c] = mesh.triangles[triangle];
  const std::array<Vec3<float>, 3> corners{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
  const std::array<Triangle, 1> single{Triangle{0, 1, 2}};
  BuildOptions options;
  options.work.threads = 1;
  const auto scene = Scene<float>::build(MeshView<float>{corners, single}, options);
  const auto hit = scene.closest_hit(ray);
  return hit && hit->t == best.t;
}

[[noreturn]] void fail(const Mesh& mesh, const RaySet& set, Query query, const Contender& contender,
                       std::size_t ray, std::uint64_t count) {
  const Ray<float>& r = set.rays[ray];
  throw std::runtime_error(fmt::format(
      "{} differs from the reference on {} of the rays {} / {} / {}; the first is ray {}: origin "
      "{:a} {:a} {:a}, direction {:a} {:a} {:a}, t {:a} to {:a}",
      contender.name(), count, mesh.name, set.name, name_of(query), ray, r.origin.x, r.origin.y,
      r.origin.z, r.direction.x, r.direction.y, r.direction.z, r.t_min, r.t_max));
}

// Whether an own contender's answer to one ray is what it must be.
bool own_agrees(Query query, Kind kind, const Answers& reference, const Answers& answers,
                std::size_t i) {
  if (query == Query::Any) return reference.any[i] == answers.any[i];
  if (kind == Kind::Exact) return same_bits(reference.hits[i], answers.hits[i]);
  return same_decisions(reference.hits[i], answers.hits_double[i]);
}

void count_one(const Mesh& mesh, const Ray<float>& ray, const Hit<float>& expected,
               const Hit<float>& found, Differences& differences) {
  if (expected.triangle == found.triangle) return;
  if (found.triangle == kNone) {
    ++differences.missed;
  } else if (expected.triangle == kNone) {
    ++differences.invented;
  } else if (is_tie(mesh, ray, expected, found.triangle)) {
    ++differences.tied;
  } else {
    ++differences.other_triangle;
  }
}

}  // namespace

Differences compare_answers(const Mesh& mesh, const RaySet& set, Query query,
                            const Answers& reference, const Contender& contender,
                            const Answers& answers) {
  Differences differences;
  differences.compared =
      std::max({answers.hits.size(), answers.hits_double.size(), answers.any.size()});
  if (contender.kind() != Kind::Other) {
    std::uint64_t count = 0;
    std::size_t first = 0;
    for (std::size_t i = differences.compared; i-- > 0;) {
      if (own_agrees(query, contender.kind(), reference, answers, i)) continue;
      ++count;
      first = i;
    }
    if (count > 0) fail(mesh, set, query, contender, first, count);
    return differences;
  }
  for (std::size_t i = 0; i < differences.compared; ++i) {
    const std::size_t place = thinned_place(i, differences.compared, set.rays.size());
    if (query == Query::Closest) {
      count_one(mesh, set.rays[place], reference.hits[place], answers.hits[i], differences);
    } else if (reference.any[place] != answers.any[i]) {
      ++(answers.any[i] == 0 ? differences.missed : differences.invented);
    }
  }
  return differences;
}

}  // namespace pierce::bench
