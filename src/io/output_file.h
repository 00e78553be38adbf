// SPDX-License-Identifier: Apache-2.0
//
// OutputFile: a file that appears under its name only when it is complete.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace pierce::io {

/// Standard output's reader has gone away.
class BrokenPipe : public std::runtime_error {
 public:
  BrokenPipe() : std::runtime_error("standard output: its reader has gone away") {}
};

/// Writes to a temporary name in the same folder; `commit` renames it. Destroyed before that, it
/// removes what it wrote. All failures (no such folder, no permission, full disk) throw Error
/// (BadFile). A symbolic link is followed; a target that exists and is no regular file (a folder, a
/// device) is refused, for a rename would replace it.
///
/// "-" stands for standard output: it gets everything at `commit`, so that it may be a pipe, and
/// nothing if there is none; until then the bytes are in a file without a name in the folder for
/// temporary files. `commit` then may throw BrokenPipe, too.
class OutputFile {
 public:
  explicit OutputFile(std::filesystem::path path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Fails here and now if so many bytes will not fit the disk, where the system can tell.
  void reserve(std::uint64_t bytes);

  void write(std::string_view bytes);

  /// Overwrites bytes that were written before; for headers whose counts are known at the end.
  void rewrite(std::uint64_t offset, std::string_view bytes);

  void commit();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Where there is room for what belongs to it.
  [[nodiscard]] std::filesystem::path folder() const;

 private:
  void open_named();
  void copy_to_standard_output();
  void flush();
  void put(std::string_view bytes, std::uint64_t offset);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;       ///< as the caller named it
  std::filesystem::path target_;     ///< links resolved
  std::filesystem::path temporary_;  ///< empty: standard output
  int descriptor_ = -1;
  std::uint64_t flushed_ = 0;
  std::vector<char> buffer_;
};

/// Removes the temporary files of all OutputFiles that are under way in any thread. For a program
/// that is about to end without destroying them: threads that begin, commit or destroy one
/// afterwards wait for ever, so that none can appear any more. Not for signal handlers: it locks.
void abandon_output_files();

}  // namespace pierce::io
