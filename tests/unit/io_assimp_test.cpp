// SPDX-License-Identifier: Apache-2.0
//
// What comes through Assimp: node transforms in double, in depth-first order; polygons fanned,
// points and lines left out; nothing merged.
#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (unsigned k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? kDigits[block >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

std::string triangle_data() {
  return little(0.1f, 0.0f, 0.0f) + little(1.0f, 0.0f, 0.0f) + little(0.0f, 1.0f, 0.0f) +
         little(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2});
}
std::string in_text() {
  return R"("uri":"data:application/octet-stream;base64,)" + base64(triangle_data()) + R"(",)";
}

// One triangle (0.1 0 0) (1 0 0) (0 1 0), also as points and as lines, under the given nodes.
std::string gltf(const std::string& nodes, const std::string& roots,
                 const std::string& source = in_text()) {
  std::string out = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":)";
  out += roots + R"(}],"nodes":)" + nodes + R"(,"meshes":[
        {"primitives":[{"attributes":{"POSITION":0},"indices":1}]},
        {"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":0},
                       {"attributes":{"POSITION":0},"indices":1,"mode":3}]}],
      "buffers":[{)";
  return out + source + R"("byteLength":42}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},
                     {"buffer":0,"byteOffset":36,"byteLength":6}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                    "min":[0,0,0],"max":[1,1,0]},
                   {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}]})";
}

constexpr double kTenth = static_cast<double>(0.1f);

TEST(IoAssimp, gltf_gives_its_floats_exactly) {
  const TempFolder folder;
  const Mesh mesh = read_mesh(folder.write("m.gltf", gltf(R"([{"mesh":0}])", "[0]")));
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3<double>>{{kTenth, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.format, "gltf, by Assimp");
  EXPECT_TRUE(mesh.single_precision);
}

TEST(IoAssimp, vertices_are_floats_unless_a_transform_makes_others_of_them) {
  const TempFolder folder;
  const auto single = [&](const std::string& node) {
    return read_mesh(folder.write("m.gltf", gltf("[{\"mesh\":0," + node + "}]", "[0]")))
        .single_precision;
  };
  EXPECT_TRUE(single(R"("scale":[-2,0.5,1])"));
  EXPECT_TRUE(single(R"("translation":[0,1,0])"));
  EXPECT_FALSE(single(R"("scale":[0.1,1,1])"));
  EXPECT_FALSE(single(R"("translation":[0.3,0,0])"));
}

TEST(IoAssimp, node_transforms_are_applied_in_depth_first_order) {
  const TempFolder folder;
  const std::string nodes = R"([
      {"mesh":0,"translation":[0,0,1],"children":[1,2]},
      {"mesh":0,"translation":[0,0,10],"scale":[2,2,2]},
      {"mesh":0,"translation":[0,0,100]},
      {"mesh":0,"translation":[0,0,1000]}])";
  const Mesh mesh = read_mesh(folder.write("m.gltf", gltf(nodes, "[0,3]")));
  ASSERT_EQ(mesh.vertices.size(), 12u);
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{kTenth, 0, 1}));
  EXPECT_EQ(mesh.vertices[3], (Vec3<double>{2 * kTenth, 0, 11}));
  EXPECT_EQ(mesh.vertices[6], (Vec3<double>{kTenth, 0, 101}));
  EXPECT_EQ(mesh.vertices[9], (Vec3<double>{kTenth, 0, 1000}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}}));
}

TEST(IoAssimp, transforms_are_multiplied_in_double) {
  const TempFolder folder;
  const Mesh mesh = read_mesh(folder.write(
      "m.gltf",
      gltf(R"([{"scale":[0.1,1,1],"children":[1]},{"mesh":0,"scale":[0.1,1,1]}])", "[0]")));
  EXPECT_EQ(mesh.vertices[1].x, kTenth * kTenth);
}

TEST(IoAssimp, a_mirrored_part_keeps_its_outside) {
  const TempFolder folder;
  const Mesh mesh =
      read_mesh(folder.write("m.gltf", gltf(R"([{"mesh":0,"scale":[1,1,-1]}])", "[0]")));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}}));
}

TEST(IoAssimp, points_and_lines_make_no_triangles) {
  const TempFolder folder;
  const Mesh mesh = read_mesh(folder.write("m.gltf", gltf(R"([{"mesh":1},{"mesh":0}])", "[0,1]")));
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.vertices[mesh.triangles[0][0]], (Vec3<double>{kTenth, 0, 0}));
  EXPECT_TRUE(read_mesh(folder.write("n.gltf", gltf(R"([{"mesh":1}])", "[0]"))).triangles.empty());
}

TEST(IoAssimp, glb_is_read) {
  const TempFolder folder;
  std::string json = gltf(R"([{"mesh":0}])", "[0]", "");
  json.append((4 - json.size() % 4) % 4, ' ');
  const std::string data = triangle_data() + std::string(2, '\0');
  const auto json_bytes = static_cast<std::uint32_t>(json.size());
  const auto data_bytes = static_cast<std::uint32_t>(data.size());
  std::string glb = "glTF";
  glb += little(2u, 28 + json_bytes + data_bytes, json_bytes) + "JSON" + json;
  glb += little(data_bytes) + std::string("BIN\0", 4) + data;
  const Mesh mesh = read_mesh(folder.write("m.glb", glb));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{kTenth, 0, 0}));
}

TEST(IoAssimp, polygons_of_dae_are_fanned_from_their_first_corner) {
  const TempFolder folder;
  const Mesh mesh = read_mesh(folder.write("m.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="12">0 0 0 1 0 0 1 1 0 0 0.1 0</float_array>
<technique_common><accessor source="#a" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount>
<p>2 3 0 1</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 5</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)"));
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

TEST(IoAssimp, every_node_with_a_mesh_is_a_part) {
  const TempFolder folder;
  // the same triangle in two places, under a node that has none
  const auto path = folder.write("m.gltf", R"({"asset":{"version":"2.0"},"scene":0,
      "scenes":[{"nodes":[0]}],
      "nodes":[{"name":"all","children":[1,2]},{"name":"low","mesh":0},
               {"name":"high","mesh":0,"translation":[0,0,8]}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0}}]}],
      "buffers":[{"uri":"data:application/octet-stream;base64,)"
                                           "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
                                           R"(","byteLength":36}],
      "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                    "min":[0,0,0],"max":[1,1,0]}]})");
  const auto nodes = split_parts(read_mesh(path));
  ASSERT_EQ(nodes.size(), 2u);
  EXPECT_EQ(nodes[0].name, "low");
  EXPECT_EQ(nodes[1].name, "high");
  EXPECT_EQ(nodes[0].mesh.triangles.size(), 2u);  // both primitives
  EXPECT_EQ(nodes[1].mesh.vertices[1], (Vec3<double>{1, 0, 8}));
}

TEST(IoAssimp, a_broken_file_is_told_in_one_line) {
  const TempFolder folder;
  const std::string missing = gltf(R"([{"mesh":0}])", "[0]", R"("uri":"missing.bin",)");
  for (const std::filesystem::path& path :
       {folder.write("m.gltf", "{"), folder.write("n.gltf", missing), folder.write("m.3ds", "x"),
        folder.write("m.fbx", "rubbish"), folder.write("m.dae", "<COLLADA>"),
        folder.write("notes.txt", "a text\nof two lines\n")}) {
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
