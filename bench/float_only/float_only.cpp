// SPDX-License-Identifier: Apache-2.0
//
// Here `pierce` is pierce_float_only; see float_only.h.
#include "float_only/float_only.h"

#include <vector>

#include "contenders/scene_loops.h"
#include "pierce/scene.h"

namespace float_only {

struct Caster::Parts {
  std::vector<pierce::Vec3<float>> vertices;
  std::vector<pierce::Triangle> triangles;
  std::vector<pierce::Ray<float>> rays;
  pierce::Scene<float> scene;
  pierce::bench::Asked<float> asked;
};

namespace {

std::vector<pierce::Vec3<float>> copied_vertices(const float* p, std::size_t count) {
  std::vector<pierce::Vec3<float>> vertices;
  vertices.reserve(count);
  for (std::size_t i = 0; i < 3 * count; i += 3) vertices.push_back({p[i], p[i + 1], p[i + 2]});
  return vertices;
}

std::vector<pierce::Triangle> copied_triangles(const std::uint32_t* t, std::size_t count) {
  std::vector<pierce::Triangle> triangles;
  triangles.reserve(count);
  for (std::size_t i = 0; i < 3 * count; i += 3) triangles.push_back({t[i], t[i + 1], t[i + 2]});
  return triangles;
}

pierce::Scene<float> built(const std::vector<pierce::Vec3<float>>& vertices,
                           const std::vector<pierce::Triangle>& triangles, unsigned threads) {
  pierce::BuildOptions options;
  options.threads = threads;
  return pierce::Scene<float>::build(pierce::MeshView<float>{vertices, triangles}, options);
}

}  // namespace

Caster::Caster(const float* vertices, std::size_t vertex_count, const std::uint32_t* triangles,
               std::size_t triangle_count, unsigned threads) {
  auto v = copied_vertices(vertices, vertex_count);
  auto t = copied_triangles(triangles, triangle_count);
  auto scene = built(v, t, threads);  // views what the vectors hold, wherever these are moved
  parts_ = std::make_unique<Parts>(Parts{std::move(v), std::move(t), {}, std::move(scene), {}});
}

Caster::~Caster() = default;

std::uint64_t Caster::bytes() const { return parts_->scene.info().bytes; }
double Caster::sah_cost() const { return parts_->scene.info().sah_cost; }

void Caster::take_rays(const float* rays, std::size_t count, bool closest) {
  parts_->rays.clear();
  parts_->rays.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float* r = rays + 8 * i;
    parts_->rays.push_back({{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, r[6], r[7]});
  }
  parts_->asked.start(parts_->rays, closest);
}

void Caster::run(bool batch, unsigned threads) {
  if (!batch) return ask_one_by_one(parts_->scene, threads, parts_->asked);
  pierce::BatchOptions options;
  options.threads = threads;
  ask_together(parts_->scene, options, parts_->asked);
}

FoundHit Caster::hit(std::size_t ray) const {
  const pierce::Hit<float>& h = parts_->asked.hits[ray];
  return {h.t, h.u, h.v, h.w, h.geometry, h.triangle, h.facing == pierce::Facing::Back};
}

bool Caster::any(std::size_t ray) const { return parts_->asked.any[ray] != 0; }

}  // namespace float_only
