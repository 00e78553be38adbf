// SPDX-License-Identifier: Apache-2.0
//
// The array of an .npz that is meant: the only one, or the one that has the table's name.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "io/bad_file.h"
#include "io/number_table.h"
#include "io/zip_archive.h"

namespace pierce::io {

std::unique_ptr<NumberTable> open_npz_table(InputFile file, const TableShape& shape) {
  constexpr std::string_view kEnding = ".npy";
  ZipArchive archive(file.bytes(), file.name());
  std::vector<std::string> arrays;
  for (const std::string& member : archive.members()) {
    if (member.ends_with(kEnding))
      arrays.push_back(member.substr(0, member.size() - kEnding.size()));
  }
  if (arrays.empty()) {
    bad_file(file.name(), fmt::format("is an archive without arrays (.npy): save the {} with "
                                      "numpy.save",
                                      shape.what));
  }
  const auto named = std::find(arrays.begin(), arrays.end(), shape.what);
  if (arrays.size() > 1 && named == arrays.end()) {
    bad_file(file.name(),
             fmt::format("holds {} arrays ({}), none of them named {}: name one so, of all "
                         "columns together ({})",
                         arrays.size(), in_quotes(fmt::format("{}", fmt::join(arrays, ", ")), 100),
                         shape.what, column_names(shape)));
  }
  const std::string& array = arrays.size() == 1 ? arrays[0] : *named;
  std::string contents = archive.read(array + std::string(kEnding));
  return open_npy_table(InputFile(std::move(contents), file.name()), shape);
}

}  // namespace pierce::io
