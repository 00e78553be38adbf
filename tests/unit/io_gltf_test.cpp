// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0: every type of numbers, every mode, scenes and nodes, transforms rounded once; what
// cannot be read is refused by name.
#include <cmath>
#include <limits>

#include "io/read_mesh.h"
#include "io/split_parts.h"
#include "pierce/transform.h"
#include "support/gltf_files.h"

namespace pierce::io {
namespace {

using Points = std::vector<Vec3<double>>;
using Triangles = std::vector<Triangle>;

constexpr double kTenth = static_cast<double>(0.1f);

Mesh read(const GltfMaker& maker) { return read_mesh_bytes(maker.in_text(), "m.gltf"); }
std::string refusal(const GltfMaker& maker) {
  return error_of([&] { (void)read(maker); });
}
void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(IoGltf, positions_are_the_files_floats_in_every_container) {
  const TempFolder folder;
  const GltfMaker maker = one_triangle();
  (void)folder.write("the data.bin", maker.data());
  for (const auto& path :
       {folder.write("m.gltf", maker.in_text()), folder.write("m.glb", maker.binary()),
        folder.write("n.gltf", maker.beside("the%20data.bin")),
        folder.write("o.gltf", maker.binary()), folder.write("p.glb", maker.in_text()),
        folder.write("q.gltf", "\xef\xbb\xbf" + maker.in_text()),
        folder.write("unnamed", maker.binary())}) {
    const Mesh mesh = read_mesh(path);
    EXPECT_EQ(mesh.vertices, (Points{{kTenth, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << path;
    EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    EXPECT_TRUE(mesh.single_precision);
    EXPECT_TRUE(mesh.warnings.empty());
  }
  EXPECT_EQ(read_mesh(folder / "m.gltf").format, "glTF");
  EXPECT_EQ(read_mesh(folder / "m.glb").format, "glTF, binary");
}

// KHR_mesh_quantization: positions of any type, dense or with gaps, normalised or not.
template <class Number>
void check_type(int type) {
  const Number low = std::numeric_limits<Number>::min(), high = std::numeric_limits<Number>::max();
  const Number three = 3, zero = 0;
  for (const bool gaps : {false, true}) {
    for (const bool normalized : {false, true}) {
      GltfMaker maker;
      maker.extensions = R"("extensionsRequired":["KHR_mesh_quantization"])";
      std::string data;
      const std::string gap = gaps ? std::string(4, '\x55') : std::string();
      data += little(low, zero, three) + gap + little(high, three, zero) + gap +
              little(zero, high, low) + gap;
      const std::string stride =
          gaps ? ",\"byteStride\":" + std::to_string(3 * sizeof(Number) + 4) : "";
      maker.accessor(maker.view(data, stride), type, 3, "VEC3",
                     normalized ? R"(,"normalized":true)" : "");
      maker.primitive(R"("attributes":{"POSITION":0})");
      const double scale = normalized ? static_cast<double>(high) : 1;
      const auto at = [&](Number x) {
        return std::max(static_cast<double>(x) / scale, normalized ? -1.0 : -1e30);
      };
      const Mesh mesh = read(maker);
      EXPECT_EQ(mesh.vertices,
                (Points{{at(low), 0, at(three)}, {at(high), at(three), 0}, {0, at(high), at(low)}}))
          << type << gaps << normalized;
      EXPECT_FALSE(mesh.single_precision);
    }
  }
}

TEST(IoGltf, positions_of_every_type) {
  check_type<std::int8_t>(5120);
  check_type<std::uint8_t>(5121);
  check_type<std::int16_t>(5122);
  check_type<std::uint16_t>(5123);
  check_type<std::uint32_t>(5125);
}

TEST(IoGltf, indices_of_every_type) {
  const auto with = [](int type, const std::string& data) {
    GltfMaker maker = one_triangle();
    maker.primitive(R"("attributes":{"POSITION":0},"indices":2)");
    maker.accessor(maker.view(data), type, 3, "SCALAR");
    return read(maker).triangles;
  };
  const Triangles want = {{2, 0, 1}};
  EXPECT_EQ(with(5121, std::string("\2\0\1", 3)), want);
  EXPECT_EQ(with(5123, little(std::uint16_t{2}, std::uint16_t{0}, std::uint16_t{1})), want);
  EXPECT_EQ(with(5125, little(2u, 0u, 1u)), want);
}

TEST(IoGltf, sparse_accessors_replace_values) {
  for (const bool based : {true, false}) {
    GltfMaker maker = one_triangle();
    const std::size_t places = maker.view(little(std::uint8_t{0}, std::uint8_t{2}));
    const std::size_t values = maker.view(little(7.0f, 8.0f, 9.0f, 4.0f, 5.0f, 6.0f));
    maker.accessor(std::string(based ? R"("bufferView":0,)" : "") +
                   R"("componentType":5126,"count":3,"type":"VEC3","sparse":{"count":2,)" +
                   R"("indices":{"componentType":5121,"bufferView":)" + std::to_string(places) +
                   R"(},"values":{"bufferView":)" + std::to_string(values) + "}}");
    maker.primitive(R"("attributes":{"POSITION":2},"indices":1)");
    EXPECT_EQ(read(maker).vertices, (Points{{7, 8, 9}, {based ? 1.0 : 0.0, 0, 0}, {4, 5, 6}}));
  }
}

TEST(IoGltf, strips_fans_and_what_is_no_triangle) {
  GltfMaker maker;
  maker.accessor(
      maker.view(little(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 1.f, 1.f, 0.f, 2.f, 2.f, 2.f)),
      5126, 5, "VEC3");
  const auto mode = [&](const std::string& number) {
    maker.primitive(R"("attributes":{"POSITION":0},"mode":)" + number);
    return read(maker).triangles;
  };
  EXPECT_EQ(mode("5"), (Triangles{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(mode("6"), (Triangles{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  for (const char* other : {"0", "1", "2", "3"}) EXPECT_TRUE(mode(other).empty());
  EXPECT_EQ(mode("4"), (Triangles{{0, 1, 2}}));
  EXPECT_EQ(read(maker).warnings.size(), 1u);  // two corners are left over
  maker.primitive(R"("attributes":{"POSITION":0},"mode":7)");
  expect_in(refusal(maker), "meshes[0].primitives[0].mode: 7");
}

TEST(IoGltf, bad_indices_are_named) {
  GltfMaker maker = one_triangle();
  maker.accessor(maker.view(std::string("\0\1\3", 3)), 5121, 3, "SCALAR");
  maker.primitive(R"("attributes":{"POSITION":0},"indices":2)");
  expect_in(refusal(maker), "meshes[0].primitives[0]: index 2 names vertex 3, there are 3");
  maker.primitive(R"("attributes":{"POSITION":9},"indices":2)");
  expect_in(refusal(maker), "POSITION: names accessors 9, there are 3");
  maker.nodes = R"([{"mesh":5}])";
  expect_in(refusal(maker), "nodes[0].mesh: names meshes 5, there is 1");
}

TEST(IoGltf, required_extensions_that_are_not_known_are_refused_by_name) {
  GltfMaker maker = one_triangle();
  maker.extensions = R"("extensionsRequired":["KHR_materials_unlit","ACME_holes"])";
  expect_in(refusal(maker), "'ACME_holes'");
  maker.extensions = R"("extensionsRequired":["KHR_texture_basisu","KHR_materials_volume"])";
  EXPECT_EQ(read(maker).triangles.size(), 1u);
  maker.extensions = R"("extensionsUsed":["ACME_holes"])";
  EXPECT_EQ(read(maker).triangles.size(), 1u);
}

TEST(IoGltf, vertices_are_floats_unless_a_transform_makes_others_of_them) {
  const auto single = [&](const std::string& node) {
    GltfMaker maker = one_triangle();
    maker.nodes = "[{\"mesh\":0," + node + "}]";
    return read(maker).single_precision;
  };
  EXPECT_TRUE(single(R"("scale":[-2,0.5,1])"));
  EXPECT_TRUE(single(R"("translation":[0,1,0])"));
  EXPECT_FALSE(single(R"("scale":[0.1,1,1])"));
  EXPECT_FALSE(single(R"("translation":[0.3,0,0])"));
}

TEST(IoGltf, nodes_come_depth_first_and_are_parts) {
  GltfMaker maker = one_triangle();
  maker.nodes = R"([
      {"mesh":0,"name":"a","translation":[0,0,1],"children":[1,2]},
      {"mesh":0,"name":"b","translation":[0,0,10],"scale":[2,2,2]},
      {"mesh":0,"translation":[0,0,100]},
      {"mesh":0,"name":7,"translation":[0,0,1000]}])";
  maker.scenes = R"("scene":0,"scenes":[{"nodes":[0,3]}])";
  const Mesh mesh = read(maker);
  ASSERT_EQ(mesh.vertices.size(), 12u);
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{kTenth, 0, 1}));
  EXPECT_EQ(mesh.vertices[3], (Vec3<double>{2 * kTenth, 0, 11}));
  EXPECT_EQ(mesh.vertices[6], (Vec3<double>{kTenth, 0, 101}));
  EXPECT_EQ(mesh.vertices[9], (Vec3<double>{kTenth, 0, 1000}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}}));
  EXPECT_EQ(mesh.part_names, (std::vector<std::string>{"a", "b", "", ""}));
}

// A vertex under a matrix is what an Instance with it has.
TEST(IoGltf, transforms_are_rounded_once) {
  GltfMaker maker = one_triangle();
  maker.nodes = R"([{"mesh":0,"matrix":[0.1,0.2,0.3,0, 0.7,0.11,0.13,0, 0.17,0.19,0.23,0,
                     1e-17,0.3,1e17,1]}])";
  const Transform<double> transform{
      {{{0.1, 0.7, 0.17, 1e-17}, {0.2, 0.11, 0.19, 0.3}, {0.3, 0.13, 0.23, 1e17}}}};
  const Points corners = {{kTenth, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  Points want;
  for (const Vec3<double>& p : corners) want.push_back(transformed(transform, p));
  EXPECT_EQ(read(maker).vertices, want);
  maker.nodes = R"([{"scale":[0.1,1,1],"children":[1]},{"mesh":0,"scale":[0.1,1,1]}])";
  EXPECT_EQ(read(maker).vertices[1].x, 0.1 * 0.1);
  maker.nodes = R"([{"mesh":0,"rotation":[0,0,1,0]}])";  // half a turn about z
  EXPECT_EQ(read(maker).vertices, (Points{{-kTenth, 0, 0}, {-1, 0, 0}, {0, -1, 0}}));
  maker.nodes = R"([{"mesh":0,"rotation":[0,0.6,0,0.8]}])";
  EXPECT_EQ(read(maker).vertices[1].z, -2 * (0.6 * 0.8));
  for (const char* bad :
       {R"("matrix":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1])", R"("matrix":[1,2])",
        R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"scale":[1,1,1])",
        R"("scale":[1e308,1e308],"translation":[1,2,3])", R"("scale":["1",1,1])"}) {
    maker.nodes = "[{\"mesh\":0," + std::string(bad) + "}]";
    expect_in(refusal(maker), "nodes[0].");
  }
}

TEST(IoGltf, a_mirrored_part_keeps_its_outside) {
  GltfMaker maker = one_triangle();
  for (const char* scale : {"[1,1,-1]", "[-1,-1,-1]", "[-1e-200,1e-200,1e-200]"}) {
    maker.nodes = R"([{"mesh":0,"scale":)" + std::string(scale) + "}]";
    EXPECT_EQ(read(maker).triangles, (Triangles{{0, 2, 1}})) << scale;
  }
  maker.nodes = R"([{"scale":[-1,1,1],"children":[1]},{"mesh":0,"scale":[1,-1,1]}])";
  EXPECT_EQ(read(maker).triangles, (Triangles{{0, 1, 2}}));
}

TEST(IoGltf, which_scene_is_read) {
  GltfMaker maker = one_triangle();
  maker.nodes = R"([{"mesh":0},{"mesh":0,"translation":[5,0,0],"children":[2]},{"mesh":0}])";
  const auto count = [&](const std::string& scenes) {
    maker.scenes = scenes;
    return read(maker).triangles.size();
  };
  EXPECT_EQ(count(R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}])"), 2u);
  EXPECT_EQ(count(R"("scenes":[{"nodes":[0]}])"), 1u);
  EXPECT_TRUE(read(maker).warnings.empty());
  EXPECT_EQ(count(R"("scenes":[{"nodes":[0]},{"nodes":[1]}])"), 1u);
  EXPECT_EQ(read(maker).warnings.size(), 1u);  // it might be the other
  EXPECT_EQ(count(""), 3u);                    // every node that is nobody's child
  maker.nodes = "";
  EXPECT_EQ(count(""), 1u);
  EXPECT_EQ(read(maker).warnings.size(), 1u);
  maker.nodes = R"([{"mesh":0}])";
  maker.scenes = R"("scene":2,"scenes":[{"nodes":[0]}])";
  expect_in(refusal(maker), "scene: names scenes 2, there is 1");
}

TEST(IoGltf, nodes_that_go_in_circles_are_refused) {
  GltfMaker maker = one_triangle();
  for (const char* nodes :
       {R"([{"mesh":0,"children":[0]}])", R"([{"mesh":0,"children":[1]},{"children":[0]}])",
        R"([{"children":[1,1]},{"mesh":0}])"}) {
    maker.nodes = nodes;
    expect_in(refusal(maker), "more than one place");
  }
}

TEST(IoGltf, instances_of_a_node) {
  GltfMaker maker = one_triangle();
  maker.extensions = R"("extensionsRequired":["EXT_mesh_gpu_instancing"])";
  maker.accessor(maker.view(little(0.f, 0.f, 1.f, 0.f, 0.f, 2.f)), 5126, 2, "VEC3");
  maker.accessor(maker.view(little(1.f, 1.f, 1.f, -2.f, 1.f, 1.f)), 5126, 2, "VEC3");
  maker.nodes = R"([{"mesh":0,"translation":[0,0,10],"extensions":{"EXT_mesh_gpu_instancing":
      {"attributes":{"TRANSLATION":2,"SCALE":3}}}}])";
  const Mesh mesh = read(maker);
  EXPECT_EQ(
      mesh.vertices,
      (Points{
          {kTenth, 0, 11}, {1, 0, 11}, {0, 1, 11}, {-2 * kTenth, 0, 12}, {-2, 0, 12}, {0, 1, 12}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {3, 5, 4}}));
  maker.accessor(maker.view(little(1.f, 1.f, 1.f)), 5126, 1, "VEC3");
  maker.nodes = R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":
      {"attributes":{"TRANSLATION":2,"SCALE":4}}}}])";
  expect_in(refusal(maker), "not of one length");
  maker.accessor(maker.view(little(1.f, std::numeric_limits<float>::infinity(), 1.f)), 5126, 1,
                 "VEC3");
  maker.nodes = R"([{"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":
      {"attributes":{"TRANSLATION":5}}}}])";
  expect_in(refusal(maker), "the transform of instance 0 is not finite");
}

