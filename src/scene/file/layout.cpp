// SPDX-License-Identifier: Apache-2.0
#include "scene/file/layout.h"

#include <cmath>
#include <cstring>
#include <utility>

#include "bvh/node.h"
#include "bvh/tree.h"
#include "pierce/scene_file.h"
#include "scene/validate_input.h"
#include "support/checksum.h"
#include "support/private_mapping.h"

namespace pierce {
namespace scene {

SceneFileTable::SceneFileTable(std::span<const std::byte> file, const std::string& name)
    : header{}, file_(file), name_(name) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorCode::BadFile, name + ": " + why);
  };
  std::memcpy(&header, file.data(), std::min(sizeof header, file.size()));
  if (file.size() < sizeof header.magic + sizeof header.version ||
      std::memcmp(header.magic, kSceneFileMagic, sizeof kSceneFileMagic) != 0) {
    refuse("is no scene file: give one that `pierce build` or Scene::save wrote");
  }
  if (header.version != kSceneFileVersion) {
    refuse("is a scene file of version " + std::to_string(header.version) +
           ", of which this pierce, which reads version " + std::to_string(kSceneFileVersion) +
           ", knows nothing: get a newer one, or build the scene anew");
  }
  if (file.size() < sizeof header) refuse("is cut short: build the scene anew");
  const auto before = std::as_bytes(std::span(&std::as_const(header), 1));
  if (xxh64(before.first(offsetof(SceneFileHeader, checksum))) != header.checksum)
    damaged("its header is not what was written");
  if (file.size() != header.file_bytes) {
    refuse((file.size() < header.file_bytes ? "is cut short: " : "is too long: ") +
           std::to_string(file.size()) + " bytes of " + std::to_string(header.file_bytes) +
           "; copy it again, or build the scene anew");
  }
  look_at_header();
  look_at(header.nodes, sizeof(bvh::Node), "the search tree");
  look_at(header.leaves, 1, "its leaves");
  look_at(header.names, 1, "names");
  look_at(header.table, sizeof(GeometryRecord), "the table of geometries");
  if (header.table.bytes / sizeof(GeometryRecord) != header.geometries)
    damaged("its table has another number of geometries");
  for (const Section& small : {header.table, header.names}) {
    if (checksum(bytes(small)) != small.checksum)
      damaged("its table of geometries is not what was written");
  }
  geometries = {reinterpret_cast<const GeometryRecord*>(bytes(header.table).data()),
                static_cast<std::size_t>(header.geometries)};
  std::uint64_t triangles = 0;
  for (const GeometryRecord& geometry : geometries) {
    look_at(geometry.vertices, std::uint64_t{3} * header.real_bytes, "vertices");
    look_at(geometry.triangles, sizeof(Triangle), "triangles");
    triangles += geometry.triangles.bytes / sizeof(Triangle);
    if (triangles >= kNone) break;
  }
  if (triangles != header.triangles || triangles >= kNone)
    damaged("its geometries have another number of triangles");
}

// Numbers that queries rely upon.
void SceneFileTable::look_at_header() const {
  const SceneFileHeader& h = header;
  const bool known = (h.real_bytes == 4 || h.real_bytes == 8) && h.quality <= 3 && h.layout <= 1 &&
                     (h.layout == 1) == (static_cast<Quality>(h.quality) == Quality::Compact);
  if (!known) damaged("its header says what no version says");
  bool sound = std::isfinite(h.sah_cost) && std::isfinite(h.built_cost);
  for (int k = 0; k < 3; ++k) {
    sound &= h.triangles == 0 ||
             (std::isfinite(h.lower[k]) && std::isfinite(h.upper[k]) && h.lower[k] <= h.upper[k]);
  }
  if (!sound) damaged("its bounds are no numbers");
}

void SceneFileTable::look_at(const Section& section, std::uint64_t item, const char* what) const {
  const bool inside =
      section.offset <= file_.size() && section.bytes <= file_.size() - section.offset;
  if (!inside || section.offset % kSceneFilePage != 0 || section.bytes % item != 0)
    damaged(std::string("the place of ") + what + " is not in it");
}

void SceneFileTable::damaged(const std::string& why) const {
  throw Error(ErrorCode::BadFile,
              name_ + ": is damaged: " + why + "; copy it again, or build the scene anew");
}

}  // namespace scene

SceneFileInfo scene_file_info(const std::string& path) {
  const PrivateMapping file(path);
  const scene::SceneFileTable table(file.bytes(), path);
  const std::size_t reals = std::size_t{3} * table.header.real_bytes;
  SceneFileInfo info;
  info.version = table.header.version;
  info.bits = 8 * table.header.real_bytes;
  info.quality = static_cast<Quality>(table.header.quality);
  info.triangles = table.header.triangles;
  info.bytes = table.header.file_bytes;
  info.fingerprint = table.header.checksum;
  std::span<const std::byte> names = table.bytes(table.header.names);
  for (const scene::GeometryRecord& geometry : table.geometries) {
    std::uint32_t length = 0;
    if (names.size() >= sizeof length) {
      std::memcpy(&length, names.data(), sizeof length);
      names = names.subspan(sizeof length);
    }
    if (length > names.size()) table.damaged("a name does not end");
    info.geometries.push_back({{reinterpret_cast<const char*>(names.data()), length},
                               geometry.vertices.bytes / reals,
                               geometry.triangles.bytes / sizeof(Triangle),
                               geometry.mask});
    names = names.subspan(length);
  }
  return info;
}

}  // namespace pierce
