// SPDX-License-Identifier: Apache-2.0
//
// What the tests of the readers and writers share: a folder that goes away, files as strings, and
// the text of the error that a call throws.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "pierce/error.h"

namespace pierce::io {

class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "pierce_io_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const {
    return path_ / name;
  }
  [[nodiscard]] std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(path_), {}));
  }

 private:
  std::filesystem::path path_;
};

inline std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The text of the Error (BadFile, if not told otherwise) that `call` throws; "" if it throws none.
template <class Call>
std::string error_of(Call call, ErrorCode expected = ErrorCode::BadFile) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), expected) << error.what();
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    return error.what();
  }
  return "";
}

/// `text` with every `from` replaced.
inline std::string replaced(std::string_view text, char from, std::string_view to) {
  std::string out;
  for (const char c : text) {
    if (c == from) {
      out += to;
    } else {
      out += c;
    }
  }
  return out;
}

/// The bytes of numbers one after the other, for binary files.
template <class... Values>
std::string little(Values... values) {
  std::string out;
  ((out.append(reinterpret_cast<const char*>(&values), sizeof values)), ...);
  return out;
}
template <class Value>
std::string reversed_bytes(Value value) {
  const std::string bytes = little(value);
  return {bytes.rbegin(), bytes.rend()};
}
template <class... Values>
std::string big(Values... values) {
  return (reversed_bytes(values) + ...);
}

}  // namespace pierce::io
