// SPDX-License-Identifier: Apache-2.0
//
// Values of options: numbers, vectors and sizes. All throw UsageError that names the option.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pierce/types.h"

namespace pierce::tool {

struct ImageSize {
  unsigned width, height;
};

/// Numbers with commas between them, however many; infinities are welcome, and fractions, 1/3 (the
/// double nearest to the quotient of two numbers that are read first).
[[nodiscard]] std::vector<double> parse_list(std::string_view text, std::string_view option);

/// The same with commas or blanks between them, or both.
[[nodiscard]] std::vector<double> parse_row(std::string_view text, std::string_view option);

/// `count` finite numbers with commas between them, each read to the nearest double. Hexadecimal
/// floats (0x1.8p-3) are welcome: that is how `pierce check` prints numbers.
[[nodiscard]] std::vector<double> parse_numbers(std::string_view text, std::size_t count,
                                                std::string_view option);

[[nodiscard]] Vec3<double> parse_vector(std::string_view text, std::string_view option);

/// "1024x768"; each side 1 to 65535.
[[nodiscard]] ImageSize parse_size(std::string_view text, std::string_view option);

}  // namespace pierce::tool
