// SPDX-License-Identifier: Apache-2.0
//
// STL: text in any layout, binary of any title, and never one taken for the other.
#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

Mesh read(const std::string& bytes) { return read_mesh_bytes(bytes, "m.stl"); }
std::string error(const std::string& bytes) {
  return error_of([&] { (void)read(bytes); });
}

std::string binary(std::string title, std::uint32_t announced, int triangles) {
  title.resize(80, ' ');
  std::string out = title + little(announced);
  for (int i = 0; i < triangles; ++i) {
    const auto x = static_cast<float>(i);
    out += little(0.0f, 0.0f, 1.0f) + little(x, 0.1f, 0.0f) + little(x, 1.0f, 0.0f) +
           little(x, 0.0f, 1e-42f) + little(std::uint16_t{7});
  }
  return out;
}

const std::string kFacet =
    "facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 0.1 0 0\n  vertex 0 1e-3 0\n"
    " endloop\nendfacet\n";

TEST(IoStl, binary_has_three_vertices_of_its_own_for_each_triangle) {
  const Mesh mesh = read(binary("made by hand", 2, 2));
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{0, static_cast<double>(0.1f), 0}));
  EXPECT_EQ(mesh.vertices[3].x, 1);
  EXPECT_EQ(mesh.vertices[5].z, static_cast<double>(1e-42f));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_TRUE(mesh.single_precision);
  EXPECT_EQ(mesh.format, "STL, binary");
}

TEST(IoStl, a_binary_file_may_start_with_solid) {
  EXPECT_EQ(read(binary("solid facet normal", 1, 1)).format, "STL, binary");
  EXPECT_EQ(read(binary("solid", 0, 0)).triangles.size(), 0u);
}

TEST(IoStl, text_numbers_are_nearest_doubles) {
  const Mesh mesh = read("solid thing of mine\n" + kFacet + "endsolid thing of mine\n");
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3<double>>{{0, 0, 0}, {0.1, 0, 0}, {0, 1e-3, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_FALSE(mesh.single_precision);
  EXPECT_EQ(mesh.format, "STL, ascii");
}

TEST(IoStl, several_solids_are_one_mesh) {
  const Mesh mesh = read("solid a\n" + kFacet + kFacet + "endsolid a\n\nsolid\n" + kFacet +
                         "endsolid\nsolid c\nendsolid c");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
}

TEST(IoStl, layout_and_case_of_text_do_not_matter) {
  const std::string lines =
      "solid a b\n" + kFacet + "endsolid a\nsolid solid\n" + kFacet + "endsolid solid\n";
  for (const char* end : {"\r\n", "\r", "\n\n\t ", " "}) {
    EXPECT_EQ(read(replaced(lines, '\n', end)).triangles.size(), 2u);
  }
  std::string upper;
  for (const char c : lines)
    upper += c >= 'a' && c <= 'z' && c != 'e' ? static_cast<char>(c - 32) : c;
  EXPECT_EQ(read(upper).triangles.size(), 2u);
}

TEST(IoStl, a_title_may_be_any_words) {
  for (const char* title :
       {"solid solid", "solid facet", "solid endsolids", "solid normal facet"}) {
    EXPECT_EQ(read(std::string(title) + "\n" + kFacet + "endsolid\n").triangles.size(), 1u);
  }
}

TEST(IoStl, normals_are_not_read_so_they_may_be_anything) {
  const std::string rest = "outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet ";
  for (const char* normal : {"0 0 0", "-nan(ind) -nan(ind) -nan(ind)", "1,0 0,0 0,0", "x y z"}) {
    std::string text = "solid\nfacet normal ";
    text += normal;
    text += '\n';
    EXPECT_EQ(read(text + rest + "endsolid").triangles.size(), 1u);
  }
}

TEST(IoStl, polygons_are_fanned) {
  const Mesh mesh = read(
      "solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 "
      "vertex 1 1 0 vertex 0 1 0 endloop endfacet endsolid");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(IoStl, broken_text_is_told_by_line) {
  EXPECT_EQ(error("solid x\n" + kFacet + "fcet normal 0 0 1\n"),
            "m.stl:9: expected 'facet', found 'fcet': correct it");
  EXPECT_EQ(error("solid x\n" + kFacet),
            "m.stl:9: the file ends before 'facet': it was cut off, or add a line 'endsolid'");
  EXPECT_EQ(error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2\nvertex"),
            "m.stl:5: expected a coordinate, found 'vertex': correct it");
  EXPECT_EQ(error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 1 2 3\nendloop\nendfacet\n"),
            "m.stl:5: a facet with 1 corner: a triangle has 3");
  EXPECT_EQ(error("solid x\nfacet normal\nouter loop\n"),
            "m.stl:3: expected the normal's 3 numbers, found 'outer': write any");
  EXPECT_EQ(error("solid x\nendsolid\nrubbish"),
            "m.stl:3: expected 'solid', found 'rubbish': correct it");
}

TEST(IoStl, broken_binary_is_told) {
  EXPECT_EQ(error(binary("x", 3, 2)),
            "m.stl: byte 80: the header announces 3 triangles, 234 bytes, but the file has 184: it "
            "was cut off or changed, get it again");
  EXPECT_EQ(
      error(binary("solid", 4294967294u, 1)),
      "m.stl: byte 80: the header announces 4,294,967,294 triangles, 214,748,364,784 bytes, but "
      "the file has 134: it was cut off or changed, get it again");
  EXPECT_EQ(error("junk"),
            "m.stl: byte 4: the file ends in the header of a binary STL: it was cut off");
}

}  // namespace
}  // namespace pierce::io
