// SPDX-License-Identifier: Apache-2.0
//
// Scene files: a scene with its search tree and its meshes, ready to be asked in milliseconds,
// however large. Scene::save and Scene::load (pierce/scene.h) write and open them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pierce/error.h"
#include "pierce/options.h"

namespace pierce {

struct SaveOptions {
  /// Either empty or one a geometry: what people call it. UTF-8; pierce makes nothing of them.
  std::span<const std::string> names = {};
  WorkOptions work = {};
};

struct LoadOptions {
  /// Look at every byte that means something: checksums of all, and that no number in the file
  /// leads out of it. About 0.3 s a GB on one core. Without, the load takes in the header, the
  /// table of geometries and the structure of the search tree, whole; corners and indices are
  /// looked at as queries meet them. Neither lets a damaged file do more harm than an Error
  /// (BadFile), or, without, a wrong answer.
  bool verify = false;
  WorkOptions work = {};
};

/// What a scene file says of itself.
struct SceneFileInfo {
  struct Geometry {
    std::string name;
    std::uint64_t vertices = 0, triangles = 0;
    std::uint32_t mask = kAllBits;
  };
  unsigned version = 0;
  unsigned bits = 0;  ///< 32: a Scene<float>; 64: a Scene<double>
  Quality quality = Quality::Balanced;
  std::uint64_t triangles = 0, bytes = 0;
  /// The checksum of all checksums: scenes with the same fingerprint are the same to the last byte.
  std::uint64_t fingerprint = 0;
  std::vector<Geometry> geometries;
};

/// Of the file's header and table. Throws Error (BadFile) in one line if it is no scene file, is
/// damaged there, cut short, or written by a newer version.
[[nodiscard, gnu::visibility("default")]] SceneFileInfo scene_file_info(const std::string& path);

}  // namespace pierce