TEST(IoGltf, attributes_never_refuse_positions) {
  GltfMaker maker = one_triangle();
  maker.accessor(maker.view(little(0.f, 0.f, 1.f)), 5126, 1, "VEC3");
  maker.accessor(maker.view(std::string("\xff\0\0\xff\0\xff\0\xff\0\0\xff\xff", 12)), 5121, 3,
                 "VEC4", R"(,"normalized":true)");
  maker.primitive(R"("attributes":{"POSITION":0,"NORMAL":2,"TEXCOORD_0":77,"COLOR_0":3})");
  const Mesh mesh = read(maker);
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.warnings.size(), 2u);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_EQ(mesh.colors, (std::vector<Vec3<float>>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
}

// For pictures: normals stay across the surface, whatever the node does; texture coordinates are
// any of their types; parts without them have none.
TEST(IoGltf, normals_and_texture_coordinates) {
  GltfMaker maker = one_triangle();
  const float d = 0.6f, e = 0.8f;
  maker.accessor(maker.view(little(d, e, 0.f, 0.f, 0.f, 1.f, 0.f, e, d)), 5126, 3, "VEC3");
  maker.accessor(maker.view(std::string("\0\xff\x33\0\xff\xff", 6)), 5121, 3, "VEC2",
                 R"(,"normalized":true)");
  maker.meshes = R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},
      {"primitives":[{"attributes":{"POSITION":0,"NORMAL":2,"TEXCOORD_0":3},"indices":1}]}])";
  maker.scenes = R"("scene":0,"scenes":[{"nodes":[0,1]}])";
  // Mirrored: x by -2, y by 4.
  maker.nodes = R"([{"mesh":0},{"mesh":1,"scale":[-2,4,1]}])";
  const Mesh mesh = read(maker);
  ASSERT_EQ(mesh.normals.size(), 6u);
  ASSERT_EQ(mesh.texcoords.size(), 6u);
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 0}));
  // Divided by the scale, times 8.
  EXPECT_EQ(mesh.normals[3], (Vec3<float>{-4 * d, 2 * e, 0}));
  EXPECT_EQ(mesh.normals[4], (Vec3<float>{0, 0, 8}));
  EXPECT_EQ(mesh.normals[5], (Vec3<float>{0, 2 * e, 8 * d}));
  EXPECT_EQ(mesh.texcoords[0], (std::array<float, 2>{0, 0}));
  EXPECT_EQ(mesh.texcoords[3], (std::array<float, 2>{0, 1}));
  EXPECT_EQ(mesh.texcoords[4], (std::array<float, 2>{0.2f, 0}));
}

