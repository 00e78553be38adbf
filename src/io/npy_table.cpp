// SPDX-License-Identifier: Apache-2.0
//
// Tables in .npy files, read piece by piece with pread: any number of rows in little memory.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "io/bad_file.h"
#include "io/mapped_file.h"
#include "io/npy.h"
#include "io/number_table.h"

namespace pierce::io {
namespace {

class NpyTable : public NumberTable {
 public:
  NpyTable(const std::filesystem::path& path, const TableShape& shape)
      : NumberTable(path.string()), file_(open_regular_file(path)) {
    try {
      parse(shape);
    } catch (...) {
      ::close(file_.descriptor);
      throw;
    }
  }
  NpyTable(const NpyTable&) = delete;
  NpyTable& operator=(const NpyTable&) = delete;
  ~NpyTable() override { ::close(file_.descriptor); }

  void read(std::uint64_t first, std::span<double> out) const override {
    constexpr std::size_t kPiece = 8192;  // numbers; the buffer stays in the first cache
    std::array<char, kPiece * sizeof(double)> raw;
    std::uint64_t at = first * columns_;
    while (!out.empty()) {
      const std::size_t count = std::min(out.size(), kPiece);
      read_bytes(data_offset_ + at * item_bytes_, {raw.data(), count * item_bytes_});
      if (single_precision_) {
        decode<float>(raw.data(), out.first(count));
      } else {
        decode<double>(raw.data(), out.first(count));
      }
      out = out.subspan(count);
      at += count;
    }
  }

 private:
  void parse(const TableShape& shape) {
    std::string head(std::min<std::uint64_t>(file_.size, 12), '\0');
    read_bytes(0, head);
    head.resize(std::min<std::uint64_t>(file_.size, npy_header_bytes(head)));
    read_bytes(0, head);
    const NpyHeader header = parse_npy_header(head, name_);
    const NpyField& field = header.fields.at(0);
    const std::size_t most = shape.columns.size();
    const std::string wanted = shape.fewest_columns == most
                                   ? fmt::format("{}", most)
                                   : fmt::format("{} or {}", shape.fewest_columns, most);
    if (header.structured || field.kind != 'f' || (field.bytes != 4 && field.bytes != 8)) {
      bad_file(name_,
               fmt::format(
                   "{} must be float32 or float64 numbers, not {}: convert them "
                   "with astype",
                   shape.what,
                   header.structured ? "records" : fmt::format("'{}{}'", field.kind, field.bytes)));
    }
    const bool width_fits = header.shape.size() == 2 &&
                            (header.shape[1] == shape.fewest_columns || header.shape[1] == most);
    if (!width_fits) {
      bad_file(name_, fmt::format("{} must be a 2-D array of {} columns ({}), not of shape ({}): "
                                  "reshape it",
                                  shape.what, wanted, fmt::join(shape.columns, " "),
                                  fmt::join(header.shape, ", ")));
    }
    if (header.fortran_order && header.shape[0] > 1) {
      bad_file(name_, "the array is in Fortran order: save numpy.ascontiguousarray of it");
    }
    rows_ = header.shape[0];
    columns_ = static_cast<std::size_t>(header.shape[1]);
    single_precision_ = field.bytes == 4;
    item_bytes_ = field.bytes;
    swap_ = field.big_endian != (std::endian::native == std::endian::big);
    data_offset_ = header.data_offset;
    const std::uint64_t expected = data_offset_ + header.count() * item_bytes_;
    if (expected != file_.size) {
      bad_file(name_, fmt::format("has {} bytes where its header announces {}: it was {}",
                                  file_.size, expected,
                                  file_.size < expected ? "cut off, write it again"
                                                        : "lengthened, keep one array in it"));
    }
  }

  void read_bytes(std::uint64_t offset, std::span<char> out) const {
    while (!out.empty()) {
      const ssize_t got =
          ::pread(file_.descriptor, out.data(), out.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) bad_file(name_, fmt::format("cannot be read: {}", std::strerror(errno)));
      if (got == 0) bad_file(name_, "became shorter while it was read");
      out = out.subspan(static_cast<std::size_t>(got));
      offset += static_cast<std::uint64_t>(got);
    }
  }

  template <class Number>
  void decode(const char* raw, std::span<double> out) const {
    for (double& value : out) {
      std::array<char, sizeof(Number)> bytes;
      std::memcpy(bytes.data(), raw, sizeof(Number));
      if (swap_) std::reverse(bytes.begin(), bytes.end());
      value = static_cast<double>(std::bit_cast<Number>(bytes));
      raw += sizeof(Number);
    }
  }

  OpenedFile file_;
  std::uint64_t data_offset_ = 0;
  std::size_t item_bytes_ = 0;
  bool swap_ = false;
};

}  // namespace

std::unique_ptr<NumberTable> open_npy_table(const std::filesystem::path& path,
                                            const TableShape& shape) {
  return std::make_unique<NpyTable>(path, shape);
}

}  // namespace pierce::io
