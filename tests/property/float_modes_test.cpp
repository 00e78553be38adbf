// SPDX-License-Identifier: Apache-2.0
//
// The caller's floating-point mode changes no answer, and no question changes the mode.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "pierce/closed.h"
#include "pierce/pierce.h"
#include "pierce/vector.h"
#include "support/float_environment.h"
#include "support/float_mode.h"
#include "support/meshes.h"
#include "support/parallel.h"
#include "support/rng.h"

namespace pierce {
namespace {

/// The bytes of answers, one after the other.
class Record {
 public:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(const T& x) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &x, sizeof(T));
    text_.append(bytes, sizeof(T));
  }
  template <class Real>
  void put(const Vec3<Real>& p) {
    put(p.x), put(p.y), put(p.z);
  }
  template <class Real>
  void put(const Hit<Real>& h) {
    put(h.t), put(h.u), put(h.v), put(h.w), put(h.geometry), put(h.triangle), put(h.facing);
  }
  template <class Real>
  void put(const NearestPoint<Real>& n) {
    put(n.point), put(n.distance), put(n.u), put(n.v), put(n.w);
    put(n.geometry), put(n.triangle), put(n.feature);
  }
  void put(const Crossings& c) { put(c.count), put(c.signed_count), put(c.origin_on_surface); }
  template <class T>
  void put(const std::optional<T>& x) {
    put(x.has_value());
    if (x) put(*x);
  }
  template <class T>
  void put(const std::vector<T>& all) {
    for (const T& x : all) put(x);
  }
  friend bool operator==(const Record&, const Record&) = default;

 private:
  std::string text_;
};

template <class Real>
struct Questions {
  hard::Mesh<Real> mesh;
  hard::Mesh<Real> moved;
  std::vector<Ray<Real>> rays;
  std::vector<Vec3<Real>> points;
  Grid<Real> grid;
  Transform<Real> transform;
  std::string name;
};

/// A ball of the size, and questions around it whose numbers are not round ones.
template <class Real>
Questions<Real> questions(double size, const char* name) {
  Questions<Real> q;
  q.name = name;
  hard::Rng rng(11, 0);
  const auto real = [&](double x) { return static_cast<Real>(size * x); };
  const auto point = [&](double most) {
    return Vec3<Real>{real(most * rng.symmetric()), real(most * rng.symmetric()),
                      real(most * rng.symmetric())};
  };
  q.mesh = hard::icosphere<Real>(2);
  for (Vec3<Real>& v : q.mesh.vertices) v = {real(v.x), real(v.y), real(v.z)};
  q.moved = q.mesh;
  for (Vec3<Real>& v : q.moved.vertices) v.x = static_cast<Real>(v.x * Real(0.75));
  // Most of what a mode may spoil is the same text for every kernel.
  const int rays = std::getenv("PIERCE_KERNEL") == nullptr ? 1500 : 400;
  for (int i = 0; i < rays; ++i) {
    Ray<Real> ray;
    ray.origin = i % 3 == 0 ? q.mesh.vertices[rng.below(q.mesh.vertices.size())] : point(2);
    const Vec3<Real> target =
        i % 2 == 0 ? q.mesh.vertices[rng.below(q.mesh.vertices.size())] : point(0.9);
    ray.direction = target - ray.origin;
    if (ray.direction == Vec3<Real>{0, 0, 0}) ray.direction.x = 1;
    q.rays.push_back(ray);
    q.points.push_back(i % 4 == 0 ? target : point(1.2));
  }
  q.grid = {point(1), {real(0.1), real(0.1), real(0.1)}, {8, 8, 8}};
  q.transform.rows[0] = {Real(0.3), Real(0.1), 0, real(0.7)};
  return q;
}

