// SPDX-License-Identifier: Apache-2.0
//
// InputFile: the bytes of a table, from a file, from standard input, or from memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace pierce::io {

class MappedFile;

/// "-" stands for standard input; a file of that name is "./-". What comes through a pipe is kept
/// in memory, whole; an ordinary file is not, also as standard input. All failures throw Error
/// (BadFile) with the name.
class InputFile {
 public:
  explicit InputFile(const std::filesystem::path& path);
  InputFile(std::string contents, std::string name);
  InputFile(InputFile&&) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// The bytes from `offset` on; they must be there. Thread-safe.
  void read(std::uint64_t offset, std::span<char> out) const;

  /// All bytes at once, paged in as they are looked at. Valid as long as this file. Not
  /// thread-safe.
  [[nodiscard]] std::string_view bytes();

 private:
  void open_standard_input();

  std::string name_;
  int descriptor_ = -1;  ///< -1: in memory
  std::uint64_t start_ = 0, size_ = 0;
  std::string contents_;
  std::unique_ptr<MappedFile> map_;
};

}  // namespace pierce::io
