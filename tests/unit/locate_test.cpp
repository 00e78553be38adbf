// SPDX-License-Identifier: Apache-2.0
//
// locate from the caller's side: what is refused and how, rules, several meshes, threads.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include "pierce/scene.h"
#include "support/meshes.h"

namespace pierce {
namespace {

using hard::Mesh;

Mesh<double> tetrahedron(double size = 1, double shift = 0) {
  Mesh<double> mesh;
  for (const Vec3<double>& v : {Vec3<double>{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}}) {
    mesh.add({v.x + shift, v.y + shift, v.z + shift});
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

void turn(Mesh<double>& mesh) {
  for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
}

template <class Call>
std::string message(ErrorCode expected, const Call& call) {
  try {
    call();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), expected) << e.what();
    return e.what();
  }
  return "no error";
}

constexpr Vec3<double> kMiddle{0.125, 0.125, 0.125};

TEST(Locate, open_surface_is_refused_with_its_first_open_edge) {
  auto mesh = tetrahedron();
  mesh.triangles.pop_back();
  const auto scene = Scene<double>::build(mesh.view());
  const std::string expected =
      "the surface is not closed: edge 0-2 of triangle 0 belongs to no other triangle (the first "
      "of 3 such edges); close it, or go on regardless with the open-mesh option";
  EXPECT_EQ(message(ErrorCode::NotClosed, [&] { (void)scene.locate(kMiddle); }), expected);
  std::vector<Location> out(1, Location::OnSurface);
  const std::vector<Vec3<double>> points(1, kMiddle);
  EXPECT_EQ(message(ErrorCode::NotClosed, [&] { scene.locate(points, out); }), expected);
  EXPECT_EQ(out[0], Location::OnSurface) << "a refused batch has done nothing";
  EXPECT_EQ(scene.locate(kMiddle, {.open_mesh = true}), Location::Inside);
}

TEST(Locate, triangle_that_faces_the_wrong_way_is_refused_by_the_winding_rule_only) {
  auto mesh = tetrahedron();
  std::swap(mesh.triangles[1][1], mesh.triangles[1][2]);
  const auto scene = Scene<double>::build(mesh.view());
  EXPECT_EQ(scene.locate(kMiddle), Location::Inside);
  EXPECT_EQ(message(ErrorCode::NotClosed,
                    [&] { (void)scene.locate(kMiddle, {.rule = InsideRule::NonZero}); }),
            "the triangles do not all face the same way: edge 1-0 of triangle 0 is used 2 times "
            "that way and 0 times the other way (also by triangle 1) (the first of 3 such edges); "
            "turn them, or take the rule Odd, or go on regardless with the open-mesh option");
}

TEST(Locate, all_geometries_together_must_be_closed) {
  const auto whole = tetrahedron();
  Mesh<double> half = whole, rest = tetrahedron();
  half.triangles.resize(2);
  rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + 2);
  rest.vertices.insert(rest.vertices.begin(), {7, 7, 7});  // other numbers for the same places
  for (Triangle& t : rest.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
  const std::vector<MeshView<double>> both{half.view(), rest.view()};
  EXPECT_EQ(Scene<double>::build(both).locate(kMiddle), Location::Inside);

  rest.triangles.pop_back();
  const auto far = tetrahedron(8, 16);
  const std::vector<MeshView<double>> three{far.view(), half.view(), rest.view()};
  const auto scene = Scene<double>::build(three);
  EXPECT_EQ(message(ErrorCode::NotClosed, [&] { (void)scene.locate(kMiddle); }),
            "the surface is not closed: edge 0-2 of triangle 0 of geometry 1 belongs to no other "
            "triangle (the first of 3 such edges); close it, or go on regardless with the "
            "open-mesh option");
}

TEST(Locate, rules_differ_where_solids_overlap_and_in_cavities) {
  const auto outer = tetrahedron(8);
  const auto inner = tetrahedron(1, 1);
  auto cavity = inner;
  turn(cavity);
  const auto location = [](const Mesh<double>& a, const Mesh<double>& b, InsideRule rule) {
    const std::vector<MeshView<double>> both{a.view(), b.view()};
    return Scene<double>::build(both).locate({1.125, 1.125, 1.125}, {.rule = rule});
  };
  EXPECT_EQ(location(outer, inner, InsideRule::Odd), Location::Outside);
  EXPECT_EQ(location(outer, inner, InsideRule::NonZero), Location::Inside);
  EXPECT_EQ(location(outer, cavity, InsideRule::Odd), Location::Outside);
  EXPECT_EQ(location(outer, cavity, InsideRule::NonZero), Location::Outside);
}

TEST(Locate, a_closed_surface_that_faces_inward_has_the_same_inside) {
  auto mesh = tetrahedron();
  turn(mesh);
  const auto scene = Scene<double>::build(mesh.view());
  for (const InsideRule rule : {InsideRule::Odd, InsideRule::NonZero}) {
    EXPECT_EQ(scene.locate(kMiddle, {.rule = rule}), Location::Inside);
    EXPECT_EQ(scene.locate({1, 1, 1}, {.rule = rule}), Location::Outside);
  }
}

TEST(Locate, a_triangle_without_area_is_surface_all_the_same) {
  auto mesh = tetrahedron();
  const auto a = mesh.add({2, 2, 2}), b = mesh.add({4, 2, 2});
  mesh.triangles.push_back({a, b, a});
  const auto scene = Scene<double>::build(mesh.view());
  EXPECT_EQ(scene.locate({3, 2, 2}), Location::OnSurface);
  EXPECT_EQ(scene.locate({5, 2, 2}), Location::Outside);
}

TEST(Locate, everything_is_outside_of_an_empty_scene) {
  const auto scene = Scene<float>::build(MeshView<float>{});
  EXPECT_EQ(scene.locate({0, 0, 0}), Location::Outside);
  const std::vector<MeshView<float>> none;
  EXPECT_EQ(Scene<float>::build(none).locate({1, 2, 3}), Location::Outside);
}

TEST(Locate, bad_points_and_sizes_are_named) {
  const auto mesh = tetrahedron();
  const auto scene = Scene<double>::build(mesh.view());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message(ErrorCode::InvalidPoint,
                    [&] {
                      (void)scene.locate({0, nan, 0});
                    }),
            "bad point: it is not finite; give finite coordinates");
  std::vector<Vec3<double>> points(5, kMiddle);
  points[3].z = kInfinity<double>;
  points[4].x = nan;
  std::vector<Location> out(5);
  EXPECT_EQ(message(ErrorCode::InvalidPoint, [&] { scene.locate(points, out); }),
            "bad point 3 (the first of 2): it is not finite; give finite coordinates");
  out.pop_back();
  EXPECT_EQ(message(ErrorCode::SizeMismatch, [&] { scene.locate(points, out); }),
            "there are 5 points but room for 4 results; make the spans equally long");
}

TEST(Locate, the_first_call_may_come_from_many_threads_at_once) {
  const auto mesh = hard::icosphere<float>(4);
  const auto scene = Scene<float>::build(mesh.view());
  std::atomic<int> inside = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] { inside += scene.locate({0, 0, 0}) == Location::Inside ? 1 : 0; });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(inside, 8);
}

TEST(Locate, batches_report_progress_count_and_stop) {
  const auto mesh = tetrahedron();
  const auto scene = Scene<double>::build(mesh.view());
  const std::vector<Vec3<double>> points(3'000'000, kMiddle);
  std::vector<Location> out(points.size());
  Statistics statistics;
  double last = 0;
  LocateOptions options{.work = {.threads = 2, .statistics = &statistics}};
  options.work.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  scene.locate(points, out, options);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(statistics.rays, points.size());
  EXPECT_GT(statistics.leaves, 0U);

  std::atomic<bool> stop = false;
  options.work.stop = &stop;
  options.work.progress = [&](double) { stop = true; };
  EXPECT_EQ(message(ErrorCode::Stopped, [&] { scene.locate(points, out, options); }),
            "stopped by the caller");
}

}  // namespace
}  // namespace pierce
