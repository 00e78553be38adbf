// SPDX-License-Identifier: Apache-2.0
//
// gzip, by zlib. Files of several members (bgzip and others write them) are their contents, one
// after the other.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>

#include "io/packed.h"

namespace pierce::io {
namespace {

// A stream that is ended.
struct Inflation {
  z_stream stream = {};
  bool ready = false;
  Inflation() { ready = ::inflateInit2(&stream, 15 + 16) == Z_OK; }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;
  ~Inflation() {
    if (ready) ::inflateEnd(&stream);
  }
};

// zlib counts in 32 bits.
uInt at_once(std::size_t size) {
  return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max()));
}

// Tapes and downloads end in zeros.
bool only_zeros(std::string_view bytes) { return bytes.find_first_not_of('\0') == bytes.npos; }

}  // namespace

std::string unpack_gzip(std::string_view bytes, std::uint64_t limit, std::string& out) {
  Inflation inflation;
  if (!inflation.ready) return "zlib does not start: unpack it with gunzip";
  z_stream& stream = inflation.stream;
  std::size_t used = 0;
  while (true) {
    if (used == out.size() && !grow_unpacked(out, used, limit)) return kUnpacksToTooMuch;
    const uInt given = at_once(bytes.size()), room = at_once(out.size() - used);
    // zlib does not write there; its interface is older than const.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = given;
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + used);
    stream.avail_out = room;
    const int state = ::inflate(&stream, Z_NO_FLUSH);
    bytes.remove_prefix(given - stream.avail_in);
    used += room - stream.avail_out;
    if (state == Z_STREAM_END) {
      if (only_zeros(bytes)) break;
      if (packing_of(bytes) != Packing::Gzip) {
        return fmt::format("followed by {} bytes of something else: get it again", bytes.size());
      }
      ::inflateReset(&stream);
    } else if (state == Z_BUF_ERROR || (state == Z_OK && bytes.empty() && stream.avail_out > 0)) {
      return kPackedCutOff;
    } else if (state == Z_MEM_ERROR) {
      return "there is not enough memory to unpack it";
    } else if (state != Z_OK) {
      return fmt::format("damaged ({}): get it again",
                         stream.msg != nullptr ? stream.msg : "it needs a dictionary");
    }
  }
  if (used > limit) return kUnpacksToTooMuch;
  out.resize(used);
  return "";
}

}  // namespace pierce::io
