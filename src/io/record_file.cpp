// SPDX-License-Identifier: Apache-2.0
#include "io/record_file.h"

#include <fmt/format.h>

#include "io/npy.h"
#include "io/text_cursor.h"
#include "pierce/error.h"

namespace pierce::io {
namespace {

std::filesystem::path checked(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (!same_word(extension, ".npy") && !same_word(extension, ".csv")) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{}: unknown kind of output file: end its name in .npy or .csv",
                            path.string()));
  }
  return path;
}

}  // namespace

RecordFile::RecordFile(const std::filesystem::path& path, std::span<const RecordColumn> columns)
    : file_(checked(path)), csv_(same_word(path.extension().string(), ".csv")) {
  std::string titles;
  for (const RecordColumn& column : columns) {
    titles += fmt::format("{}{}", titles.empty() ? "" : ",", column.name);
    descr_ += fmt::format("{}('{}', '{}')", descr_.empty() ? "[" : ", ", column.name, column.type);
  }
  descr_ = columns.size() == 1 ? fmt::format("'{}'", columns[0].type) : descr_ + "]";
  file_.write(csv_ ? titles : make_npy_header(descr_, std::array{rows_}));
}

void RecordFile::finish() {
  // The header went out with a count of 0; it keeps its length with the true one.
  if (csv_) {
    file_.write("\n");
  } else {
    file_.rewrite(0, make_npy_header(descr_, std::array{rows_}));
  }
  file_.commit();
}

}  // namespace pierce::io
