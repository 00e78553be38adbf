// SPDX-License-Identifier: Apache-2.0
//
// Compressed glTF, as the makers of the codecs compress: Draco meshes, meshopt buffers.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <limits>

#include "io/read_mesh.h"
#include "support/gltf_files.h"

namespace pierce::io {
namespace {

using Triangles = std::vector<Triangle>;

const std::vector<std::array<float, 3>> kCorners = {
    {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.25f}, {2, 1, -7}};
const std::vector<std::uint32_t> kIndices = {0, 1, 2, 2, 1, 3, 3, 1, 4};

std::string positions() {
  std::string out;
  for (const auto& p : kCorners) out += little(p[0], p[1], p[2]);
  return out;
}

std::vector<std::array<double, 9>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<double, 9>> all;
  for (const Triangle& t : mesh.triangles) {
    std::array<double, 9> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3<double>& p = mesh.vertices[t[k]];
      corners[3 * k] = p.x;
      corners[3 * k + 1] = p.y;
      corners[3 * k + 2] = p.z;
    }
    // The first corner is the least: triangles are the same whichever the coder begins with.
    for (std::size_t k = 0; k < 2; ++k) {
      auto turned = corners;
      std::rotate(turned.begin(), turned.begin() + 3, turned.end());
      std::array<double, 9> again = turned;
      std::rotate(again.begin(), again.begin() + 3, again.end());
      corners = std::min({corners, turned, again});
    }
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

Mesh plain_mesh() {
  Mesh mesh;
  for (const auto& p : kCorners) {
    mesh.vertices.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  for (std::size_t i = 0; i < kIndices.size(); i += 3) {
    mesh.triangles.push_back({kIndices[i], kIndices[i + 1], kIndices[i + 2]});
  }
  return mesh;
}

// Quantisation off: Draco then keeps the floats.
std::string draco_bytes() {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(kIndices.size() / 3));
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::size_t i = 0; i < kIndices.size(); i += 3) {
    builder.SetAttributeValuesForFace(
        position, draco::FaceIndex(static_cast<std::uint32_t>(i / 3)), kCorners[kIndices[i]].data(),
        kCorners[kIndices[i + 1]].data(), kCorners[kIndices[i + 2]].data());
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {buffer.data(), buffer.size()};
}

GltfMaker draco_file(const std::string& bytes, const std::string& id = "0") {
  GltfMaker maker;
  maker.extensions = R"("extensionsRequired":["KHR_draco_mesh_compression"])";
  const std::size_t view = maker.view(bytes);
  maker.accessor(R"("componentType":5126,"count":5,"type":"VEC3")");
  maker.accessor(R"("componentType":5123,"count":9,"type":"SCALAR")");
  maker.primitive(R"("attributes":{"POSITION":0},"indices":1,
      "extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                  std::to_string(view) + R"(,"attributes":{"POSITION":)" + id + "}}}");
  return maker;
}

TEST(IoGltfCodecs, draco_meshes) {
  const std::string bytes = draco_bytes();
  const Mesh mesh = read_mesh_bytes(draco_file(bytes).in_text(), "m.gltf");
  EXPECT_EQ(triangles_of(mesh), triangles_of(plain_mesh()));
  EXPECT_TRUE(mesh.single_precision);
  const auto refusal = [&](const GltfMaker& maker) {
    return error_of([&] { (void)read_mesh_bytes(maker.in_text(), "m.gltf"); });
  };
  EXPECT_NE(refusal(draco_file(bytes.substr(0, bytes.size() / 2))).find("cannot be decoded"),
            std::string::npos);
  EXPECT_NE(refusal(draco_file(bytes, "7")).find("not among the Draco data"), std::string::npos);
}

// Quantised positions, which the accessor may say are normalised: the file's numbers.
template <class Number>
void check_draco_type(draco::DataType type, int component,
                      Number largest = std::numeric_limits<Number>::max()) {
  const std::array<std::array<Number, 3>, 3> corners = {{{0, 1, 2}, {largest, 5, 6}, {7, 8, 100}}};
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(1);
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, type);
  builder.SetAttributeValuesForFace(position, draco::FaceIndex(0), corners[0].data(),
                                    corners[1].data(), corners[2].data());
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*builder.Finalize(), &buffer).ok());
  GltfMaker maker;
  maker.extensions =
      R"("extensionsRequired":["KHR_draco_mesh_compression","KHR_mesh_quantization"])";
  const std::size_t view = maker.view({buffer.data(), buffer.size()});
  maker.accessor("\"componentType\":" + std::to_string(component) + R"(,"count":3,"type":"VEC3")");
  maker.primitive(R"("attributes":{"POSITION":0},
      "extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                  std::to_string(view) + R"(,"attributes":{"POSITION":0}}})");
  Mesh want;
  want.triangles = {{0, 1, 2}};
  for (const auto& p : corners) {
    want.vertices.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  const Mesh mesh = read_mesh_bytes(maker.in_text(), "m.gltf");
  EXPECT_EQ(triangles_of(mesh), triangles_of(want)) << component;
  EXPECT_EQ(mesh.single_precision, component == 5126);
}

