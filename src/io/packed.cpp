// SPDX-License-Identifier: Apache-2.0
#include "io/packed.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "io/bad_file.h"
#include "io/extension.h"

namespace pierce::io {

Packing packing_of(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return Packing::Gzip;
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return Packing::Zstd;
  // Parallel zstd begins with a frame to be skipped, whose first byte is 0x50 to 0x5f.
  const bool skipped = bytes.size() > 4 && (bytes[0] & 0xf0) == 0x50;
  return skipped && bytes.substr(1, 3) == "\x2a\x4d\x18" ? Packing::Zstd : Packing::None;
}

std::string unpacked_name(const std::string& name) {
  const std::filesystem::path path(name);
  for (const char* const extension : {".gz", ".gzip", ".z", ".zst", ".zstd"}) {
    if (has_extension(path, extension)) return name.substr(0, name.rfind('.'));
  }
  return name;
}

std::uint64_t unpacked_limit(std::uint64_t packed) {
  constexpr std::uint64_t kLeast = std::uint64_t{64} << 20, kRatio = 200;
  const auto memory = static_cast<std::uint64_t>(std::max(::sysconf(_SC_PHYS_PAGES), 0L)) *
                      static_cast<std::uint64_t>(std::max(::sysconf(_SC_PAGESIZE), 0L));
  return std::max(kLeast, std::min(kRatio * packed, memory / 2));
}

bool grow_unpacked(std::string& out, std::size_t used, std::uint64_t limit) {
  constexpr std::size_t kFirst = std::size_t{1} << 18;
  const auto most = static_cast<std::size_t>(limit) + 1;  // one more tells that it is too much
  out.resize(std::min(most, std::max(kFirst, 2 * used)));
  return used < most;
}

std::string unpack(std::string_view bytes, const std::string& name) {
  const bool gzip = packing_of(bytes) == Packing::Gzip;
  const std::uint64_t limit = unpacked_limit(bytes.size());
  std::string out;
  const std::string trouble =
      gzip ? unpack_gzip(bytes, limit, out) : unpack_zstd(bytes, limit, out);
  const char* const by = gzip ? "gzip" : "zstd";
  if (trouble == kUnpacksToTooMuch) {
    bad_file(name, fmt::format("is packed by {}, {} bytes, and holds more than {}: if that is "
                               "right, unpack it with {}",
                               by, bytes.size(), limit, gzip ? "gunzip" : "unzstd"));
  }
  if (!trouble.empty()) bad_file(name, fmt::format("is packed by {} and {}", by, trouble));
  if (out.empty()) bad_file(name, fmt::format("is packed by {} and empty: write it again", by));
  return out;
}

}  // namespace pierce::io
