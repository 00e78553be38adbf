// SPDX-License-Identifier: Apache-2.0
//
// PrivateMapping: a file as memory that may be written to, which changes nothing but this process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace pierce {

/// Pages are read when they are first looked at and shared with all who map the same file, until
/// somebody writes to one, who gets a copy. Throws Error (BadFile): "name: ...".
class PrivateMapping {
 public:
  explicit PrivateMapping(const std::string& path);
  PrivateMapping(const PrivateMapping&) = delete;
  PrivateMapping& operator=(const PrivateMapping&) = delete;
  ~PrivateMapping();

  [[nodiscard]] std::span<std::byte> bytes() const { return bytes_; }
  /// Tells the system that these bytes are about to be read.
  void expect(std::uint64_t offset, std::uint64_t bytes) const;

 private:
  std::span<std::byte> bytes_;
};

}  // namespace pierce
