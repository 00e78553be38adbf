// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a .csv table of rays: whole rows of 6 or 8 numbers, or Error with one line.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "io/number_table.h"
#include "pierce/error.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<std::string_view, 8> kColumns = {"ox", "oy", "oz",    "dx",
                                                               "dy", "dz", "t_min", "t_max"};
  std::vector<double> numbers;
  try {
    const std::size_t columns = pierce::io::parse_csv({reinterpret_cast<const char*>(data), size},
                                                      "r.csv", {"rays", kColumns, 6}, numbers);
    require(columns == 6 || columns == 8);
    require(numbers.size() % columns == 0);
  } catch (const pierce::Error& error) {
    require(error.code() == pierce::ErrorCode::BadFile);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
