// SPDX-License-Identifier: Apache-2.0
//
// RecordFile: rows of named columns on their way to a .npy or .csv file. One call for each number
// serves both; the format is looked at in one place.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "io/output_file.h"

namespace pierce::io {

struct RecordColumn {
  std::string_view name;
  std::string_view type;  ///< NumPy's: "<f4"
};

static_assert(std::endian::native == std::endian::little, "records are written as in memory");

class RecordFile {
 public:
  /// A single column makes a plain .npy array, several a structured one. Throws Error
  /// (InvalidArgument) if the name ends in neither .npy nor .csv.
  RecordFile(const std::filesystem::path& path, std::span<const RecordColumn> columns);

  /// The columns of one row, in order, each in its own type.
  template <class... Values>
  void row(Values... values) {
    if (csv_) {
      char separator = '\n';  // ends the line before
      ((put_text(separator, values), separator = ','), ...);
    } else {
      std::array<char, (sizeof(Values) + ...)> record;
      char* at = record.data();
      ((std::memcpy(at, &values, sizeof(Values)), at += sizeof(Values)), ...);
      file_.write({record.data(), record.size()});
    }
    ++rows_;
  }

  void finish();

 private:
  // The shortest text that reads back as the same number.
  template <class Value>
  void put_text(char separator, Value value) {
    std::array<char, 32> text = {separator};
    char* const first = text.data() + 1;
    char* end = first + 1;
    if constexpr (std::is_same_v<Value, bool>) {
      *first = value ? '1' : '0';
    } else {
      end = std::to_chars(first, text.data() + text.size(), value).ptr;
    }
    file_.write({text.data(), static_cast<std::size_t>(end - text.data())});
  }

  OutputFile file_;
  std::string descr_;
  bool csv_;
  std::uint64_t rows_ = 0;
};

}  // namespace pierce::io
