// SPDX-License-Identifier: Apache-2.0
//
// In place of src/io/assimp.cpp, where there is no Assimp.
#include "io/bad_file.h"
#include "io/mesh_formats.h"

namespace pierce::io {

bool assimp_knows(const std::string&) { return false; }

Mesh read_by_assimp(const std::filesystem::path& path) {
  bad_file(path.string(),
           "is neither PLY, STL, OBJ nor OFF, and this build reads nothing else: convert it to PLY");
}

}  // namespace pierce::io
