// SPDX-License-Identifier: Apache-2.0
//
// NewFile: a file that appears under its name only when it is complete. (The tool's own files go
// through io/output_file.h, which knows signals and standard output besides.)
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace pierce {

/// Written under a temporary name in the same folder; `commit` has the bytes stored and renames it.
/// Destroyed before that, it removes what it wrote. All failures (no such folder, no permission,
/// full disk) throw Error (BadFile).
class NewFile {
 public:
  explicit NewFile(std::string path);
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  ~NewFile();

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::string path_, temporary_;
  int descriptor_ = -1;
};

}  // namespace pierce
