// SPDX-License-Identifier: Apache-2.0
//
// RecordFile: rows of named columns on their way to a .npy, .npz or .csv file. One call for each
// row serves all; the format is looked at in one place.
#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "io/output_file.h"
#include "io/record_target.h"
#include "io/spool_file.h"

namespace pierce::io {

struct RecordColumn {
  std::string_view name;
  std::string_view type;  ///< NumPy's: "<f4"
};

static_assert(std::endian::native == std::endian::little, "records are written as in memory");

class RecordFile {
 public:
  /// .npy: a single column makes a plain array, several one of records laid out as a C struct of
  /// these members would be, what lies between them zero. .npz: an array a column.
  RecordFile(const RecordTarget& target, std::span<const RecordColumn> columns);

  /// The columns of one row, in order, each in its own type.
  template <class... Values>
  void row(Values... values) {
    switch (format_) {
      case RecordFormat::Csv: {
        char separator = '\n';  // ends the line before
        ((put_text(separator, values), separator = ','), ...);
        break;
      }
      case RecordFormat::Npy: {
        std::array<char, struct_bytes<Values...>()> record{};
        std::size_t at = 0;
        (put_member(record.data(), at, values), ...);
        file_.write({record.data(), record.size()});
        break;
      }
      case RecordFormat::Npz: {
        SpoolFile* column = columns_.data();
        (column++->write({reinterpret_cast<const char*>(&values), sizeof(Values)}), ...);
        break;
      }
    }
    ++rows_;
  }

  void finish();

 private:
  static constexpr std::size_t aligned(std::size_t at, std::size_t size) {
    return (at + size - 1) / size * size;
  }
  template <class... Values>
  static constexpr std::size_t struct_bytes() {
    std::size_t at = 0, largest = 1;
    ((at = aligned(at, sizeof(Values)) + sizeof(Values),
      largest = largest < sizeof(Values) ? sizeof(Values) : largest),
     ...);
    return aligned(at, largest);
  }
  template <class Value>
  static void put_member(char* record, std::size_t& at, Value value) {
    at = aligned(at, sizeof(Value));
    std::memcpy(record + at, &value, sizeof(Value));
    at += sizeof(Value);
  }

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
  RecordFormat format_;
  std::vector<std::string> names_, types_;
  std::string descr_;               ///< of .npy
  std::vector<SpoolFile> columns_;  ///< of .npz
  std::uint64_t rows_ = 0;
};

}  // namespace pierce::io
