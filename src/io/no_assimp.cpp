// SPDX-License-Identifier: Apache-2.0
//
// In place of assimp.cpp where Assimp is not to be had (PIERCE_INSTALLED_LIBRARIES=OFF).
#include "io/bad_file.h"
#include "io/mesh_formats.h"

namespace pierce::io {

Mesh read_by_assimp(const std::filesystem::path& path) {
  bad_file(
      path.string(),
      "is neither PLY, STL, OBJ, OFF nor glTF, and this pierce was built without Assimp, which "
      "reads other formats: convert it to PLY");
}

Mesh read_by_assimp(const std::filesystem::path& path, std::string_view /*text*/) {
  return read_by_assimp(path);
}

bool assimp_reads(const std::string& /*extension*/) { return false; }

}  // namespace pierce::io
