// SPDX-License-Identifier: Apache-2.0
//
// In place of threemf.cpp and what is for it alone where the libraries are not to be had
// (PIERCE_INSTALLED_LIBRARIES=OFF).
#include "io/bad_file.h"
#include "io/mesh_formats.h"

namespace pierce::io {

Mesh read_threemf(std::string_view /*bytes*/, const std::string& name) {
  bad_file(name, "this pierce was built without the libraries that read 3MF: convert it to PLY");
}

}  // namespace pierce::io
