// SPDX-License-Identifier: Apache-2.0
//
// Polygons of files: whatever their shape, their triangles cover them once and nothing else.
#include <algorithm>
#include <cmath>
#include <random>

#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

struct Point {
  std::int64_t x, y;
};
using Outline = std::vector<Point>;

std::int64_t area_of(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The outline in the plane of two axes, the third coordinate their sum or constant.
std::string off_of(const Outline& outline, int plane, bool tilted) {
  std::string text = std::string("OFF\n").append(std::to_string(outline.size())).append(" 1 0\n");
  for (const Point& p : outline) {
    std::array<std::int64_t, 3> q{};
    q[static_cast<std::size_t>(plane)] = p.x;
    q[static_cast<std::size_t>(plane + 1) % 3] = p.y;
    q[static_cast<std::size_t>(plane + 2) % 3] = tilted ? p.x : 7;
    for (const std::int64_t x : q) text += std::to_string(x) + " ";
    text += "\n";
  }
  text += std::to_string(outline.size());
  for (std::size_t i = 0; i < outline.size(); ++i) text.append(" ").append(std::to_string(i));
  return text + "\n";
}

void check(const Outline& outline, const Mesh& mesh) {
  ASSERT_EQ(mesh.triangles.size(), outline.size() - 2);
  std::int64_t whole = 0, sum = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    whole += area_of(outline[0], outline[i], outline[i + 1]);
  }
  ASSERT_NE(whole, 0);
  for (const Triangle& t : mesh.triangles) {
    const std::int64_t area = area_of(outline[t[0]], outline[t[1]], outline[t[2]]);
    EXPECT_GE(whole > 0 ? area : -area, 0);
    sum += area;
  }
  EXPECT_EQ(sum, whole);
}

// From every corner, both ways, in all planes.
void check_all(Outline outline) {
  for (int way = 0; way < 2; ++way) {
    for (std::size_t start = 0; start < outline.size(); ++start) {
      for (int plane = 0; plane < 3; ++plane) {
        for (const bool tilted : {false, true}) {
          const Mesh mesh = read_mesh_bytes(off_of(outline, plane, tilted), "m.off");
          check(outline, mesh);
          EXPECT_EQ(mesh.polygons.all, outline.size() > 3 ? 1u : 0u);
          EXPECT_EQ(mesh.polygons.not_flat, 0u);
          EXPECT_TRUE(mesh.warnings.empty());
        }
      }
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
    std::reverse(outline.begin(), outline.end());
  }
}

TEST(IoPolygons, concave_polygons_are_covered_once) {
  check_all({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}});  // a notch
  check_all({{0, 0}, {4, 0}, {1, 1}, {0, 4}});          // an arrow
  check_all({{0, 0}, {6, 0}, {6, 6}, {4, 6}, {4, 2}, {2, 2}, {2, 6}, {0, 6}});
  check_all({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {3, 1}, {2, 1}, {1, 1}, {0, 4}});  // straight corners
  check_all({{0, 0},
             {9, 0},
             {9, 9},
             {2, 9},
             {2, 4},
             {6, 4},
             {6, 6},
             {4, 6},
             {4, 7},
             {7, 7},
             {7, 2},
             {1, 2},
             {1, 9},
             {0, 9}});                                          // a spiral
  check_all({{0, 0}, {4, 0}, {8, 0}, {4, 0}, {4, 4}, {0, 4}});  // out and back along one line
  check_all({{0, 0}, {4, 0}, {4, 4}, {8, 4}, {8, 8}, {4, 8}, {4, 4}, {0, 4}});  // a waist
  // A hole: the border goes in and out along one line.
  check_all({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}});
}

