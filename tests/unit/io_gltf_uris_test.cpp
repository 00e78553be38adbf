// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0: where the data of a file lie, and files that show nothing.
#include "io/read_mesh.h"
#include "support/gltf_files.h"

namespace pierce::io {
namespace {

constexpr double kTenth = static_cast<double>(0.1f);

Mesh read(const GltfMaker& maker) { return read_mesh_bytes(maker.in_text(), "m.gltf"); }
void expect_in(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST(IoGltf, buffers_by_addresses_of_every_kind) {
  const TempFolder folder;
  const GltfMaker maker = one_triangle();
  const std::string data = base64(maker.data());
  std::string escaped, broken;
  for (const char c : data) escaped += c == '=' ? std::string("%3D") : std::string(1, c);
  for (const char c : data) broken += c == 'A' ? std::string("A\\n ") : std::string(1, c);
  std::string octets;
  for (const char c : maker.data()) {
    constexpr std::string_view kDigits = "0123456789aBcDeF";
    const auto code = static_cast<unsigned char>(c);
    octets += {'%', kDigits[code / 16], kDigits[code % 16]};
  }
  (void)folder.write("a%20b.bin", maker.data());
  std::filesystem::create_directory(folder / "c");
  (void)folder.write("c/d.bin", maker.data());
  for (const std::string& uri :
       {"data:;base64," + escaped, "data:application/gltf-buffer;base64," + broken,
        "data:application/octet-stream," + octets, "data:," + octets, std::string("a%20b.bin"),
        std::string(R"(c\\d.bin)"), std::string(R"(.\\c\\d.bin)")}) {
    const Mesh mesh = read_mesh(folder.write("m.gltf", maker.beside(uri)));
    EXPECT_EQ(mesh.vertices[0].x, kTenth) << uri;
  }
  const auto refused = [&](const std::string& uri) {
    return error_of([&] { (void)read_mesh(folder.write("m.gltf", maker.beside(uri))); });
  };
  expect_in(refused("https://example.org/a.bin"), "is an address: download the file");
  expect_in(refused("data:;base64" + data), "data without a comma");
  expect_in(refused("data:;base64,*" + data), "is no base64");
}

TEST(IoGltf, what_shows_nothing_says_why) {
  const auto warnings = [](const GltfMaker& maker) {
    const Mesh mesh = read(maker);
    EXPECT_EQ(mesh.triangles.size(), 0u);
    return mesh.warnings.empty() ? std::string() : mesh.warnings[0];
  };
  GltfMaker maker = one_triangle();
  maker.scenes = R"("scene":0,"scenes":[{}])";
  expect_in(warnings(maker), "its scene shows none of its 1 mesh");
  maker = one_triangle();
  maker.nodes = R"([{"camera":0}])";
  expect_in(warnings(maker), "its scene shows none of its 1 mesh");
  maker = one_triangle();
  maker.primitive(R"("attributes":{"POSITION":0},"indices":1,"mode":1)");
  expect_in(warnings(maker), "1 primitive of points or lines left out");
  maker = one_triangle();
  maker.nodes = R"([{"mesh":0,"rotation":[0,0,0,2]}])";
  expect_in(read(maker).warnings[0], "nodes[0]: its rotation is no unit quaternion");
  maker.nodes = R"([{"mesh":0,"rotation":[0,0.7071,0,0.7071]}])";
  EXPECT_EQ(read(maker).warnings.size(), 0u);
}

}  // namespace
}  // namespace pierce::io
