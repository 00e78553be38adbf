// SPDX-License-Identifier: Apache-2.0
//
// The parts of a mesh file, each as a mesh of its own: what divides a file in each format, which
// triangles and vertices a part gets, and that all parts together are the file.
#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

std::vector<NamedMesh> parts(const std::string& text, const std::string& name) {
  return split_parts(read_mesh_bytes(text, name));
}

std::vector<std::string> names(const std::vector<NamedMesh>& parts) {
  std::vector<std::string> names;
  for (const NamedMesh& part : parts) names.push_back(part.name);
  return names;
}

using Names = std::vector<std::string>;
using Triangles = std::vector<Triangle>;
using Vertices = std::vector<Vec3<double>>;

const std::string kFour = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(IoParts, objects_of_an_obj_get_the_vertices_that_they_use_in_order) {
  const auto two = parts("o left\n" + kFour + "f 1 2 4\no right\nv 5 5 5\nf 5 4 3\n", "m.obj");
  ASSERT_EQ(names(two), (Names{"left", "right"}));
  EXPECT_EQ(two[0].mesh.vertices, (Vertices{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(two[0].mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(two[1].mesh.vertices, (Vertices{{1, 1, 0}, {0, 1, 0}, {5, 5, 5}}));
  EXPECT_EQ(two[1].mesh.triangles, (Triangles{{2, 1, 0}}));
  EXPECT_EQ(two[1].mesh.format, "OBJ");
}

TEST(IoParts, faces_of_one_group_belong_together_wherever_they_stand) {
  const auto mixed = parts(
      kFour + "g a\nf 1 2 3 4\ng b\nf 1 2 3\ng c\ng a\nf 4 3 2\nusemtl x\nf 1 3 4\n", "m.obj");
  ASSERT_EQ(names(mixed), (Names{"a", "b"}));  // c has no face
  EXPECT_EQ(mixed[0].mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}, {0, 2, 3}}));
  EXPECT_EQ(mixed[1].mesh.triangles, (Triangles{{0, 1, 2}}));
}

TEST(IoParts, names_of_objects_and_groups_are_put_together) {
  const std::string face = "f 1 2 3\n";
  EXPECT_EQ(names(parts(kFour + face + "g wheel  rear\n" + face + "o car\n" + face + "g\n" + face +
                            "o\n" + face,
                        "m.obj")),
            (Names{"", "wheel rear", "car/wheel rear", "car"}));
}

TEST(IoParts, a_file_that_names_no_parts_is_one) {
  const auto obj = parts(kFour + "v 9 9 9\nf 1 2 3\nf 1 3 4\n", "m.obj");
  ASSERT_EQ(names(obj), (Names{""}));
  EXPECT_EQ(obj[0].mesh.triangles.size(), 2u);
  const auto off = parts("OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n9 9 9\n3 0 1 2\n", "m.off");
  ASSERT_EQ(names(off), (Names{""}));
  EXPECT_EQ(off[0].mesh.vertices.size(), 4u);  // as it stands in the file
  EXPECT_EQ(parts("OFF\n0 0 0\n", "m.off").size(), 1u);
}

TEST(IoParts, every_solid_of_an_ascii_stl_is_a_part) {
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\n";
  const auto solids =
      parts("solid lid of a box\n" + facet + "endsolid lid\nsolid\n" + facet + facet +
                "endsolid\nsolid empty\nendsolid\nsolid\n" + facet + "endsolid",
            "m.stl");
  ASSERT_EQ(names(solids), (Names{"lid of a box", "", ""}));
  EXPECT_EQ(solids[1].mesh.triangles, (Triangles{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(solids[2].mesh.vertices.size(), 3u);
  const auto one_line = parts("solid a " + replaced(facet, '\n', " ") + "endsolid a", "m.stl");
  EXPECT_EQ(names(one_line), (Names{"a"}));
}

TEST(IoParts, attributes_and_precision_stay_with_their_vertices) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty float "
      "s\nproperty float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 1 0.5 0 255 0 0\n1 0 0 0 1 0 0 0.5 0 255 0\n0 1 0 1 0 0 0 0 0 0 255\n3 0 1 2\n";
  Mesh mesh = read_mesh_bytes(ply, "m.ply");
  mesh.triangles = {{0, 1, 0}, {2, 1, 2}};
  mesh.part_names = {"a", "b"};
  mesh.part_runs = {{0, 0}, {1, 1}};
  const auto two = split_parts(mesh);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[1].mesh.triangles, (Triangles{{1, 0, 1}}));
  EXPECT_EQ(two[1].mesh.normals, (std::vector<Vec3<float>>{{0, 1, 0}, {1, 0, 0}}));
  EXPECT_EQ(two[1].mesh.colors, (std::vector<Vec3<float>>{{0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(two[1].mesh.texcoords, (std::vector<std::array<float, 2>>{{0, 0.5f}, {0, 0}}));
  EXPECT_TRUE(two[1].mesh.single_precision);
}

}  // namespace
}  // namespace pierce::io
