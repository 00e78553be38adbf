// SPDX-License-Identifier: Apache-2.0
//
// A mesh file's own parts (see Mesh::part_names) as meshes of their own.
#pragma once

#include <string>
#include <vector>

#include "io/mesh.h"

namespace pierce::io {

struct NamedMesh {
  std::string name;  ///< as in the file; may be empty
  Mesh mesh;
};

/// One mesh for each part that has triangles, in the order of the names. Triangles keep their
/// order, and so do vertices: each part gets those that it uses, numbered anew. A file without
/// parts is one, without a name, and stays as it is.
[[nodiscard]] std::vector<NamedMesh> split_parts(Mesh mesh);

}  // namespace pierce::io
