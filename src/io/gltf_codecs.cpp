// SPDX-License-Identifier: Apache-2.0
#include "io/gltf_codecs.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include "io/bad_file.h"

namespace pierce::io {
namespace {

unsigned component_type(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8:
      return 5120;
    case draco::DT_UINT8:
      return 5121;
    case draco::DT_INT16:
      return 5122;
    case draco::DT_UINT16:
      return 5123;
    case draco::DT_UINT32:
      return 5125;
    case draco::DT_FLOAT32:
      return 5126;
    default:
      return 0;
  }
}

DracoAttribute take_attribute(const draco::PointAttribute& attribute, std::uint32_t id,
                              std::uint64_t points) {
  DracoAttribute out;
  out.id = id;
  out.type = component_type(attribute.data_type());
  out.components = attribute.num_components();
  const auto size = static_cast<std::size_t>(draco::DataTypeLength(attribute.data_type())) *
                    attribute.num_components();
  out.bytes.resize(size * points);
  for (std::uint64_t i = 0; i < points; ++i) {
    const auto point = draco::PointIndex(static_cast<std::uint32_t>(i));
    attribute.GetMappedValue(point, out.bytes.data() + size * i);
  }
  return out;
}

}  // namespace

bool have_gltf_codecs() { return true; }

std::string decode_draco(std::string_view bytes, std::span<const std::uint32_t> ids,
                         DracoMesh& mesh) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes.data(), bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return in_quotes(decoded.status().error_msg(), 100);
  const draco::Mesh& source = *decoded.value();
  mesh.points = source.num_points();
  mesh.indices.reserve(std::size_t{3} * source.num_faces());
  for (std::uint32_t f = 0; f < source.num_faces(); ++f) {
    for (const draco::PointIndex& corner : source.face(draco::FaceIndex(f))) {
      mesh.indices.push_back(corner.value());
    }
  }
  for (const std::uint32_t id : ids) {
    const draco::PointAttribute* const attribute = source.GetAttributeByUniqueId(id);
    if (attribute != nullptr) {
      mesh.attributes.push_back(take_attribute(*attribute, id, mesh.points));
    }
  }
  return {};
}

std::string decode_meshopt(std::string_view bytes, MeshoptMode mode, MeshoptFilter filter,
                           std::uint64_t count, std::uint64_t stride, std::string& out) {
  const auto* const from = reinterpret_cast<const unsigned char*>(bytes.data());
  // The best that the codec can do is far from this.
  constexpr std::uint64_t kBestRatio = 1024;
  if (count > (bytes.size() + 1) * kBestRatio / stride) {
    return fmt::format("{} items are announced, too many for {} bytes", count, bytes.size());
  }
  out.resize(count * stride);
  int trouble = 0;
  if (mode == MeshoptMode::Attributes) {
    if (stride % 4 != 0 || stride > 256) return "items must be of 4, 8 ... 256 bytes";
    trouble = meshopt_decodeVertexBuffer(out.data(), count, stride, from, bytes.size());
  } else {
    if (stride != 2 && stride != 4) return "indices must be of 2 or 4 bytes";
    if (mode == MeshoptMode::Triangles && count % 3 != 0) return "indices must be three a triangle";
    trouble = mode == MeshoptMode::Triangles
                  ? meshopt_decodeIndexBuffer(out.data(), count, stride, from, bytes.size())
                  : meshopt_decodeIndexSequence(out.data(), count, stride, from, bytes.size());
  }
  if (trouble != 0) return fmt::format("the decoder says {}", trouble);
  const auto filter_needs = [&](std::uint64_t a, std::uint64_t b) {
    return stride == a || stride == b;
  };
  switch (filter) {
    case MeshoptFilter::None:
      break;
    case MeshoptFilter::Octahedral:
      if (!filter_needs(4, 8)) return "the filter is for items of 4 or 8 bytes";
      meshopt_decodeFilterOct(out.data(), count, stride);
      break;
    case MeshoptFilter::Quaternion:
      if (!filter_needs(8, 8)) return "the filter is for items of 8 bytes";
      meshopt_decodeFilterQuat(out.data(), count, stride);
      break;
    case MeshoptFilter::Exponential:
      if (stride % 4 != 0) return "the filter is for items of 4, 8 ... bytes";
      meshopt_decodeFilterExp(out.data(), count, stride);
      break;
  }
  return {};
}

}  // namespace pierce::io
