// SPDX-License-Identifier: Apache-2.0
//
// In place of threemf.cpp and npz_array.cpp where the libraries for them are not to be had
// (PIERCE_INSTALLED_LIBRARIES=OFF).
#include <fmt/format.h>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/number_table.h"

namespace pierce::io {

Mesh read_threemf(std::string_view /*bytes*/, const std::string& name) {
  bad_file(name, "this pierce was built without the libraries that read 3MF: convert it to PLY");
}

std::unique_ptr<NumberTable> open_npz_table(InputFile file, const TableShape& shape) {
  bad_file(file.name(),
           fmt::format("is an archive (.npz?): save the {} alone, with numpy.save", shape.what));
}

}  // namespace pierce::io