TEST(IoGltfCodecs, draco_numbers_of_every_type) {
  check_draco_type<std::int8_t>(draco::DT_INT8, 5120);
  check_draco_type<std::uint8_t>(draco::DT_UINT8, 5121);
  check_draco_type<std::int16_t>(draco::DT_INT16, 5122);
  check_draco_type<std::uint16_t>(draco::DT_UINT16, 5123);
  check_draco_type<std::uint32_t>(draco::DT_UINT32, 5125, 1 << 30);  // the encoder's most
  check_draco_type<float>(draco::DT_FLOAT32, 5126);
}

// What the file also has uncompressed is taken: it has lost nothing.
TEST(IoGltfCodecs, uncompressed_data_are_preferred) {
  GltfMaker maker = one_triangle();
  const std::size_t view = maker.view("rubbish!");
  maker.primitive(R"("attributes":{"POSITION":0},"indices":1,
      "extensions":{"KHR_draco_mesh_compression":{"bufferView":)" +
                  std::to_string(view) + R"(,"attributes":{"POSITION":0}}})");
  EXPECT_EQ(read_mesh_bytes(maker.in_text(), "m.gltf").triangles, (Triangles{{0, 1, 2}}));
}

// As gltfpack -cc writes: a view into a buffer without data, the real one in the extension.
GltfMaker meshopt_file(const std::string& vertices, const std::string& indices,
                       const std::string& vertex_more, const std::string& index_more) {
  GltfMaker maker;
  maker.extensions = R"("extensionsRequired":["EXT_meshopt_compression"])";
  maker.view(vertices);
  const std::size_t at = maker.bytes() - vertices.size();
  maker.view(indices);
  const std::size_t then = maker.bytes() - indices.size();
  maker.second_buffer =
      R"(,{"byteLength":1000,"extensions":{"EXT_meshopt_compression":{"fallback":true}}})";
  const auto compressed = [&](std::size_t offset, std::size_t size, const std::string& more) {
    return maker.plain_view(
        R"({"buffer":1,"byteLength":60,"extensions":{"EXT_meshopt_compression":{"buffer":0,)"
        R"("byteOffset":)" +
        std::to_string(offset) + R"(,"byteLength":)" + std::to_string(size) + "," + more + "}}}");
  };
  maker.accessor(compressed(at, vertices.size(), vertex_more), 5126, 5, "VEC3");
  maker.accessor(compressed(then, indices.size(), index_more), 5125, 9, "SCALAR");
  maker.primitive(R"("attributes":{"POSITION":0},"indices":1)");
  return maker;
}

std::string encoded_vertices(const std::string& bytes) {
  std::string out(meshopt_encodeVertexBufferBound(5, 12), '\0');
  out.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(out.data()), out.size(),
                                        bytes.data(), 5, 12));
  return out;
}

TEST(IoGltfCodecs, meshopt_buffers) {
  std::string triangles(meshopt_encodeIndexBufferBound(9, 5), '\0');
  triangles.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(triangles.data()),
                                             triangles.size(), kIndices.data(), 9));
  std::string sequence(meshopt_encodeIndexSequenceBound(9, 5), '\0');
  sequence.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(sequence.data()),
                                              sequence.size(), kIndices.data(), 9));
  const std::string vertices = encoded_vertices(positions());
  const std::string of_vertices = R"("count":5,"byteStride":12,"mode":"ATTRIBUTES")";
  const std::string of_triangles = R"("count":9,"byteStride":4,"mode":"TRIANGLES")";
  const std::string of_indices = R"("count":9,"byteStride":4,"mode":"INDICES")";
  const auto read = [](const GltfMaker& maker) { return read_mesh_bytes(maker.binary(), "m.glb"); };
  const auto want = triangles_of(plain_mesh());
  EXPECT_EQ(triangles_of(read(meshopt_file(vertices, triangles, of_vertices, of_triangles))), want);
  EXPECT_EQ(triangles_of(read(meshopt_file(vertices, sequence, of_vertices, of_indices))), want);

  // m 2^e: 1 is 1 2^0, 0.25 is 1 2^-2, -7 is -7 2^0.
  std::string exponential;
  for (const auto& p : kCorners) {
    for (const float x : p) {
      const int e = x == 0.25f ? -2 : 0;
      const int m = static_cast<int>(x == 0.25f ? 1 : x);
      exponential += little((static_cast<std::uint32_t>(e) << 24) |
                            (static_cast<std::uint32_t>(m) & 0xffffffu));
    }
  }
  EXPECT_EQ(
      triangles_of(read(meshopt_file(encoded_vertices(exponential), triangles,
                                     of_vertices + R"(,"filter":"EXPONENTIAL")", of_triangles))),
      want);
}

