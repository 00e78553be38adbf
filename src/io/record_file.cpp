// SPDX-License-Identifier: Apache-2.0
#include "io/record_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/extension.h"
#include "io/npy.h"
#include "io/npz.h"
#include "pierce/error.h"

namespace pierce::io {
namespace {

RecordFormat format_of(const std::filesystem::path& path) {
  if (has_extension(path, ".npy")) return RecordFormat::Npy;
  if (has_extension(path, ".npz")) return RecordFormat::Npz;
  if (has_extension(path, ".csv")) return RecordFormat::Csv;
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("{}: unknown kind of output file: end its name in .npy, .npz or .csv",
                          path.string()));
}

// "<f4": the digits at the end.
std::size_t bytes_of(std::string_view type) { return static_cast<std::size_t>(type[2] - '0'); }

std::string struct_descr(std::span<const RecordColumn> columns) {
  std::string descr = "[";
  std::size_t at = 0, largest = 1;
  const auto pad_to = [&](std::size_t size) {
    const std::size_t gap = (size - at % size) % size;
    if (gap > 0) descr += fmt::format("{}('', '|V{}')", at == 0 ? "" : ", ", gap);
    at += gap;
  };
  for (const RecordColumn& column : columns) {
    const std::size_t size = bytes_of(column.type);
    pad_to(size);
    descr += fmt::format("{}('{}', '{}')", at == 0 ? "" : ", ", column.name, column.type);
    at += size;
    largest = std::max(largest, size);
  }
  pad_to(largest);
  return descr + "]";
}

}  // namespace

RecordTarget::RecordTarget(const std::filesystem::path& where)
    : path(where), format(format_of(where)) {}
RecordTarget::RecordTarget(std::filesystem::path where, RecordFormat form)
    : path(std::move(where)), format(form) {}

RecordFile::RecordFile(const RecordTarget& target, std::span<const RecordColumn> columns)
    : file_(target.path), format_(target.format) {
  std::string titles;
  for (const RecordColumn& column : columns) {
    names_.emplace_back(column.name);
    types_.push_back(fmt::format("'{}'", column.type));
    titles += fmt::format("{}{}", titles.empty() ? "" : ",", column.name);
  }
  descr_ = columns.size() == 1 ? types_[0] : struct_descr(columns);
  if (format_ == RecordFormat::Csv) file_.write(titles);
  if (format_ == RecordFormat::Npy) file_.write(make_npy_header(descr_, std::array{rows_}));
  if (format_ == RecordFormat::Npz) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      columns_.emplace_back(file_.folder(), target.path.string());
    }
  }
}

void RecordFile::finish() {
  switch (format_) {
    case RecordFormat::Csv:
      file_.write("\n");
      break;
    case RecordFormat::Npy:
      // The header went out with a count of 0; it keeps its length with the true one.
      file_.rewrite(0, make_npy_header(descr_, std::array{rows_}));
      break;
    case RecordFormat::Npz: {
      NpzWriter archive(file_);
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        archive.add(names_[i], make_npy_header(types_[i], std::array{rows_}), columns_[i]);
      }
      archive.finish();
      break;
    }
  }
  file_.commit();
}

}  // namespace pierce::io
