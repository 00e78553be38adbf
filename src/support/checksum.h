// SPDX-License-Identifier: Apache-2.0
//
// Checksums of bytes: the 64-bit hash XXH64, seed 0, the same on every machine. It notices damage;
// it is no signature.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pierce {

/// XXH64 of the bytes. Several bytes a nanosecond on one core.
[[nodiscard]] std::uint64_t xxh64(std::span<const std::byte> bytes);

/// Of much data, on the threads that parallel work has: XXH64 of the checksums of its pieces of
/// kChecksumPiece bytes, the last one shorter; each is a little-endian 64-bit number. `between()`
/// is called now and then, by several threads at a time.
inline constexpr std::size_t kChecksumPiece = std::size_t{1} << 22;
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes, void (*between)(const void*),
                                     const void* context);
[[nodiscard]] std::uint64_t checksum(std::span<const std::byte> bytes);

}  // namespace pierce