/// Everything that can be asked of a scene, one by one and in batches.
template <class Real>
Record answers(const Questions<Real>& q, unsigned threads) {
  Record record;
  BuildOptions build;
  build.work.threads = threads;
  BatchOptions batch;
  batch.work.threads = threads;
  LocateOptions locate;
  locate.work.threads = threads;
  NearestOptions<Real> near;
  near.work.threads = threads;
  for (const Quality quality : {Quality::Balanced, Quality::High, Quality::Compact}) {
    build.quality = quality;
    auto scene = Scene<Real>::build(q.mesh.view(), build);
    const auto ask = [&] {
      record.put(scene.info().sah_cost);
      std::vector<Hit<Real>> hits(q.rays.size()), list;
      scene.closest_hits(q.rays, hits, batch);
      record.put(hits);
      std::vector<std::uint8_t> any(q.rays.size());
      scene.any_hits(q.rays, any, batch);
      record.put(any);
      record.put(scene.all_hits(q.rays, batch).hits);
      std::vector<std::uint32_t> counts(q.rays.size());
      scene.count_hits(q.rays, counts, batch);
      record.put(counts);
      std::vector<Crossings> crossings(q.rays.size());
      scene.crossings(q.rays, crossings, batch);
      record.put(crossings);
      std::vector<std::optional<Vec3<Real>>> starts(q.rays.size());
      scene.next_origins(q.rays, hits, Side::Before, starts, batch);
      record.put(starts);
      std::vector<Location> locations(q.points.size());
      scene.locate(q.points, locations, locate);
      record.put(locations);
      std::vector<NearestPoint<Real>> nearest(q.points.size());
      scene.nearest_points(q.points, nearest, near);
      record.put(nearest);
      std::vector<Real> distances(q.points.size());
      scene.signed_distances(q.points, distances, locate);
      record.put(distances);
      std::vector<Location> cells(q.grid.cells());
      voxelise(scene, q.grid, std::span(cells), locate);
      record.put(cells);
      for (std::size_t i = 0; i < 200; ++i) {
        const Ray<Real>& ray = q.rays[i];
        const auto hit = scene.closest_hit(ray);
        record.put(hit);
        record.put(scene.any_hit(ray));
        scene.all_hits(ray, list);
        record.put(list);
        record.put(scene.count_hits(ray));
        record.put(scene.crossings(ray));
        if (hit) record.put(scene.next_origin(ray, *hit, Side::Beyond));
        record.put(scene.locate(q.points[i]));
        record.put(scene.nearest_point(q.points[i]));
        record.put(scene.signed_distance(q.points[i]));
      }
    };
    ask();
    scene.refit(q.moved.view(), {.threads = threads});
    ask();
  }
  Instance<Real> instance{q.mesh.view()};
  instance.transform = q.transform;
  const std::vector<Instance<Real>> instances(2, instance);
  auto placed = Scene<Real>::build(std::span<const Instance<Real>>(instances), build);
  std::vector<Hit<Real>> hits(q.rays.size());
  placed.closest_hits(q.rays, hits, batch);
  record.put(hits);
  placed.refit(std::span<const Instance<Real>>(instances), {.threads = threads});
  record.put(closedness(q.mesh.view(), SameVertex::Position).closed);
  for (std::size_t i = 0; i < 200; ++i) {
    const Triangle& t = q.mesh.triangles[i];
    record.put(
        intersect(q.rays[i], q.mesh.vertices[t[0]], q.mesh.vertices[t[1]], q.mesh.vertices[t[2]]));
    record.put(transformed(q.transform, q.points[i]));
    record.put(q.grid.centre(static_cast<std::uint32_t>(i) % 8, 1, 2));
  }
  return record;
}

template <class Real>
class FloatModes : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(FloatModes, Reals);

template <class Real>
std::vector<Questions<Real>> all_questions() {
  if (std::is_same_v<Real, float>) {
    return {questions<Real>(1, "ordinary"), questions<Real>(0x1p-130, "denormal")};
  }
  return {questions<Real>(1, "ordinary"), questions<Real>(0x1p-1040, "denormal")};
}

TYPED_TEST(FloatModes, change_no_answer_and_are_not_changed) {
  for (const Questions<TypeParam>& q : all_questions<TypeParam>()) {
    const Record expected = answers(q, 1);
    EXPECT_EQ(answers(q, 2), expected) << q.name;
    for (const hard::FloatMode& mode : hard::kFloatModes) {
      for (const unsigned threads : {1U, 2U}) {
        Record got;
        EXPECT_TRUE(hard::in_mode(mode, [&] { got = answers(q, threads); })) << mode.name;
        EXPECT_EQ(got, expected) << q.name << ", " << mode.name << ", " << threads << " threads";
      }
    }
  }
}

TYPED_TEST(FloatModes, are_restored_when_a_call_throws) {
  const auto mesh = hard::icosphere<TypeParam>(1);
  const auto scene = Scene<TypeParam>::build(mesh.view());
  const Ray<TypeParam> bad{};
  for (const hard::FloatMode& mode : hard::kFloatModes) {
    EXPECT_TRUE(hard::in_mode(mode, [&] { EXPECT_THROW((void)scene.closest_hit(bad), Error); }))
        << mode.name;
  }
}

// oneTBB's threads have the mode of whoever came first; here that is flush-to-zero.
TEST(FloatModes, of_workers_are_the_default_while_they_work) {
  for (const hard::FloatMode& mode : hard::kFloatModes) {
    const std::uint64_t normal = hard::float_control();
    std::atomic<int> others = 0;
    EXPECT_TRUE(hard::in_mode(mode, [&] {
      const FloatEnvironment environment;
      parallel::with_threads(4, [&] {
        parallel::for_each(0, 200, [&](int) { others += hard::float_control() != normal; });
      });
    })) << mode.name;
    EXPECT_EQ(others, 0) << mode.name;
  }
}

}  // namespace
}  // namespace pierce
