// SPDX-License-Identifier: Apache-2.0
//
// NumPy's .npz: a ZIP archive of .npy files, stored as they are, without compression.
// Source: PKWARE, APPNOTE.TXT (".ZIP File Format Specification").
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/output_file.h"
#include "io/spool_file.h"

namespace pierce::io {

/// The check sum of ZIP (CRC-32, reflected, 0xedb88320). `crc` is that of what came before, 0 at
/// the start.
[[nodiscard]] std::uint32_t crc32(std::uint32_t crc, std::string_view bytes);

/// Writes an archive, one member after the other.
class NpzWriter {
 public:
  static constexpr std::uint64_t kZipLimit = 0xffffffff;  ///< of a size in 32 bits

  /// Sizes and places from `limit` on take 64 bits: ZIP64. Another limit is for tests.
  explicit NpzWriter(OutputFile& file, std::uint64_t limit = kZipLimit)
      : file_(file), limit_(limit) {}

  /// The array `name` (without ".npy"): its header, and then its data.
  void add(const std::string& name, const std::string& header, SpoolFile& data);

  /// What stands at the end of the archive. Does not commit the file.
  void finish();

 private:
  struct Member {
    std::string name;
    std::uint32_t crc;
    std::uint64_t size, offset;
  };

  void put(std::string_view bytes);
  [[nodiscard]] std::string central_entry(const Member& member) const;

  OutputFile& file_;
  std::uint64_t limit_, written_ = 0;
  std::vector<Member> members_;
};

}  // namespace pierce::io
