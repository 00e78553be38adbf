// SPDX-License-Identifier: Apache-2.0
//
// Rays from inside closed meshes, and who loses them.
#include "suite/failures.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "contenders/contender.h"
#include "contenders/hit_counts.h"
#include "pierce/closed.h"
#include "pierce/error.h"
#include "pierce/scene.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

// Every vertex in use, and the middle of every edge, both rounded to float.
std::vector<Double3> targets(const Mesh& mesh) {
  std::vector<std::uint64_t> edges;
  std::vector<bool> used(mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangle[k];
      const std::uint32_t b = triangle[(k + 1) % 3];
      used[a] = true;
      edges.push_back((std::uint64_t{std::min(a, b)} << 32) | std::max(a, b));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Double3> points;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) points.push_back(to_double(mesh.vertices[i]));
  for (const std::uint64_t edge : edges) {
    const Double3 a = to_double(mesh.vertices[edge >> 32]);
    const Double3 b = to_double(mesh.vertices[edge & 0xffffffffU]);
    points.push_back(to_double(to_float(0.5 * (a + b))));
  }
  return points;
}

// Points of the mesh's box from which three rays in random directions all hit an odd number of
// triangles; the odds of an outside point are nil.
std::vector<Vec3<float>> points_inside(const Mesh& mesh, const Scene<float>& scene,
                                       std::size_t count) {
  Prng random(0x1d51de);
  std::vector<Vec3<float>> points;
  std::vector<Hit<float>> hits;
  while (points.size() < count) {
    const Vec3<float> point = to_float({random.between(mesh.box.lower.x, mesh.box.upper.x),
                                        random.between(mesh.box.lower.y, mesh.box.upper.y),
                                        random.between(mesh.box.lower.z, mesh.box.upper.z)});
    bool inside = true;
    for (int direction = 0; direction < 3 && inside; ++direction) {
      scene.all_hits({point, to_float(random.on_sphere())}, hits);
      inside = hits.size() % 2 == 1;
    }
    if (inside) points.push_back(point);
  }
  return points;
}

RaySet rays_from_inside(const Mesh& mesh, const Scene<float>& scene, std::size_t origins) {
  RaySet set{"from inside", {}, {}};
  const std::vector<Double3> points = targets(mesh);
  for (const Vec3<float>& origin : points_inside(mesh, scene, origins)) {
    for (const Double3& target : points)
      set.rays.push_back({origin, to_float(target - to_double(origin))});
  }
  for (const Ray<float>& ray : set.rays)
    set.rays_double.push_back({to_double(ray.origin), to_double(ray.direction)});
  return set;
}

std::uint64_t misses(const Answers& answers) {
  const auto lost = [](const auto& hit) { return hit.triangle == kNone; };
  return static_cast<std::uint64_t>(
      std::count_if(answers.hits.begin(), answers.hits.end(), lost) +
      std::count_if(answers.hits_double.begin(), answers.hits_double.end(), lost));
}

std::string misses_text(const Mesh& mesh, const RaySet& set) {
  std::string text;
  for (const ContenderKind& kind : contender_kinds()) {
    if (!kind.by_default) continue;
    const Field field = make_field({kind.name});
    Contender& contender = *field.contenders.front();
    contender.engine().build(mesh, 0);
    Answers answers;
    contender.prepare(set, Query::Closest, 1);
    contender.run();
    contender.collect(answers);
    text += fmt::format("  {:<24}{:>9} of {:>9} rays get out\n", kind.name, misses(answers),
                        set.rays.size());
  }
  return text;
}

// Passages through the surface, each counted once.
HitCounts pierce_crossing_counts(const Scene<float>& scene, std::span<const Ray<float>> rays) {
  HitCounts result;
  result.counts.reserve(rays.size());
  const auto begin = std::chrono::steady_clock::now();
  for (const Ray<float>& ray : rays) result.counts.push_back(scene.crossings(ray).count);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

std::string parity_text(const char* name, const HitCounts& asked) {
  const auto even = std::count_if(asked.counts.begin(), asked.counts.end(),
                                  [](std::uint32_t n) { return n % 2 == 0; });
  const auto rays = static_cast<double>(asked.counts.size());
  return fmt::format("  {:<24}{:>9} of {:>9} rays have an even count; {:>5.0f} ns a ray\n", name,
                     even, asked.counts.size(), asked.seconds / rays * 1e9);
}

std::string parities_text(const Mesh& mesh, const Scene<float>& scene, const RaySet& set) {
  std::string text = parity_text("pierce crossings", pierce_crossing_counts(scene, set.rays));
#ifdef PIERCE_BENCH_EMBREE
  text += parity_text("embree all hits", embree_hit_counts(mesh, set.rays, false));
  text += parity_text("embree-robust all hits", embree_hit_counts(mesh, set.rays, true));
#else
  (void)mesh;
#endif
  return text;
}

std::string failures_of(const Mesh& mesh, std::size_t origins) {
  const Closedness found = closedness(mesh.mesh_view(), SameVertex::Position);
  if (!found.closed) return fmt::format("{}: not closed, left out\n", mesh.name);
  const auto scene = Scene<float>::build(mesh.mesh_view());
  const RaySet set = rays_from_inside(mesh, scene, origins);
  return fmt::format("{}: {} triangles, closed; {} rays from {} points inside\n{}{}", mesh.name,
                     mesh.triangles.size(), set.rays.size(), origins, misses_text(mesh, set),
                     parities_text(mesh, scene, set));
}

}  // namespace

std::string failures_text() {
  std::string text = "rays from inside a closed mesh through its vertices and edge midpoints:\n";
  text += failures_of(make_icosphere(4), 16);
  text += failures_of(make_mesh("bunny"), 4);
  return text;
}

}  // namespace pierce::bench
