// SPDX-License-Identifier: Apache-2.0
//
// OBJ: every form of vertices and faces, exactly; and the same faces as tinyobjloader reads, which
// we do not use because of its numbers.
#include <cmath>
#include <random>

#include "io/read_mesh.h"
#include "support/io_files.h"

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

namespace pierce::io {
namespace {

Mesh read(const std::string& text) { return read_mesh_bytes(text, "m.obj"); }
std::string error(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(IoObj, numbers_are_nearest_doubles) {
  const Mesh mesh = read("v 0.1 2.2250738585072011e-308 9007199254740993\nv nan inf -inf\n");
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{0.1, 0x0.fffffffffffffp-1022, 9007199254740992.0}));
  EXPECT_TRUE(std::isnan(mesh.vertices[1].x));
  EXPECT_FALSE(mesh.single_precision);
  EXPECT_EQ(mesh.format, "OBJ");
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(IoObj, corners_may_have_texture_coordinates_and_normals) {
  const std::string extra = "vt 0.5 0.25\nvt 1\nvt 0 1 0\nvn 0 0 1\nvn 1 0 0\n";
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//1 3//2", "f 1/1/1 2/2/1 3/3/2", "f 1/ 2/ 3/",
        "f 1// 2// 3//", "fo 1 2 3", "f\t1  2 3 # a comment", "f 1 2 \\\n 3", "  f 1 2 3\r\n"}) {
    EXPECT_EQ(read(kFour + extra + face).triangles, (std::vector<Triangle>{{0, 1, 2}})) << face;
  }
  const Mesh mesh = read(kFour + extra + "f 1/1/1 2/2/1 3/3/2\nf 1/3/2 3//1 4\n");
  // the first attribute that a corner names stays; vertices without one have zeros
  EXPECT_EQ(mesh.texcoords,
            (std::vector<std::array<float, 2>>{{0.5f, 0.25f}, {1, 0}, {0, 1}, {0, 0}}));
  EXPECT_EQ(mesh.normals, (std::vector<Vec3<float>>{{0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 0, 0}}));
  EXPECT_TRUE(read(kFour + extra + "f 1 2 3").normals.empty());
}

