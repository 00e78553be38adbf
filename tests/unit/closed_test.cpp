// SPDX-License-Identifier: Apache-2.0
//
// The closedness test on meshes whose edges can be counted by hand.
#include "pierce/closed.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

namespace pierce {
namespace {

struct Mesh {
  std::vector<Vec3<float>> vertices;
  std::vector<Triangle> triangles;

  [[nodiscard]] Closedness test(SameVertex same = SameVertex::Index) const {
    return closedness(MeshView<float>{vertices, triangles}, same);
  }
};

Mesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

// Every triangle with corners of its own, as in an STL file.
Mesh unshared(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto n = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({n, n + 1, n + 2});
  }
  return result;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
}

TEST(Closed, tetrahedron_is_closed) {
  const Closedness c = tetrahedron().test();
  EXPECT_TRUE(c.closed);
  EXPECT_TRUE(c.balanced);
  EXPECT_EQ(c.edges, 6U);
  EXPECT_FALSE(c.first_unbalanced);
  EXPECT_FALSE(c.first_crowded);
}

TEST(Closed, empty_mesh_is_closed) { EXPECT_TRUE(Mesh{}.test().closed); }

TEST(Closed, hole_is_named_by_the_first_triangle_at_its_rim) {
  Mesh mesh = tetrahedron();
  mesh.triangles.erase(mesh.triangles.begin() + 2);  // (1, 2, 3)
  const Closedness c = mesh.test();
  EXPECT_FALSE(c.closed);
  EXPECT_FALSE(c.balanced);
  EXPECT_EQ(c.open_edges, 3U);
  EXPECT_EQ(c.unbalanced_edges, 3U);
  ASSERT_TRUE(c.first_unbalanced);
  EXPECT_EQ(*c.first_unbalanced, (EdgeUse{0, 2, 1, kNone, 1, 0}));
}

TEST(Closed, triangle_wound_the_wrong_way_is_not_closed_and_has_no_open_edge) {
  Mesh mesh = tetrahedron();
  mesh.triangles[3] = {0, 2, 3};
  const Closedness c = mesh.test();
  EXPECT_FALSE(c.balanced);
  EXPECT_EQ(c.open_edges, 0U);
  EXPECT_EQ(c.unbalanced_edges, 3U);
  ASSERT_TRUE(c.first_unbalanced);
  EXPECT_EQ(*c.first_unbalanced, (EdgeUse{0, 0, 2, 3, 2, 0}));
  EXPECT_TRUE(c.even);
  EXPECT_EQ(c.odd_edges, 0U);
  EXPECT_FALSE(c.first_odd);
}

TEST(Closed, wall_inside_a_closed_mesh_makes_its_edges_odd) {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back({0.25F, 0.25F, 0.25F});
  mesh.triangles.push_back({0, 1, 4});
  const Closedness c = mesh.test();
  EXPECT_FALSE(c.even);
  EXPECT_EQ(c.odd_edges, 3U);
  EXPECT_EQ(c.open_edges, 2U);
  ASSERT_TRUE(c.first_odd);
  EXPECT_EQ(*c.first_odd, (EdgeUse{0, 1, 0, 1, 1, 2}));
}

TEST(Closed, unshared_corners_are_closed_by_position_only) {
  const Mesh mesh = unshared(tetrahedron());
  EXPECT_EQ(mesh.test().open_edges, 12U);
  EXPECT_TRUE(mesh.test(SameVertex::Position).closed);
  EXPECT_EQ(mesh.test(SameVertex::Position).edges, 6U);
}

TEST(Closed, minus_zero_is_the_same_position_as_zero) {
  Mesh mesh = unshared(tetrahedron());
  mesh.vertices[0] = {-0.0F, 0, -0.0F};
  EXPECT_TRUE(mesh.test(SameVertex::Position).closed);
}

TEST(Closed, offender_found_by_position_has_its_own_vertex_indices) {
  Mesh mesh = unshared(tetrahedron());
  mesh.triangles.pop_back();
  const Closedness c = mesh.test(SameVertex::Position);
  ASSERT_TRUE(c.first_unbalanced);
  EXPECT_EQ(*c.first_unbalanced, (EdgeUse{0, 0, 1, kNone, 1, 0}));
}

TEST(Closed, nan_position_equals_nothing_and_does_not_disturb_the_others) {
  Mesh mesh = unshared(tetrahedron());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices[4].y = nan;  // a corner of triangle 1
  const Closedness c = mesh.test(SameVertex::Position);
  // That triangle's two edges at the corner, and the two that they should have met, stay open.
  EXPECT_EQ(c.open_edges, 4U);
}

TEST(Closed, two_boxes_that_touch_along_an_edge_are_balanced_but_crowded_by_position) {
  Mesh mesh = tetrahedron();
  Mesh other = tetrahedron();
  for (Vec3<float>& v : other.vertices) v = {-v.x, -v.y, v.z};  // turned about the z axis
  append(mesh, other);
  EXPECT_TRUE(mesh.test().closed);
  const Closedness c = mesh.test(SameVertex::Position);
  EXPECT_FALSE(c.closed);
  EXPECT_TRUE(c.balanced);
  EXPECT_EQ(c.crowded_edges, 1U);
  ASSERT_TRUE(c.first_crowded);
  EXPECT_EQ(*c.first_crowded, (EdgeUse{1, 3, 0, 3, 2, 2}));
}

// The edge 0-1 of triangle 1 faces 0-4 and 4-1.
Mesh with_t_junction() {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back({0.5F, 0, 0});
  mesh.triangles[0] = {0, 2, 4};
  mesh.triangles.push_back({4, 2, 1});
  return mesh;
}

TEST(Closed, a_t_junction_is_watertight_though_its_edges_have_no_partners) {
  const Closedness c = with_t_junction().test(SameVertex::Position);
  EXPECT_FALSE(c.closed);
  EXPECT_FALSE(c.balanced);
  EXPECT_FALSE(c.even);
  EXPECT_TRUE(c.watertight);
  EXPECT_TRUE(c.watertight_even);
  EXPECT_EQ(c.open_edges, 3U);
  EXPECT_EQ(c.unbalanced_in_pieces, 3U);
  EXPECT_EQ(c.odd_in_pieces, 3U);
  EXPECT_FALSE(with_t_junction().test().watertight) << "by index";
}

TEST(Closed, a_hole_is_named_before_a_t_junction) {
  Mesh mesh = with_t_junction();
  mesh.triangles.erase(mesh.triangles.begin() + 2);
  const Closedness c = mesh.test(SameVertex::Position);
  EXPECT_FALSE(c.watertight_even);
  EXPECT_EQ(c.odd_edges, 6U);
  EXPECT_EQ(c.odd_in_pieces, 3U);
  ASSERT_TRUE(c.first_odd);
  EXPECT_EQ(*c.first_odd, (EdgeUse{1, 1, 3, kNone, 1, 0}));
  EXPECT_EQ(c.first_unbalanced, c.first_odd);
}

TEST(Closed, a_t_junction_with_a_vertex_next_to_the_line_leaks) {
  Mesh mesh = with_t_junction();
  mesh.vertices[4].y = std::numeric_limits<float>::denorm_min();
  const Closedness c = mesh.test(SameVertex::Position);
  EXPECT_FALSE(c.watertight);
  EXPECT_FALSE(c.watertight_even);
  EXPECT_EQ(c.odd_in_pieces, 0U);
}

TEST(Closed, a_t_junction_that_faces_the_wrong_way_is_even_only) {
  Mesh mesh = with_t_junction();
  for (Triangle& t : mesh.triangles) {
    if (t[0] == 0 || t[0] == 4) std::swap(t[1], t[2]);
    if (t[0] == 0) break;
  }
  const Closedness c = mesh.test(SameVertex::Position);
  EXPECT_FALSE(c.watertight);
  EXPECT_TRUE(c.watertight_even);
}

// An edge that faces two overlapping ones instead of two that meet, and one that is cut in a
// different place on either side.
TEST(Closed, edges_in_line_pair_only_if_every_piece_does) {
  const auto prism = [](std::vector<float> above, std::vector<float> below) {
    Mesh mesh;  // edges along x: those above run forward, those below back, given by their ends
    const auto add = [&](float from, float to, float y) {
      const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{from, 0, 0}, {to, 0, 0}, {9, y, 1}});
      mesh.triangles.push_back({n, n + 1, n + 2});
    };
    for (std::size_t i = 0; i + 1 < above.size(); i += 2) add(above[i], above[i + 1], 1);
    for (std::size_t i = 0; i + 1 < below.size(); i += 2) add(below[i + 1], below[i], -1);
    return mesh.test(SameVertex::Position).unbalanced_in_pieces;
  };
  EXPECT_EQ(prism({0, 4}, {0, 1, 1, 4}), 3U);
  EXPECT_EQ(prism({0, 3, 3, 4}, {0, 1, 1, 4}), 4U);
  EXPECT_EQ(prism({0, 4, 1, 3}, {0, 3, 1, 4}), 4U) << "a part that is covered twice each way";
  EXPECT_EQ(prism({0, 3, 1, 4}, {0, 4}), 0U) << "a part that is covered twice one way";
  EXPECT_EQ(prism({0, 4}, {0, 1, 2, 4}), 0U) << "a gap";
  EXPECT_EQ(prism({0, 4, 5, 6}, {0, 2, 2, 4, 5, 5.5F}), 3U) << "two sets on a line";
}

