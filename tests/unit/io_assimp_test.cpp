// SPDX-License-Identifier: Apache-2.0
//
// What comes through Assimp: polygons fanned, nothing merged, one line for what it cannot read.
#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

constexpr double kTenth = static_cast<double>(0.1f);

// A square in a node at z = 5.
std::string collada(const std::string& asset) {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 1 1 0 0 0.1 0</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount>
<p>2 3 0 1</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 5</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST(IoAssimp, units_and_axes_of_dae_are_applied_and_told) {
  const TempFolder folder;
  const auto format = [&](const std::string& asset, const Vec3<double>& corner) {
    const Mesh mesh = read_mesh(folder.write("m.dae", collada(asset)));
    EXPECT_EQ(mesh.vertices[mesh.triangles[1][2]], corner) << asset;  // the file's is (1, 0, 5)
    return mesh.format;
  };
  const std::string told = "dae, by Assimp, brought to metres with y up";
  EXPECT_EQ(format("<unit meter=\"1\"/><up_axis>Y_UP</up_axis>", {1, 0, 5}), "dae, by Assimp");
  EXPECT_EQ(format("<unit meter=\"1\"/><up_axis>Z_UP</up_axis>", {1, 5, 0}), told);
  EXPECT_EQ(format("<unit meter=\"0.5\"/><up_axis>Y_UP</up_axis>", {0.5, 0, 2.5}), told);
}

TEST(IoAssimp, polygons_of_dae_are_fanned_from_their_first_corner) {
  const TempFolder folder;
  const Mesh mesh = read_mesh(folder.write("m.dae", collada("<up_axis>Y_UP</up_axis>")));
  ASSERT_EQ(mesh.triangles.size(), 2u);
  const auto corner = [&](std::size_t triangle, std::size_t k) {
    return mesh.vertices[mesh.triangles[triangle][k]];
  };
  EXPECT_FALSE(mesh.single_precision);  // Assimp has rounded the numbers of the text
  EXPECT_EQ(corner(0, 0), (Vec3<double>{1, 1, 5}));
  EXPECT_EQ(corner(0, 1), (Vec3<double>{0, kTenth, 5}));
  EXPECT_EQ(corner(0, 2), (Vec3<double>{0, 0, 5}));
  EXPECT_EQ(corner(1, 0), (Vec3<double>{1, 1, 5}));
  EXPECT_EQ(corner(1, 2), (Vec3<double>{1, 0, 5}));
}

// The outside stays outside, and so do normals.
TEST(IoAssimp, mirrored_parts_with_colours) {
  const TempFolder folder;
  const auto source = [](const std::string& id, const std::string& names, const char* numbers) {
    std::string text = "<source id=\"" + id + "\"><float_array id=\"" + id + "a\" count=\"9\">" +
                       numbers + "</float_array><technique_common><accessor source=\"#" + id +
                       "a\" count=\"3\" stride=\"3\">";
    for (const char name : names) {
      text += std::string("<param name=\"") + name + "\" type=\"float\"/>";
    }
    return text + "</accessor></technique_common></source>";
  };
  const Mesh mesh = read_mesh(folder.write("m.dae",
                                           R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>)" + source("p", "XYZ", "0 0 0 1 0 0 0 1 0") +
                                               source("n", "XYZ", "0 0 1 0 0 1 0.6 0 0.8") +
                                               source("c", "RGB", "1 0 0 0 1 0 0 0 1") + R"(
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="NORMAL" source="#n" offset="0"/><input semantic="COLOR" source="#c" offset="0"/>
<p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><scale>-2 1 1</scale>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)"));
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[1], (Vec3<double>{-2, 0, 0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}}));
  EXPECT_EQ(mesh.colors, (std::vector<Vec3<float>>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  ASSERT_EQ(mesh.normals.size(), 3u);
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 2}));
  EXPECT_EQ(mesh.normals[2], (Vec3<float>{-0.6f, 0, 2 * 0.8f}));
}

TEST(IoAssimp, a_broken_file_is_told_in_one_line) {
  const TempFolder folder;
  for (const std::filesystem::path& path :
       {folder.write("m.3ds", "x"), folder.write("m.fbx", "rubbish"),
        folder.write("m.dae", "<COLLADA>"), folder.write("notes.txt", "a text\nof two lines\n")}) {
    const std::string message = error_of([&] { (void)read_mesh(path); });
    EXPECT_NE(message.find(path.string() + ": is no mesh file that can be read ("),
              std::string::npos)
        << message;
  }
}

TEST(IoAssimp, the_3ds_models_of_glmark2_are_read) {
  const std::filesystem::path folder = "/usr/share/glmark2/models";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs the package glmark2-data";
  const Mesh cube = read_mesh(folder / "cube.3ds");
  EXPECT_EQ(cube.triangles.size(), 12u);
  EXPECT_TRUE(cube.single_precision);
  // The file says (1, 0.99999994, -1); its z axis points up, Assimp's y axis does.
  EXPECT_EQ(cube.vertices[0], (Vec3<double>{1, -1, -0x0.ffffffp0}));
  EXPECT_EQ(read_mesh(folder / "horse.3ds").triangles.size(), 7172u);
  EXPECT_EQ(read_mesh(folder / "cat.3ds").triangles.size(), 14348u);
  EXPECT_EQ(read_mesh(folder / "asteroid-high.3ds").triangles.size(), 48000u);
}

}  // namespace
}  // namespace pierce::io
