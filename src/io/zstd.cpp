// SPDX-License-Identifier: Apache-2.0
//
// zstd, by libzstd. Files of several frames are their contents in a row.
#include <fmt/format.h>
#include <zstd.h>

#include <memory>

#include "io/packed.h"

namespace pierce::io {

std::string unpack_zstd(std::string_view bytes, std::uint64_t limit, std::string& out) {
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(::ZSTD_createDCtx(),
                                                                        ::ZSTD_freeDCtx);
  if (context == nullptr) return "there is not enough memory to unpack it";
  ZSTD_inBuffer in = {bytes.data(), bytes.size(), 0};
  std::size_t used = 0;
  while (true) {
    if (used == out.size() && !grow_unpacked(out, used, limit)) return kUnpacksToTooMuch;
    ZSTD_outBuffer room = {out.data(), out.size(), used};
    const std::size_t state = ::ZSTD_decompressStream(context.get(), &room, &in);
    used = room.pos;
    if (::ZSTD_isError(state) != 0) {
      // Of windows beyond 128 MiB, too, which zstd's own command wants to be told to allow.
      return fmt::format("damaged or of an unusual kind ({}): get it again, or try unzstd",
                         ::ZSTD_getErrorName(state));
    }
    if (in.pos < in.size) continue;
    if (state == 0) break;
    if (room.pos < room.size) return kPackedCutOff;
  }
  if (used > limit) return kUnpacksToTooMuch;
  out.resize(used);
  return "";
}

}  // namespace pierce::io