TEST(IoGltf, whole_numbers_may_be_written_as_fractions) {
  std::string text = one_triangle().in_text();
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
    return error_of([&] { (void)read_mesh_bytes(text, "m.gltf"); });
  };
  EXPECT_EQ(put(R"("count":3)", R"("count":3.0)"), "");
  expect_in(put(R"("count":3.0)", R"("count":2.5)"), "accessors[0].count: expected a whole number");
  expect_in(put(R"("count":2.5)", R"("count":[3])"), "found array");
  expect_in(put(R"("count":[3])", R"("count":1e300)"),
            "accessors[0].count: expected a whole number of at most 4294967295, found '1e+300'");
}

TEST(IoGltf, what_is_not_there_is_refused) {
  GltfMaker maker = one_triangle();
  const std::string good = maker.in_text();
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, text.npos) << from;
    text.replace(at, from.size(), to);
    return error_of([&] { (void)read_mesh_bytes(text, "m.gltf"); });
  };
  expect_in(changed(R"("count":3)", R"("count":4)"), "accessors[0]: 4 values do not fit");
  expect_in(changed(R"("count":3)", R"("count":4000000000)"), "accessors[0]: 4000000000 values");
  expect_in(changed(R"("count":3)", R"("count":-3)"), "accessors[0].count: expected a whole");
  expect_in(changed("VEC3", "VEC2"), "accessors[0].type: 'VEC2'");
  expect_in(changed("5126", "5130"), "accessors[0].componentType: 5130");
  expect_in(changed(R"("byteLength":36)", R"("byteLength":3600)"), "bufferViews[0]: bytes 0 to");
  expect_in(changed(R"("byteOffset":36)", R"("byteOffset":9007199254740992)"), "bufferViews[1]");
  expect_in(changed(R"("byteLength":42)", R"("byteLength":43)"), "buffers[0]: 43 bytes");
  expect_in(changed(";base64,", ";base64,*"), "buffers[0].uri: is no base64");
  expect_in(changed(R"("version":"2.0")", R"("version":"1.0")"), "only glTF 2");
  expect_in(changed(R"({"asset")", R"([{"asset")"), "is no JSON");
  expect_in(error_of([&] { (void)read_mesh_bytes(good.substr(0, 200), "m.gltf"); }), "is no JSON");
  expect_in(error_of([&] { (void)read_mesh_bytes("[1]", "m.gltf"); }), "one JSON object");
  expect_in(refusal([] {
              GltfMaker zeros = one_triangle();
              zeros.accessor(R"("componentType":5126,"count":4000000000,"type":"VEC3")");
              zeros.primitive(R"("attributes":{"POSITION":2})");
              return zeros;
            }()),
            "without data");
  expect_in(changed("VEC3", "VEC7"), "accessors[0].type: 'VEC7'");
  expect_in(changed(";base64,", ";base64,="), "buffers[0].uri: is no base64");
  expect_in(changed("data:application/octet-stream;base64,", "n%4F.bin?"), "nO.bin?");
  expect_in(changed("data:application/octet-stream;base64,", "%6eo.bin?"), "needs all its files");
  expect_in(changed("\"uri\"", "\"URI\""), "buffers[0]: has neither a uri nor data");
  expect_in(changed(R"("scenes":[{"nodes":[0]}],)", ""), "scene: names scenes 0, there are 0");
  expect_in(changed(R"("componentType":5123)", R"("normalized":true,"componentType":5123)"),
            "indices must be whole numbers");
  std::string sparse = R"("count":3,"sparse":{"count":1,"indices":{"componentType":5123,)"
                       R"("bufferView":1,"byteOffset":4},"values":{"bufferView":0}})";
  EXPECT_EQ(changed(R"("count":3)", sparse), "");
  sparse.replace(sparse.find("5123"), 4, "5125");
  sparse.replace(sparse.find(R"("byteOffset":4)"), 14, R"("byteOffset":0)");
  expect_in(changed(R"("count":3)", sparse), "index 0 names value 65536, there are 3");
  std::string old = maker.binary();
  old[4] = 1;
  expect_in(error_of([&] { (void)read_mesh_bytes(old, "m.glb"); }), "binary glTF of version 1");
  old[4] = 2;
  old[12] = '\x7f';
  old[13] = '\x7f';
  expect_in(error_of([&] { (void)read_mesh_bytes(old, "m.glb"); }),
            "a chunk of 32639 bytes ends behind");
  const std::string binary = maker.binary();
  for (std::size_t size = 5; size < binary.size(); ++size) {
    EXPECT_NE(error_of([&] { (void)read_mesh_bytes(binary.substr(0, size), "m.glb"); }), "");
  }
  EXPECT_EQ(read_mesh_bytes(binary + "more", "m.glb").warnings.size(), 1u);
}

}  // namespace
}  // namespace pierce::io
