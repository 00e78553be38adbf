// SPDX-License-Identifier: Apache-2.0
//
// MappedFile: a file's bytes as memory, paged in by the system as they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace pierce::io {

/// Opens `path` for reading and returns its descriptor and size. Throws Error (BadFile) if it does
/// not exist, is a folder, a pipe or a device, may not be read, or is empty.
struct OpenedFile {
  int descriptor = -1;
  std::uint64_t size = 0;
};
[[nodiscard]] OpenedFile open_regular_file(const std::filesystem::path& path);

class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path);
  /// The first `size` bytes of an open file, which may be closed afterwards; `name` is for errors.
  MappedFile(int descriptor, std::uint64_t size, const std::string& name);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] std::string_view bytes() const { return bytes_; }

 private:
  void map(int descriptor, std::uint64_t size, const std::string& name);

  std::string_view bytes_;
};

}  // namespace pierce::io