TEST(Closed, triangle_with_two_equal_corners_does_not_count) {
  Mesh mesh = tetrahedron();
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({3, 0, 3});
  EXPECT_TRUE(mesh.test().closed);
}

TEST(Closed, missing_vertex_is_an_error_that_names_the_first_triangle) {
  Mesh mesh = tetrahedron();
  mesh.triangles[1][2] = 4;
  mesh.triangles[3][0] = kNone;
  try {
    (void)mesh.test();
    FAIL() << "no error";
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::IndexOutOfRange);
    EXPECT_STREQ(e.what(),
                 "triangle 1 names a vertex that does not exist (2 such triangles; the mesh has 4 "
                 "vertices)");
  }
}

// A torus of n x n squares: large enough that several threads take part.
TEST(Closed, large_torus_is_closed_and_one_missing_triangle_is_found) {
  const std::uint32_t n = 300;
  Mesh mesh;
  mesh.vertices.resize(std::size_t{n} * n);
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * n + j;
      const std::uint32_t b = (i + 1) % n * n + j;
      const std::uint32_t c = (i + 1) % n * n + (j + 1) % n;
      const std::uint32_t d = i * n + (j + 1) % n;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  EXPECT_TRUE(mesh.test().closed);
  EXPECT_EQ(mesh.test().edges, 3ULL * n * n);
  mesh.triangles.erase(mesh.triangles.begin() + 100001);
  const Closedness c = mesh.test();
  EXPECT_EQ(c.open_edges, 3U);
  ASSERT_TRUE(c.first_unbalanced);
  EXPECT_EQ(c.first_unbalanced->triangle, 99400U);  // the square above has the edge (d, a)
}

}  // namespace
}  // namespace pierce
