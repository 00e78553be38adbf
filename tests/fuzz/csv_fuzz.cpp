// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a .csv table of rays: whole rows of the columns that it says it has, or Error with
// one line.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/number_table.h"
#include "pierce/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using pierce::io::TableColumn, pierce::io::TableTriple;
  static constexpr std::array<TableColumn, 8> kColumns = {
      {{"ox"}, {"oy"}, {"oz"}, {"dx"}, {"dy"}, {"dz"}, {"t_min", "tmin"}, {"t_max", "tmax", 9}}};
  static constexpr std::array<TableTriple, 2> kTriples = {{{"origin", 0}, {"direction", 3}}};
  try {
    const pierce::io::TableNumbers table = pierce::io::parse_csv(
        {reinterpret_cast<const char*>(data), size}, "r.csv", {"rays", kColumns, 6, kTriples});
    require(table.columns.size() >= 6 && table.columns.size() <= 8);
    require(table.numbers.size() % table.columns.size() == 0);
    std::array<bool, 8> there{};
    for (const std::size_t column : table.columns) {
      require(!there.at(column));
      there.at(column) = true;
    }
    for (std::size_t k = 0; k < 6; ++k) require(there.at(k));
    for (const std::string& remark : table.remarks) {
      require(remark.find('\n') == std::string::npos);
    }
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
