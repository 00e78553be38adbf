// SPDX-License-Identifier: Apache-2.0
//
// Whatever a call is about, it ends soon after somebody asks it to: in the midst of a build, of one
// ray's list of 40,000 coincident hits, of a survey of the surface. The promise is 50 ms; half a
// second is asked here, of a machine that may be busy.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "pierce/closed.h"
#include "pierce/scene.h"
#include "pierce/voxelise.h"
#include "support/meshes.h"
#include "support/rng.h"

namespace pierce {
namespace {

using Clock = std::chrono::steady_clock;
using hard::Mesh;
using hard::Rng;

double milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

double wall_clock() { return milliseconds(Clock::now().time_since_epoch()); }
/// Processor time of all threads: the same on a busy machine.
double processor_clock() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// How long `call` took to end after it was asked to, or nothing if it was done before. With a
/// `delay` of 0 it is asked before it begins.
std::optional<double> stopped_after(double delay,
                                    const std::function<void(const WorkOptions&)>& call,
                                    double (*now)() = wall_clock) {
  std::atomic<bool> stop = delay == 0;
  std::atomic<bool> done = false;
  const double begin = now();
  double asked = begin;
  std::thread stopper([&] {
    if (delay == 0) return;
    const double started = wall_clock();
    while (!done && now() < begin + delay && wall_clock() < started + 20 * delay) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    asked = now();
    stop = true;
  });
  bool was_stopped = false;
  try {
    call({.threads = 2, .stop = &stop});
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::Stopped) << e.what();
    was_stopped = true;
  }
  const double end = now();
  done = true;
  stopper.join();
  if (!was_stopped) return std::nullopt;
  return end - asked;
}

/// Asks at several moments of the call, which is run once to its end to know how long it takes.
void expect_soon(const std::string& name, const std::function<void(const WorkOptions&)>& call) {
  const auto begin = Clock::now();
  call({.threads = 2});
  const double all = milliseconds(Clock::now() - begin);
  double longest = 0;
  int stopped = 0;
  for (const double part : {0.0, 0.2, 0.5, 0.8}) {
    const auto took = stopped_after(part * all, call);
    if (!took) continue;
    ++stopped;
    longest = std::max(longest, *took);
  }
  EXPECT_GT(stopped, 0) << name;
  EXPECT_LT(longest, 500) << name;
  if (std::getenv("PIERCE_STOP_TIMES") != nullptr) {
    std::cout << name << ": " << all << " ms, stopped " << stopped << " times, at most " << longest
              << " ms after\n";
  }
}

Mesh<float> ground(std::uint32_t n) {
  Rng rng(3, 1);
  return hard::terrain<float>(rng, n);
}

// So many copies of one triangle, and a ray through them all.
Mesh<double> coincident(std::uint32_t count) {
  Mesh<double> mesh{{{0, 0, 0.1}, {1, 0, 0.3}, {0, 1, 0.7}, {0, 2, 1.1}, {2, 0, 0.5}}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh.triangles.push_back(i % 2 == 0 ? Triangle{0, 1, 2} : Triangle{0, 3, 4});
  }
  return mesh;
}
// Both triangles lie in z = 0.1 + 0.2 x + 0.6 y up to rounding, so hits are hard to put in order.
const Ray<double> kThrough{{0.3, 0.3, -1}, {0, 0, 1}};

TEST(Stop, builds_and_refits) {
  const auto mesh = ground(300);
  for (const Quality quality :
       {Quality::Fast, Quality::Balanced, Quality::High, Quality::Compact}) {
    expect_soon("build " + std::to_string(static_cast<int>(quality)), [&](const WorkOptions& work) {
      Scene<float>::build(mesh.view(), {.quality = quality, .work = work});
    });
    auto scene = Scene<float>::build(mesh.view(), {.quality = quality});
    expect_soon("refit " + std::to_string(static_cast<int>(quality)),
                [&](const WorkOptions& work) { scene.refit(mesh.view(), work); });
  }
  const auto same = coincident(60000);
  expect_soon("build of what coincides", [&](const WorkOptions& work) {
    Scene<double>::build(same.view(), {.quality = Quality::High, .work = work});
  });
}

TEST(Stop, one_rays_long_list) {
  const auto mesh = coincident(40000);
  const auto scene = Scene<double>::build(mesh.view());
  const std::vector<Ray<double>> rays(4, kThrough);
  const std::vector<TriangleRef> after(4, TriangleRef{0, 7});
  std::vector<Hit<double>> hits(4);
  std::vector<std::uint8_t> any(4);
  std::vector<std::uint32_t> counts(4);
  std::vector<Crossings> crossings(4);
  expect_soon("closest hits",
              [&](const WorkOptions& work) { scene.closest_hits(rays, hits, {.work = work}); });
  expect_soon("closest hits after", [&](const WorkOptions& work) {
    scene.closest_hits(rays, hits, {.after = after, .work = work});
  });
  expect_soon("all hits",
              [&](const WorkOptions& work) { (void)scene.all_hits(rays, {.work = work}); });
  expect_soon("ten hits", [&](const WorkOptions& work) {
    (void)scene.all_hits(rays, {.max_hits = 10, .work = work});
  });
  expect_soon("distinct hits", [&](const WorkOptions& work) {
    (void)scene.all_hits(rays, {.distinct = true, .work = work});
  });
  expect_soon("filter", [&](const WorkOptions& work) {
    const auto none = [](std::uint64_t, const Hit<double>&) { return false; };
    scene.any_hits(rays, any, {.filter = none, .work = work});
  });
  expect_soon("count",
              [&](const WorkOptions& work) { scene.count_hits(rays, counts, {.work = work}); });
  expect_soon("crossings",
              [&](const WorkOptions& work) { scene.crossings(rays, crossings, {.work = work}); });
}

// Long enough that each stage counts: finding, sorting by number and by t, rounding, handing over.
// The lists are the same room for every kernel, so the long one is waited for once.
TEST(Stop, one_rays_list_of_a_million) {
  const bool chosen = std::getenv("PIERCE_KERNEL") != nullptr;
  const auto mesh = coincident(chosen ? 200'000 : 1'000'000);
  const auto scene = Scene<double>::build(mesh.view());
  const std::vector<Ray<double>> rays(1, kThrough);
  std::vector<Hit<double>> hits(1);
  std::vector<std::uint32_t> counts(1);
  const std::vector<Vec3<double>> points(1, {0.3, 0.3, -1});
  std::vector<Location> locations(1);
  int stopped = 0;
  const auto expect_stopped = [&](const char* name, const std::vector<double>& delays,
                                  const std::function<void(const WorkOptions&)>& call) {
    for (const double delay : delays) {  // on a quick machine it may be done before
      const auto took = stopped_after(delay, call, processor_clock);
      stopped += took ? 1 : 0;
      EXPECT_LT(took.value_or(0), 200) << name << " after " << delay << " ms";
      if (std::getenv("PIERCE_STOP_TIMES") != nullptr) {
        std::cout << name << ", asked at " << delay << " ms: stopped " << took.value_or(-1)
                  << " ms after\n";
      }
    }
  };
  expect_stopped("closest", {5},
                 [&](const WorkOptions& work) { scene.closest_hits(rays, hits, {.work = work}); });
  expect_stopped("all", {5, 150, 400, 1000, 2500},
                 [&](const WorkOptions& work) { (void)scene.all_hits(rays, {.work = work}); });
  expect_stopped("the first half", {5, 400, 1000}, [&](const WorkOptions& work) {
    (void)scene.all_hits(rays, {.max_hits = 500'000, .work = work});
  });
  expect_stopped("count", {5, 150, 300},
                 [&](const WorkOptions& work) { scene.count_hits(rays, counts, {.work = work}); });
  expect_stopped("locate", {1}, [&](const WorkOptions& work) {
    scene.locate(points, locations, {.open_mesh = true, .work = work});
  });
  EXPECT_GE(stopped, chosen ? 2 : 5);
}

TEST(Stop, arrays_that_are_copied) {
  const auto mesh = coincident(3'000'000);
  std::vector<std::int64_t> indices;
  for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const MeshArrays<double> arrays = {
      rows(mesh.vertices), Rows<const std::int64_t>{indices.data(), mesh.triangles.size(), 24}};
  const auto build = [&](const WorkOptions& work) {
    (void)Scene<double>::build(arrays, {.work = work});
  };
  const auto took = stopped_after(2, build, processor_clock);
  ASSERT_TRUE(took);
  EXPECT_LT(*took, 500);
  // Before anything else: at once, however many there are.
  std::atomic<bool> stop = true;
  EXPECT_THROW(build({.stop = &stop}), Error);
}

TEST(Stop, points_and_starts) {
  const auto mesh = coincident(10000);
  const auto scene = Scene<double>::build(mesh.view());
  const std::vector<Vec3<double>> points(40, {0.3, 0.3, -1});
  std::vector<NearestPoint<double>> nearest(40);
  std::vector<Location> locations(40);
  std::vector<double> distances(40);
  expect_soon("nearest points", [&](const WorkOptions& work) {
    scene.nearest_points(points, nearest, {.work = work});
  });
  expect_soon("signed distances", [&](const WorkOptions& work) {
    scene.signed_distances(points, distances, {.open_mesh = true, .work = work});
  });
  const auto hit = scene.closest_hit(kThrough).value();
  const std::vector<Ray<double>> rays(20, kThrough);
  const std::vector<Hit<double>> hits(20, hit);
  std::vector<std::optional<Vec3<double>>> starts(20);
  expect_soon("next origins", [&](const WorkOptions& work) {
    scene.next_origins(rays, hits, Side::Before, starts, {.work = work});
  });
}

TEST(Stop, a_survey_of_the_surface_may_be_begun_again) {
  const auto mesh = hard::icosphere<float>(8);
  const auto scene = Scene<float>::build(mesh.view());
  expect_soon("closedness", [&](const WorkOptions& work) {
    (void)closedness(mesh.view(), SameVertex::Position, work);
  });
  std::vector<Vec3<float>> points(1, {0, 0, 0});
  std::vector<Location> locations(1);
  const auto took = stopped_after(
      2, [&](const WorkOptions& work) { scene.locate(points, locations, {.work = work}); });
  EXPECT_LT(took.value_or(0), 500);
  EXPECT_EQ(scene.locate({0, 0, 0}), Location::Inside);
  const Grid<float> grid{{-1, -1, -1}, {0.01F, 0.01F, 0.01F}, {200, 200, 200}};
  std::vector<Location> cells(200 * 200 * 200);
  expect_soon("voxelise", [&](const WorkOptions& work) {
    scene.voxelise(grid, 0, 200, cells, {.work = work});
  });
}

TEST(Stop, a_refit_that_is_stopped_leaves_the_scene_as_it_was) {
  const auto mesh = ground(60);
  auto moved = mesh;
  for (auto& v : moved.vertices) v.z += 100;
  for (const Quality quality : {Quality::Balanced, Quality::Compact}) {
    auto scene = Scene<float>::build(mesh.view(), {.quality = quality});
    const Ray<float> ray{{0.3F, 0.4F, -1}, {0, 0, 1}};
    const auto before = scene.closest_hit(ray).value();
    std::atomic<bool> stop = false;
    const auto at_once = [&](double fraction) {
      if (fraction > 0) stop = true;
    };
    EXPECT_THROW(scene.refit(moved.view(), {.threads = 1, .progress = at_once, .stop = &stop}),
                 Error);
    EXPECT_EQ(scene.closest_hit(ray), before);
    struct Broken {};
    const auto fails = [&](double fraction) {
      if (fraction > 0.5) throw Broken();
    };
    EXPECT_THROW(scene.refit(moved.view(), {.threads = 1, .progress = fails}), Broken);
    EXPECT_EQ(scene.closest_hit(ray), before);
    std::vector<double> heard;
    scene.refit(moved.view(), {.progress = [&](double fraction) { heard.push_back(fraction); }});
    EXPECT_GT(scene.closest_hit(ray)->t, 100);
    ASSERT_GE(heard.size(), 2U);
    EXPECT_EQ(heard.back(), 1);
    EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  }
}

}  // namespace
}  // namespace pierce