TEST(IoPolygons, random_stars_and_combs_are_covered_once) {
  std::mt19937_64 random(1);
  const auto below = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
  for (int round = 0; round < 300; ++round) {
    Outline outline;
    const int corners = 4 + static_cast<int>(below(20));
    for (int i = 0; i < corners; ++i) {  // seen whole from the middle
      const double angle = 6.283185307179586 * i / corners;
      const auto radius = static_cast<double>(1000 + below(100000));
      outline.push_back(
          {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    for (int plane = 0; plane < 3; ++plane) {
      check(outline, read_mesh_bytes(off_of(outline, plane, round % 2 == 0), "m.off"));
    }
    Outline comb = {{0, 0}, {2 * corners, 0}};
    for (int i = 2 * corners; i > 0; --i) comb.push_back({i - 1, i % 2 == 0 ? 1 : 1 + below(9)});
    check(comb, read_mesh_bytes(off_of(comb, round % 3, false), "m.off"));
  }
}

// Coast lines and contours: what is tried for each corner must not be all the others.
TEST(IoPolygons, tens_of_thousands_of_corners) {
  constexpr int kHalf = 20000;
  Outline star, spiral;
  for (int i = 0; i < 2 * kHalf; ++i) {
    const double angle = 6.283185307179586 * i / (2 * kHalf);
    const double radius = i % 2 == 0 ? 1e6 : 1e8;
    star.push_back(
        {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    const double turned = 0.02 * (i < kHalf ? i : 2 * kHalf - 1 - i);
    const double away = 1e5 * (turned + (i < kHalf ? 1.2 : 1));
    spiral.push_back(
        {std::llround(away * std::cos(turned)), std::llround(away * std::sin(turned))});
  }
  for (const Outline& outline : {star, spiral}) {
    const Mesh mesh = read_mesh_bytes(off_of(outline, 0, false), "m.off");
    check(outline, mesh);
    EXPECT_TRUE(mesh.warnings.empty());
  }
}

// Whether an ear reaches over the side, or along it: not all of its corners may be in the way.
TEST(IoPolygons, straight_sides_of_many_corners) {
  constexpr int kSide = 100000, kHalf = kSide / 2, kQuarter = kSide / 4;
  Outline one, two, four;
  for (int i = kSide; i >= 0; --i) one.push_back({i, i});
  one.insert(one.end(), {{0, 2 * kSide}, {kHalf, kSide}, {kSide, 2 * kSide}});
  for (int i = 0; i <= kHalf; ++i) two.push_back({i, 0});
  for (int i = kHalf; i >= 0; --i) two.push_back({i, i == kQuarter ? 1 : 3});
  for (int i = 1; i < kQuarter; ++i) four.push_back({i, 0});
  for (int i = 0; i < kQuarter; ++i) four.push_back({kQuarter, i});
  for (int i = kQuarter; i > 0; --i) four.push_back({i, kQuarter});
  for (int i = kQuarter; i > 0; --i) four.push_back({0, i});
  four.push_back({1, 1});
  for (const Outline& outline : {one, two, four}) {
    const Mesh mesh = read_mesh_bytes(off_of(outline, 0, false), "m.off");
    check(outline, mesh);
    EXPECT_EQ(mesh.polygons.refanned, 1u);
    EXPECT_TRUE(mesh.warnings.empty());
  }
}

TEST(IoPolygons, what_a_fan_is_right_for_stays_a_fan) {
  const Mesh convex =
      read_mesh_bytes(off_of({{0, 0}, {4, 0}, {5, 3}, {2, 5}, {-1, 3}}, 0, false), "m");
  EXPECT_EQ(convex.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(convex.polygons.refanned, 0u);
  const Mesh arrow = read_mesh_bytes(off_of({{1, 1}, {0, 4}, {0, 0}, {4, 0}}, 0, false), "m");
  EXPECT_EQ(arrow.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  const Mesh turned = read_mesh_bytes(off_of({{0, 4}, {0, 0}, {4, 0}, {1, 1}}, 0, false), "m");
  EXPECT_EQ(turned.polygons.refanned, 1u);
}

// One ulp decides, which side of the line the corner lies on.
TEST(IoPolygons, decisions_are_exact) {
  for (const bool notch : {true, false}) {
    const std::string corner = notch ? "0.49999999999999994" : "0.5000000000000001";
    const Mesh mesh =
        read_mesh_bytes("v 0 0 0\nv 1 0 0\nv " + corner + " 0.5 0\nv 0 1 0\nf 2 3 4 1\n", "m.obj");
    EXPECT_EQ(mesh.polygons.refanned, notch ? 1u : 0u);
    EXPECT_EQ(mesh.triangles[0], notch ? (Triangle{0, 1, 2}) : (Triangle{1, 2, 3}));
  }
}

TEST(IoPolygons, every_format_and_vertices_that_come_later) {
  check({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}},
        read_mesh_bytes("f 1 2 3 4 5\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\n", "m.obj"));
  const std::string ply =
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 5\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "5 0 1 2 3 4\n0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n";
  check({{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}, read_mesh_bytes(ply, "m.ply"));
}

TEST(IoPolygons, others_are_counted) {
  const Mesh bent =
      read_mesh_bytes("v 0 0 0\nv 1 0 0\nv 1 1 1e-300\nv 0 1 0\nf 1 2 3 4\n", "m.obj");
  EXPECT_EQ(bent.polygons.not_flat, 1u);
  EXPECT_EQ(bent.polygons.refanned, 0u);
  const Mesh crossed = read_mesh_bytes("v 0 0 0\nv 4 0 0\nv 0 3 0\nv 4 2 0\nf 1 2 3 4\n", "m.obj");
  EXPECT_EQ(crossed.warnings.size(), 1u);
  EXPECT_EQ(crossed.triangles.size(), 2u);
  const Mesh knot =
      read_mesh_bytes("v 0 0 0\nv 6 0 0\nv 6 4 0\nv 2 -2 0\nv 1 5 0\nf 1 2 3 4 5\n", "m.obj");
  EXPECT_EQ(knot.warnings.size(), 1u);
  EXPECT_EQ(knot.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(knot.polygons.refanned, 0u);
  for (const char* lost : {"nan 0 0", "inf 0 0", "0 0 0"}) {  // no shape at all
    const std::string v = std::string("v ").append(lost).append("\n");
    EXPECT_EQ(read_mesh_bytes(v + v + v + v + "f 1 2 3 4\n", "m.obj").triangles.size(), 2u);
  }
}

// Some seconds a thousand corners if every ear asks exactly about every corner.
TEST(IoPolygons, large_concave_polygons_take_no_time) {
  constexpr int kCorners = 6000;
  Outline outline;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 6.283185307179586 * i / kCorners, radius = i % 2 == 0 ? 1e8 : 2e8;
    outline.push_back(
        {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
  }
  check(outline, read_mesh_bytes(off_of(outline, 0, true), "m.off"));
}

}  // namespace
}  // namespace pierce::io
