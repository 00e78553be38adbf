// SPDX-License-Identifier: Apache-2.0
#include "io/number_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/bad_file.h"
#include "io/convert_number.h"
#include "io/extension.h"
#include "io/mesh_formats.h"
#include "io/packed.h"
#include "io/text_cursor.h"

namespace pierce::io {
namespace {

class MemoryTable : public NumberTable {
 public:
  MemoryTable(TableNumbers numbers, std::string name, const TableShape& shape)
      : NumberTable(std::move(name)), numbers_(std::move(numbers)), shape_(shape) {
    rows_ = numbers_.numbers.size() / numbers_.columns.size();
    remarks_ = numbers_.remarks;
    single_precision_ = numbers_.single_precision;
  }

  void read(std::uint64_t first, std::span<float> out) const override { read_as(first, out); }
  void read(std::uint64_t first, std::span<double> out) const override { read_as(first, out); }

 private:
  template <class Real>
  void read_as(std::uint64_t first, std::span<Real> out) const {
    const std::size_t wide = shape_.columns.size(), given = numbers_.columns.size();
    const double* from = numbers_.numbers.data() + first * given;
    for (std::size_t i = 0; i < out.size() / wide; ++i, from += given) {
      Real* const row = out.data() + i * wide;
      for (std::size_t k = 0; k < wide; ++k)
        row[k] = static_cast<Real>(shape_.columns[k].otherwise);
      for (std::size_t k = 0; k < given; ++k) {
        if (!convert_number(from[k], row[numbers_.columns[k]])) {
          fail_number<Real>(name_, first + i, from[k]);
        }
      }
    }
  }

  TableNumbers numbers_;
  TableShape shape_;
};

// Whatever its case; or nothing.
std::size_t column_named(std::string_view name, const TableShape& shape) {
  for (std::size_t k = 0; k < shape.columns.size(); ++k) {
    const TableColumn& column = shape.columns[k];
    if (same_word(name, column.name)) return k;
    if (!column.alias.empty() && same_word(name, column.alias)) return k;
  }
  return kNoColumn;
}

std::size_t triple_named(std::string_view name, const TableShape& shape) {
  for (const TableTriple& triple : shape.triples) {
    if (same_word(name, triple.name)) return triple.first;
  }
  return kNoColumn;
}

std::string first_bytes(const InputFile& file) {
  std::string start(std::min<std::uint64_t>(file.size(), 6), '\0');
  file.read(0, start);
  return start;
}

// The content decides; a name that promises .npy must keep the promise.
std::unique_ptr<NumberTable> open_file(InputFile file, const TableShape& shape) {
  const std::string start = first_bytes(file);
  if (looks_like_ply(start)) return open_ply_table(std::move(file), shape);
  const bool is_npy = start == "\x93NUMPY" || has_extension(unpacked_name(file.name()), ".npy");
  if (!is_npy && start.starts_with("PK\x03\x04")) return open_npz_table(std::move(file), shape);
  return is_npy ? open_npy_table(std::move(file), shape) : open_csv_table(std::move(file), shape);
}

}  // namespace

std::unique_ptr<NumberTable> open_table(const std::filesystem::path& path,
                                        const TableShape& shape) {
  InputFile file(path);
  if (packing_of(first_bytes(file)) == Packing::None) return open_file(std::move(file), shape);
  std::string numbers = unpack(file.bytes(), file.name());
  if (packing_of(numbers) != Packing::None) {
    bad_file(file.name(), "is packed more than once: unpack it");
  }
  return open_file(InputFile(std::move(numbers), file.name()), shape);
}

std::unique_ptr<NumberTable> open_ply_table(InputFile file, const TableShape& shape) {
  if (!shape.point_cloud) {
    bad_file(file.name(),
             fmt::format("is a PLY, not a table of {}: save them as .npy or .csv", shape.what));
  }
  const Mesh mesh = read_ply(file.bytes(), file.name());
  TableNumbers rows;
  rows.columns = {0, 1, 2};
  rows.single_precision = mesh.single_precision;
  for (const Vec3<double>& p : mesh.vertices)
    rows.numbers.insert(rows.numbers.end(), {p.x, p.y, p.z});
  for (const std::string& warning : mesh.warnings)
    rows.remarks.push_back(fmt::format("{}: {}", file.name(), warning));
  return make_table(std::move(rows), file.name(), shape);
}

std::unique_ptr<NumberTable> make_table(TableNumbers numbers, std::string name,
                                        const TableShape& shape) {
  return std::make_unique<MemoryTable>(std::move(numbers), std::move(name), shape);
}

ColumnMatch match_columns(std::span<const ColumnTitle> titles, const TableShape& shape) {
  ColumnMatch match;
  match.found.resize(shape.columns.size());
  constexpr std::size_t kShown = 8;
  std::size_t unused = 0;
  for (const auto& [name, count] : titles) {
    std::size_t column = column_named(name, shape);
    std::size_t width = 1;
    if (column == kNoColumn) {
      column = triple_named(name, shape);
      width = 3;
    }
    match.columns.push_back(column);
    if (column == kNoColumn) {
      if (unused < kShown) match.unused += (unused == 0 ? "" : ", ") + in_quotes(name);
      ++unused;
      continue;
    }
    if (count != width) {
      match.trouble = fmt::format("{} holds {} numbers in place of {}: write it with {}",
                                  in_quotes(name), count, width, width);
      return match;
    }
    for (std::size_t k = column; k < column + width; ++k) {
      if (match.found[k]) {
        match.trouble = fmt::format("{} is there twice: remove one or name it otherwise",
                                    shape.columns[k].name);
        return match;
      }
      match.found[k] = true;
    }
  }
  if (unused > kShown) match.unused += fmt::format(" and {} more", unused - kShown);
  std::string missing;
  for (std::size_t k = 0; k < shape.fewest; ++k) {
    if (!match.found[k])
      missing += fmt::format("{}{}", missing.empty() ? "" : ",", shape.columns[k].name);
  }
  if (!missing.empty()) {
    match.trouble = fmt::format("nothing is named {}: {} need {}, by these names", missing,
                                shape.what, column_names(shape));
  }
  return match;
}

std::string column_names(const TableShape& shape) {
  std::string names;
  for (std::size_t k = 0; k < shape.columns.size(); ++k) {
    if (k == shape.fewest) names += '[';
    if (k > 0) names += ',';
    names += shape.columns[k].name;
  }
  return shape.fewest < shape.columns.size() ? names + ']' : names;
}

std::string column_counts(const TableShape& shape) {
  const std::size_t most = shape.columns.size();
  return shape.fewest == most ? fmt::format("{}", most)
                              : fmt::format("{} or {}", shape.fewest, most);
}

}  // namespace pierce::io
