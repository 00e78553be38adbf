// SPDX-License-Identifier: Apache-2.0
//
// RecordTarget: where answers go, and in which form.
#pragma once

#include <cstdint>
#include <filesystem>

namespace pierce::io {

enum class RecordFormat : std::uint8_t { Npy, Npz, Csv };

struct RecordTarget {
  std::filesystem::path path;  ///< "-": standard output
  RecordFormat format;

  /// The form that the name ends in: .npy, .npz or .csv, in whatever case. Throws Error
  /// (InvalidArgument) for other names. Implicit: most who write name a file.
  RecordTarget(const std::filesystem::path& path);
  /// For standard output; no .npz, which only its reader could tell the end of.
  RecordTarget(std::filesystem::path path, RecordFormat format);
};

}  // namespace pierce::io
