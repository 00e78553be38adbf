// SPDX-License-Identifier: Apache-2.0
//
// SpoolFile: bytes that wait on the disk, in a file without a name, until they can be passed on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

/// Makes a file without a name in `folder` and returns its descriptor; -1 with errno if it cannot.
/// It is gone when it is closed, however the program ends.
[[nodiscard]] int open_unnamed_file(const std::filesystem::path& folder);

/// All failures throw Error (BadFile) that begins with `name`.
class SpoolFile {
 public:
  SpoolFile(const std::filesystem::path& folder, std::string name);
  SpoolFile(SpoolFile&&) noexcept;
  SpoolFile& operator=(SpoolFile&&) = delete;
  ~SpoolFile();

  void write(std::string_view bytes) {
    if (buffer_.size() + bytes.size() > buffer_.capacity()) flush();
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }

  [[nodiscard]] std::uint64_t size() const { return flushed_ + buffer_.size(); }

  /// Hands over all that was written, piece by piece.
  void read_all(const std::function<void(std::string_view)>& consumer);

 private:
  void flush();

  std::string name_;
  int descriptor_ = -1;
  std::uint64_t flushed_ = 0;
  std::vector<char> buffer_;
};

}  // namespace pierce::io