// Filters of normals (x and y of an octahedron) and rotations (three numbers, and which is left
// out): here of positions, whose numbers are seen.
TEST(IoGltfCodecs, meshopt_filters_of_directions) {
  const auto positions_by = [](const std::string& filter, const std::string& numbers,
                               std::size_t stride, int type) {
    std::string packed(meshopt_encodeVertexBufferBound(3, stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                             packed.size(), numbers.data(), 3, stride));
    GltfMaker maker;
    maker.extensions =
        R"("extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization"])";
    maker.view(packed);
    const std::size_t view = maker.plain_view(
        R"({"buffer":0,"byteLength":1,"extensions":{"EXT_meshopt_compression":{"buffer":0,)"
        R"("byteLength":)" +
        std::to_string(packed.size()) + R"(,"count":3,"mode":"ATTRIBUTES","filter":")" + filter +
        R"(","byteStride":)" + std::to_string(stride) + "}}}");
    maker.accessor(view, type, 3, "VEC3");
    maker.primitive(R"("attributes":{"POSITION":0})");
    return read_mesh_bytes(maker.in_text(), "m.gltf").vertices;
  };
  using Points = std::vector<Vec3<double>>;
  // x, y, one, nothing: along x, along -y, along z.
  const std::string axes = {127, 0, 127, 0, 0, -127, 127, 0, 0, 0, 127, 0};
  EXPECT_EQ(positions_by("OCTAHEDRAL", axes, 4, 5120),
            (Points{{127, 0, 0}, {0, -127, 0}, {0, 0, 127}}));
  // One in the last number, and which is the largest in its last two bits: w, x, none turned.
  std::string turns;
  for (const int largest : {3, 0, 1}) {
    turns += little(std::int16_t{0}, std::int16_t{0}, std::int16_t{0},
                    static_cast<std::int16_t>(0x7ffc | largest));
  }
  EXPECT_EQ(positions_by("QUATERNION", turns, 8, 5122),
            (Points{{0, 0, 0}, {32767, 0, 0}, {0, 32767, 0}}));
}

TEST(IoGltfCodecs, damaged_meshopt_buffers_are_refused) {
  const std::string vertices = encoded_vertices(positions());
  const auto refusal = [&](const std::string& bytes, const std::string& more) {
    const GltfMaker maker =
        meshopt_file(bytes, "x", more, R"("count":9,"byteStride":4,"mode":"INDICES")");
    return error_of([&] { (void)read_mesh_bytes(maker.in_text(), "m.gltf"); });
  };
  for (const auto& [bytes, more] : std::vector<std::pair<std::string, std::string>>{
           {vertices.substr(0, vertices.size() - 9),
            R"("count":5,"byteStride":12,"mode":"ATTRIBUTES")"},
           {vertices, R"("count":4000000000,"byteStride":12,"mode":"ATTRIBUTES")"},
           {vertices, R"("count":5,"byteStride":0,"mode":"ATTRIBUTES")"},
           {vertices, R"("count":5,"byteStride":13,"mode":"ATTRIBUTES")"},
           {vertices, R"("count":5,"byteStride":12,"mode":"TRIANGLES")"},
           {vertices, R"("count":5,"byteStride":12,"mode":"ATTRIBUTES","filter":"OCTAHEDRAL")"},
           {vertices, R"("count":5,"byteStride":12,"mode":"SOMEHOW")"},
           {vertices, R"("count":5,"byteStride":12)"}}) {
    EXPECT_NE(refusal(bytes, more).find("bufferViews["), std::string::npos) << more;
  }
}

}  // namespace
}  // namespace pierce::io