TEST(IoObj, negative_indices_count_back_from_the_last_vertex_so_far) {
  const Mesh mesh = read(kFour + "f -4 -3 -2\nv 5 5 5\nf -1 -2 1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {4, 3, 0}}));
  const Mesh both = read(kFour + "vt 1 1\nvn 0 1 0\nf -4/-1/-1 2/-1/-1 3/1/1");
  EXPECT_EQ(both.texcoords[0], (std::array<float, 2>{1, 1}));
  EXPECT_EQ(both.normals[2], (Vec3<float>{0, 1, 0}));
}

TEST(IoObj, polygons_are_fanned_and_less_than_triangles_are_none) {
  EXPECT_EQ(read(kFour + "f 4 3 2 1\nf 1\nf 1 2\nf\nf 1 2 3\n").triangles,
            (std::vector<Triangle>{{3, 2, 1}, {3, 1, 0}, {0, 1, 2}}));
}

TEST(IoObj, faces_may_come_before_their_vertices) {
  EXPECT_EQ(read("f 1 2 3\n" + kFour).triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(IoObj, all_other_statements_are_stepped_over) {
  const Mesh mesh =
      read("# C:\\folder\\\nmtllib a.mtl\no name\ng a \\\nb c\nusemtl steel\ns off\n" + kFour +
           "vp 1 2\np 1\nl 1 2 3\ncurv 0 1 1 2\nend\nf 1 2 3\nvendor x\n");
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(IoObj, vertices_may_have_weights_or_colors) {
  const Mesh mesh = read("v 1 2 3 0.5\nv 1 2 3 1 0 0.5\nv 1 2 3 0 1 0 1\nv 4 5 6\n");
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(mesh.colors, (std::vector<Vec3<float>>{{1, 1, 1}, {1, 0, 0.5f}, {0, 1, 0}, {1, 1, 1}}));
  EXPECT_EQ(read("v 1 2 3 255 0 51\n").colors, (std::vector<Vec3<float>>{{1, 0, 0.2f}}));
}

TEST(IoObj, broken_statements_are_told_by_line) {
  EXPECT_EQ(error("v 1 2\n"),
            "m.obj:1: expected the vertex's z, found the end of the line: complete the line");
  EXPECT_EQ(error("v 1 2,5 3\n"),
            "m.obj:1: expected the vertex's y, found '2,5': write it with a decimal point");
  EXPECT_EQ(error("v 1 1e400 3\n"), "m.obj:1: '1e400' does not fit a double: scale the data");
  EXPECT_EQ(error(kFour + "f 1 2 x\n"), "m.obj:5: expected an index, found 'x': correct it");
  EXPECT_EQ(error(kFour + "f 1 2 3.5\n"),
            "m.obj:5: expected an index, found '.' behind 3: correct it");
  EXPECT_EQ(error(kFour + "f 1 2 3/1/1/1\n"), "m.obj:5: expected an index, found '/1': correct it");
  EXPECT_EQ(error(kFour + "f 0 1 2\n"),
            "m.obj:5: index 0 names nothing, the first is 1: correct it");
  EXPECT_EQ(error(kFour + "f 1 2 -5\n"),
            "m.obj:5: index -5 names no vertex, there are 4: correct it");
  EXPECT_EQ(error(kFour + "f 1 2 3\nf 1 2 5\nf 1 9 2\n"),
            "m.obj:7: index 9 names no vertex, there are 4: correct it");
  EXPECT_EQ(error(kFour + "f 1 2 99999999999\n"),
            "m.obj:5: index 99999999999 names no vertex, there are 4: correct it");
  EXPECT_EQ(error(kFour + "f 1 2 99999999999999999999\n"),
            "m.obj:5: expected an index, found '99999999999999999999': correct it");
}

TEST(IoObj, the_bunny_has_the_faces_that_tinyobjloader_reads) {
  const std::filesystem::path path = "/usr/share/glmark2/models/bunny.obj";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "needs the package glmark2-data";
  const Mesh mesh = read_mesh(path);
  tinyobj::ObjReaderConfig config;
  config.triangulate = false;
  tinyobj::ObjReader peer;
  ASSERT_TRUE(peer.ParseFromFile(path.string(), config));
  std::vector<Triangle> triangles;
  for (const tinyobj::shape_t& shape : peer.GetShapes()) {
    for (std::size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
      const auto at = [&](std::size_t k) {
        return static_cast<std::uint32_t>(shape.mesh.indices[i + k].vertex_index);
      };
      triangles.push_back({at(0), at(1), at(2)});
    }
  }
  EXPECT_EQ(mesh.vertices.size(), 34835u);
  EXPECT_EQ(mesh.triangles, triangles);
  EXPECT_EQ(mesh.triangles.size(), 69666u);
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{0.296502, -0.907931, 0.450151}));
}

// The reason for a reader of our own, docs/decisions/0006-mesh-readers.md.
TEST(IoObj, tinyobjloader_reads_many_numbers_beside_the_nearest_double) {
  std::mt19937_64 random(1);
  std::string text;
  constexpr int kVertices = 5000;
  for (int i = 0; i < kVertices; ++i) {
    std::array<char, 200> line;
    const auto number = [&] { return static_cast<double>(random()) / 0x1p60 - 8; };
    std::snprintf(line.data(), line.size(), "v %.17g %.17g %.17g\n", number(), number(), number());
    text += line.data();
  }
  tinyobj::ObjReader peer;
  ASSERT_TRUE(peer.ParseFromString(text, ""));
  const Mesh mesh = read(text);
  int different = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3<double>& p = mesh.vertices[i];
    const double* q = &peer.GetAttrib().vertices[3 * i];
    different += (p.x != q[0]) + (p.y != q[1]) + (p.z != q[2]);
  }
  EXPECT_GT(different, 0);
  RecordProperty("different_of_15000", different);
  std::printf("%d of %d numbers differ\n", different, 3 * kVertices);
}

}  // namespace
}  // namespace pierce::io
