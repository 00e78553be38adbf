// SPDX-License-Identifier: Apache-2.0
//
// ZipArchive: the members of a ZIP file, by libzip.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace pierce::io {

/// The bytes must outlive it. All failures throw Error (BadFile).
class ZipArchive {
 public:
  ZipArchive(std::string_view bytes, const std::string& name);
  ~ZipArchive();

  /// In their order, folders too.
  [[nodiscard]] std::vector<std::string> members() const;
  [[nodiscard]] bool has(const std::string& member) const;
  /// Unpacked. Names of members are the same in whatever case.
  [[nodiscard]] std::string read(const std::string& member) const;

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
  const std::string& name_;
};

}  // namespace pierce::io
