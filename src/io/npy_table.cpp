// SPDX-License-Identifier: Apache-2.0
//
// Tables in .npy files, read piece by piece: any number of rows in little memory.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "io/bad_file.h"
#include "io/convert_number.h"
#include "io/npy.h"
#include "io/npy_layout.h"
#include "io/number_table.h"

namespace pierce::io {
namespace {

class NpyTable : public NumberTable {
 public:
  NpyTable(InputFile file, const TableShape& shape)
      : NumberTable(file.name()), file_(std::move(file)), columns_(shape.columns) {
    std::string head(std::min<std::uint64_t>(file_.size(), 12), '\0');
    file_.read(0, head);
    head.resize(std::min<std::uint64_t>(file_.size(), npy_header_bytes(head)));
    file_.read(0, head);
    const NpyHeader header = parse_npy_header(head, name_);
    layout_ = npy_layout(header, name_, shape);
    rows_ = layout_.rows;
    remarks_ = layout_.remarks;
    data_offset_ = header.data_offset;
    tell_types();
    check_size(data_offset_ + header.count() * header.element_bytes);
    if (layout_.fortran) data_ = file_.bytes().substr(data_offset_);
  }

  void read(std::uint64_t first, std::span<float> out) const override { read_as(first, out); }
  void read(std::uint64_t first, std::span<double> out) const override { read_as(first, out); }

 private:
  void tell_types() {
    single_precision_ = whole_numbers_ = true;
    for (const NpySource& source : layout_.sources) {
      const NumberType t = source.type;
      const bool fraction = t == NumberType::F2 || t == NumberType::F4 || t == NumberType::F8;
      const bool wide = t == NumberType::F8 || t == NumberType::I4 || t == NumberType::I8 ||
                        t == NumberType::U4 || t == NumberType::U8;
      single_precision_ = single_precision_ && !wide;
      whole_numbers_ = whole_numbers_ && !fraction;
    }
  }

  void check_size(std::uint64_t expected) const {
    if (expected == file_.size()) return;
    bad_file(name_, fmt::format("has {} bytes where its header announces {}: it was {}",
                                file_.size(), expected,
                                file_.size() < expected ? "cut off, write it again"
                                                        : "lengthened, keep one array in it"));
  }

  template <class Real>
  void read_as(std::uint64_t first, std::span<Real> out) const {
    constexpr std::uint64_t kPieceBytes = 1 << 16;
    const std::size_t wide = columns_.size();
    std::vector<char> buffer;
    while (!out.empty()) {
      std::uint64_t count = std::min<std::uint64_t>(out.size() / wide, layout_.run(first));
      const std::uint64_t offset = layout_.row_offset(first);
      const char* rows = nullptr;
      if (layout_.fortran) {
        rows = data_.data() + offset;
      } else {
        count = std::min(count, std::max<std::uint64_t>(kPieceBytes / layout_.stride, 1));
        buffer.resize(std::max(buffer.size(), count * layout_.stride));
        file_.read(data_offset_ + offset, {buffer.data(), count * layout_.stride});
        rows = buffer.data();
      }
      decode(rows, first, out.first(count * wide));
      out = out.subspan(count * wide);
      first += count;
    }
  }

  // The rows `first` and following, which lie at `rows`, so many at a time as fit the first cache.
  template <class Real>
  void decode(const char* rows, std::uint64_t first, std::span<Real> out) const {
    const std::size_t wide = columns_.size(), most = 256 * wide;
    while (!out.empty()) {
      const std::span<Real> part = out.first(std::min(most, out.size()));
      for (const NpySource& source : layout_.sources) read_column(source, rows, first, part);
      for (const std::size_t k : layout_.absent) {
        const Real value = static_cast<Real>(columns_[k].otherwise);
        for (std::size_t i = k; i < part.size(); i += wide) part[i] = value;
      }
      out = out.subspan(part.size());
      first += part.size() / wide;
      rows += part.size() / wide * layout_.stride;
    }
  }

  // One column of the rows `first` and following, which lie at `rows`.
  template <class Real>
  void read_column(const NpySource& source, const char* rows, std::uint64_t first,
                   std::span<Real> out) const {
    const auto decode = [&]<class Number>(Number) {
      if (source.swapped) {
        decode_column<Number, true>(source, rows, first, out);
      } else {
        decode_column<Number, false>(source, rows, first, out);
      }
    };
    switch (source.type) {
      case NumberType::F2:
        return decode(Half{});
      case NumberType::F4:
        return decode(float{});
      case NumberType::F8:
        return decode(double{});
      case NumberType::I1:
        return decode(std::int8_t{});
      case NumberType::I2:
        return decode(std::int16_t{});
      case NumberType::I4:
        return decode(std::int32_t{});
      case NumberType::I8:
        return decode(std::int64_t{});
      case NumberType::U1:
        return decode(std::uint8_t{});
      case NumberType::U2:
        return decode(std::uint16_t{});
      case NumberType::U4:
        return decode(std::uint32_t{});
      case NumberType::U8:
        return decode(std::uint64_t{});
    }
  }

  template <class Number, bool kSwapped, class Real>
  void decode_column(const NpySource& source, const char* rows, std::uint64_t first,
                     std::span<Real> out) const {
    const std::size_t wide = columns_.size(), count = out.size() / wide;
    const std::uint64_t stride = layout_.stride;
    const char* at = rows + source.offset;
    Real* to = out.data() + source.column;
    for (std::size_t i = 0; i < count; ++i, at += stride, to += wide) {
      std::array<char, sizeof(Number)> bytes;
      std::memcpy(bytes.data(), at, sizeof(Number));
      if constexpr (kSwapped) std::reverse(bytes.begin(), bytes.end());
      const Number number = std::bit_cast<Number>(bytes);
      if (!convert_number(number, *to)) [[unlikely]] {
        fail_number<Real>(name_, first + i, number);
      }
    }
  }

  InputFile file_;
  std::span<const TableColumn> columns_;
  NpyLayout layout_;
  std::uint64_t data_offset_ = 0;
  std::string_view data_;  // of an array in Fortran order
};

}  // namespace

std::unique_ptr<NumberTable> open_npy_table(InputFile file, const TableShape& shape) {
  return std::make_unique<NpyTable>(std::move(file), shape);
}

}  // namespace pierce::io
