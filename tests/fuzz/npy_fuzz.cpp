// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a .npy file: a header whose fields lie inside the element and whose size 64 bits can
// count, and then a table of rays that can be read to the last row, whole and from anywhere; or
// Error with one line.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "io/npy.h"
#include "io/number_table.h"
#include "pierce/error.h"

namespace {

using pierce::io::InputFile;

void require(bool condition) {
  if (!condition) std::abort();
}

/// False if it throws Error (BadFile).
template <class Work>
bool succeeds(const Work& work) {
  try {
    work();
    return true;
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    return false;
  }
}

void read_header(std::string_view bytes) {
  const pierce::io::NpyHeader header = pierce::io::parse_npy_header(bytes, "a.npy");
  require(header.data_offset <= bytes.size());
  require(header.data_offset == pierce::io::npy_header_bytes(bytes.substr(0, 12)));
  for (const pierce::io::NpyField& field : header.fields) {
    require(field.offset + field.bytes * field.repeat <= header.element_bytes);
  }
  (void)header.count();
}

void read_table(std::string_view bytes) {
  using pierce::io::TableColumn, pierce::io::TableTriple;
  static constexpr std::array<TableColumn, 8> kColumns = {
      {{"ox"}, {"oy"}, {"oz"}, {"dx"}, {"dy"}, {"dz"}, {"t_min", "tmin"}, {"t_max", "tmax", 9}}};
  static constexpr std::array<TableTriple, 2> kTriples = {{{"origin", 0}, {"direction", 3}}};
  const auto table = pierce::io::open_npy_table(InputFile(std::string(bytes), "a.npy"),
                                                {"rays", kColumns, 6, kTriples});
  require(table->rows() <= bytes.size());
  std::vector<float> floats(table->rows() * 8);
  (void)succeeds([&] { table->read(0, std::span(floats)); });
  std::vector<double> all(table->rows() * 8);
  if (!succeeds([&] { table->read(0, std::span(all)); })) return;
  for (std::uint64_t first = 0; first < table->rows(); first += 1 + table->rows() / 5) {
    std::vector<double> row(8);
    table->read(first, std::span(row));
    for (std::size_t k = 0; k < 8; ++k) {
      const double whole = all[first * 8 + k];
      require(row[k] == whole || (row[k] != row[k] && whole != whole));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const bool header = succeeds([&] { read_header(bytes); });
  const bool table = succeeds([&] { read_table(bytes); });
  require(header || !table);
  return 0;
}
