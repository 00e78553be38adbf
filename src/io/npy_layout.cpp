// SPDX-License-Identifier: Apache-2.0
#include "io/npy_layout.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <optional>
#include <utility>

#include "io/bad_file.h"

namespace pierce::io {
namespace {

std::optional<NumberType> number_type(const NpyField& field) {
  constexpr std::pair<char, NumberType> kFirst[] = {
      {'f', NumberType::F2}, {'i', NumberType::I1}, {'u', NumberType::U1}};
  for (const auto& [kind, first] : kFirst) {
    if (field.kind != kind) continue;
    const std::size_t smallest = kind == 'f' ? 2 : 1;
    for (std::size_t i = 0; smallest << i <= 8; ++i) {
      if (field.bytes == smallest << i) {
        return static_cast<NumberType>(static_cast<std::size_t>(first) + i);
      }
    }
  }
  return {};
}

class LayoutReader {
 public:
  LayoutReader(const NpyHeader& header, const std::string& name, const TableShape& shape)
      : header_(header), name_(name), shape_(shape) {}

  NpyLayout read() {
    const std::size_t column_indices = header_.structured ? 0 : count_column_indices();
    if (header_.shape.size() <= column_indices) fail_shape();
    split_shape(header_.shape.size() - column_indices);
    if (header_.structured) {
      add_fields();
    } else {
      add_columns(header_.shape.size() - column_indices);
    }
    for (std::size_t k = 0; k < shape_.columns.size(); ++k) {
      bool present = false;
      for (const NpySource& source : layout_.sources) present = present || source.column == k;
      if (!present) layout_.absent.push_back(k);
    }
    return std::move(layout_);
  }

 private:
  // The last index counts columns; or the last two do, of two points with three coordinates each.
  [[nodiscard]] std::size_t count_column_indices() const {
    const std::vector<std::uint64_t>& n = header_.shape;
    if (!n.empty() && (n.back() == shape_.fewest || n.back() == shape_.columns.size())) return 1;
    const bool pairs = n.size() >= 2 && n[n.size() - 2] * 3 == shape_.fewest && n.back() == 3;
    if (!pairs) fail_shape();
    return 2;
  }

  // The first `count` indices count rows.
  void split_shape(std::size_t count) {
    const std::vector<std::uint64_t>& n = header_.shape;
    strides_.resize(n.size());
    std::uint64_t stride = header_.element_bytes;
    for (std::size_t i = 0; i < n.size(); ++i) {
      const std::size_t k = header_.fortran_order ? i : n.size() - 1 - i;
      strides_[k] = stride;
      stride *= n[k];
    }
    const auto end = static_cast<std::ptrdiff_t>(count);
    layout_.extents.assign(n.begin(), n.begin() + end);
    layout_.strides.assign(strides_.begin(), strides_.begin() + end);
    layout_.stride = layout_.strides.back();
    layout_.fortran = header_.fortran_order;
    layout_.rows = 1;
    for (const std::uint64_t extent : layout_.extents) layout_.rows *= extent;
    if (count > 1) {
      layout_.remarks.push_back(
          fmt::format("{}: the {} of shape ({}) are read as {} rows, the last of the first {} "
                      "indices fastest",
                      name_, shape_.what, fmt::join(n, ", "), layout_.rows, count));
    }
  }

  void add(std::size_t column, const NpyField& field, std::uint64_t offset) {
    const std::optional<NumberType> type = number_type(field);
    if (!type) {
      bad_file(name_, fmt::format("{} must be float16, float32, float64 or integers, not '{}{}': "
                                  "convert them with astype",
                                  shape_.what, field.kind, field.bytes));
    }
    const bool swapped = field.big_endian != (std::endian::native == std::endian::big);
    layout_.sources.push_back({column, *type, swapped && field.bytes > 1, offset});
  }

  void add_columns(std::size_t first_index) {
    const std::vector<std::uint64_t>& n = header_.shape;
    std::size_t columns = 1;
    for (std::size_t i = first_index; i < n.size(); ++i) columns *= n[i];
    for (std::size_t k = 0; k < columns; ++k) {
      const std::uint64_t offset = first_index + 1 == n.size()
                                       ? k * strides_.back()
                                       : k / 3 * strides_[first_index] + k % 3 * strides_.back();
      add(k, header_.fields[0], offset);
    }
  }

  void add_fields() {
    std::vector<ColumnTitle> titles;
    std::vector<const NpyField*> fields;
    for (const NpyField& field : header_.fields) {
      if (field.name.empty()) continue;  // padding
      titles.push_back({field.name, field.repeat});
      fields.push_back(&field);
    }
    const ColumnMatch match = match_columns(titles, shape_);
    if (!match.trouble.empty()) bad_file(name_, fmt::format("the fields: {}", match.trouble));
    if (!match.unused.empty()) {
      layout_.remarks.push_back(
          fmt::format("{}: fields that are not used: {}", name_, match.unused));
    }
    for (std::size_t i = 0; i < fields.size(); ++i) {
      if (match.columns[i] == kNoColumn) continue;
      for (std::size_t k = 0; k < fields[i]->repeat; ++k) {
        add(match.columns[i] + k, *fields[i], fields[i]->offset + k * fields[i]->bytes);
      }
    }
  }

  [[noreturn]] void fail_shape() const {
    bad_file(name_,
             fmt::format("{} must be an array of {} columns ({}){} or of records with these names, "
                         "not of shape ({}): reshape it",
                         shape_.what, column_counts(shape_), column_names(shape_),
                         shape_.fewest == 6 ? ", of shape (n, 2, 3)," : "",
                         fmt::join(header_.shape, ", ")));
  }

  const NpyHeader& header_;
  const std::string& name_;
  const TableShape& shape_;
  NpyLayout layout_;
  std::vector<std::uint64_t> strides_;  // of all indices
};

}  // namespace

std::uint64_t NpyLayout::row_offset(std::uint64_t row) const {
  if (!fortran) return row * stride;
  std::uint64_t offset = 0;
  for (std::size_t i = extents.size(); i-- > 0;) {
    offset += row % extents[i] * strides[i];
    row /= extents[i];
  }
  return offset;
}

std::uint64_t NpyLayout::run(std::uint64_t row) const {
  return fortran ? extents.back() - row % extents.back() : rows - row;
}

NpyLayout npy_layout(const NpyHeader& header, const std::string& name, const TableShape& shape) {
  return LayoutReader(header, name, shape).read();
}

}  // namespace pierce::io
