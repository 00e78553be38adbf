// SPDX-License-Identifier: Apache-2.0
//
// The data sheet of scene files, version 2. All numbers are little-endian; sections begin at
// multiples of kSceneFilePage bytes, in any order, with zeros between them.
//
//   0             SceneFileHeader, 512 bytes
//   nodes         bvh::Node each (bvh/node.h)
//   leaves        leaf blocks (bvh/node.h), with their slack
//   arrays        of each geometry vertices, 3 Reals each, and triangles, 3 uint32 each; what
//                 geometries share is there once
//   geometries    GeometryRecord each
//   names         of each geometry in turn: uint32 bytes, then those
//
// Every section has its checksum (support/checksum.h) where its place is named, and the header that
// of itself, so the header's is the fingerprint of the whole. A newer version may change anything
// but the first twelve bytes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "pierce/types.h"

namespace pierce::scene {

static_assert(std::endian::native == std::endian::little, "sections are used as they lie");

// Not text, as its first byte tells; and what turns line ends into others shows.
inline constexpr unsigned char kSceneFileMagic[8] = {0x89, 'P', 'R', 'C', '\r', '\n', 0x1a, '\n'};
inline constexpr std::uint32_t kSceneFileVersion = 2;
inline constexpr std::uint64_t kSceneFilePage = 4096;

struct Section {
  std::uint64_t offset, bytes, checksum;
};

struct SceneFileHeader {
  unsigned char magic[8];
  std::uint32_t version;
  std::uint32_t real_bytes;  // 4 or 8
  std::uint64_t file_bytes;
  std::uint64_t geometries, triangles;
  std::uint32_t quality, layout;  // as Quality and bvh::Layout have them
  std::uint32_t has_masks, all_floats;
  double lower[3], upper[3], smallest;  // Extent
  float tree_lower[3], tree_upper[3];
  std::uint64_t leaf_blocks;
  double sah_cost, built_cost;
  std::uint32_t root, unused;
  Section nodes, leaves, table, names;
  unsigned char rest[240];  // zero
  std::uint64_t checksum;   // xxh64 of what stands before it
};
static_assert(sizeof(SceneFileHeader) == 512 && std::is_trivially_copyable_v<SceneFileHeader>);

struct GeometryRecord {
  Section vertices, triangles;
  std::uint32_t mask, unused;
};
static_assert(sizeof(GeometryRecord) == 56);
static_assert(sizeof(Vec3<float>) == 12 && sizeof(Vec3<double>) == 24 && sizeof(Triangle) == 12);

/// The header and the table of a scene file, looked at: the version is ours, the file as long as
/// it should be, their checksums right, and every section lies in the file. Throws Error (BadFile).
struct SceneFileTable {
  SceneFileTable(std::span<const std::byte> file, const std::string& name);

  /// The bytes of a section.
  [[nodiscard]] std::span<const std::byte> bytes(const Section& section) const {
    return file_.subspan(section.offset, section.bytes);
  }
  /// Throws Error (BadFile): "name: is damaged: why; ...".
  [[noreturn]] void damaged(const std::string& why) const;

  SceneFileHeader header;
  std::span<const GeometryRecord> geometries;

 private:
  void look_at_header() const;
  void look_at(const Section& section, std::uint64_t item, const char* what) const;

  std::span<const std::byte> file_;
  const std::string& name_;
};

}  // namespace pierce::scene
