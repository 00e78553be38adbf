// SPDX-License-Identifier: Apache-2.0
//
// Files packed by gzip or zstd ("scan.ply.gz", "points.npy.zst"), known by their first bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace pierce::io {

enum class Packing : std::uint8_t { None, Gzip, Zstd };

[[nodiscard]] Packing packing_of(std::string_view bytes);

/// "m.ply.gz" -> "m.ply"; names that do not end in .gz, .zst and the like stay as they are.
[[nodiscard]] std::string unpacked_name(const std::string& name);

/// How large `packed` bytes may become: 64 MiB or 200 times their size, whichever is more, and no
/// more than half of the machine's memory. Meshes and tables become 2 to 20 times as large.
[[nodiscard]] std::uint64_t unpacked_limit(std::uint64_t packed);

/// All that is packed in `bytes`, one after the other if there are several pieces; grows as it is
/// read, whatever the file announces. Throws Error (BadFile) if it was cut off or damaged, if it
/// is larger than the limit, or if this program was built without the library.
[[nodiscard]] std::string unpack(std::string_view bytes, const std::string& name);

// What unpack calls, one for each library; `out` grows up to `limit`. They return what is wrong,
// and the cure; empty if nothing is.
[[nodiscard]] std::string unpack_gzip(std::string_view bytes, std::uint64_t limit,
                                      std::string& out);
[[nodiscard]] std::string unpack_zstd(std::string_view bytes, std::uint64_t limit,
                                      std::string& out);

inline constexpr const char* kUnpacksToTooMuch = "too much";  ///< the limit was reached
inline constexpr const char* kPackedCutOff = "was cut off: get it again";

/// Makes room behind the `used` bytes of `out`, twice as much each time; false at the limit.
[[nodiscard]] bool grow_unpacked(std::string& out, std::size_t used, std::uint64_t limit);

}  // namespace pierce::io
