// SPDX-License-Identifier: Apache-2.0
#include "io/npz.h"

#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace pierce::io {
namespace {

// How far a byte, followed by k zero bytes, gets the check sum: eight bytes go at a time.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables make_tables() {
  CrcTables tables{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t crc = i;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1u ? 0xedb88320u : 0u);
    tables[0][i] = crc;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t i = 0; i < 256; ++i) {
      const std::uint32_t before = tables[k - 1][i];
      tables[k][i] = before >> 8 ^ tables[0][before & 0xff];
    }
  }
  return tables;
}

constexpr CrcTables kTables = make_tables();

template <class Number>
void append(std::string& out, Number number) {
  static_assert(std::endian::native == std::endian::little, "numbers are written as in memory");
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}

constexpr std::uint16_t kVersion = 20, kVersion64 = 45;  // of ZIP, that a reader must know
constexpr std::uint16_t kZip64Tag = 1;
// Time and date: 1980-01-01, the first day that ZIP knows, so that the same answers make the same
// file.
constexpr std::uint32_t kStamp = (1u << 5 | 1u) << 16;

}  // namespace

std::uint32_t crc32(std::uint32_t crc, std::string_view bytes) {
  crc = ~crc;
  while (bytes.size() >= 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, bytes.data(), 8);
    eight ^= crc;
    crc = 0;
    for (std::size_t k = 0; k < 8; ++k) crc ^= kTables[7 - k][eight >> 8 * k & 0xff];
    bytes.remove_prefix(8);
  }
  for (const char c : bytes)
    crc = crc >> 8 ^ kTables[0][(crc ^ static_cast<unsigned char>(c)) & 0xff];
  return ~crc;
}

void NpzWriter::add(const std::string& name, const std::string& header, SpoolFile& data) {
  Member member = {name + ".npy", crc32(0, header), header.size() + data.size(), written_};
  data.read_all([&](std::string_view piece) { member.crc = crc32(member.crc, piece); });

  const bool large = member.size >= limit_;
  std::string head = "PK\x03\x04";
  append(head, large ? kVersion64 : kVersion);
  append(head, std::uint32_t{0});  // no flags, no compression
  append(head, kStamp);
  append(head, member.crc);
  for (int i = 0; i < 2; ++i) {  // compressed and not
    append(head, large ? std::uint32_t{0xffffffff} : static_cast<std::uint32_t>(member.size));
  }
  append(head, static_cast<std::uint16_t>(member.name.size()));
  append(head, static_cast<std::uint16_t>(large ? 20 : 0));
  head += member.name;
  if (large) {
    append(head, kZip64Tag);
    append(head, std::uint16_t{16});
    append(head, member.size);
    append(head, member.size);
  }
  put(head);
  put(header);
  data.read_all([this](std::string_view piece) { put(piece); });
  members_.push_back(std::move(member));
}

std::string NpzWriter::central_entry(const Member& member) const {
  const bool large = member.size >= limit_, far = member.offset >= limit_;
  std::string extra;
  if (large) {
    append(extra, member.size);
    append(extra, member.size);
  }
  if (far) append(extra, member.offset);

  std::string entry = "PK\x01\x02";
  append(entry, kVersion64);  // made by
  append(entry, large || far ? kVersion64 : kVersion);
  append(entry, std::uint32_t{0});
  append(entry, kStamp);
  append(entry, member.crc);
  for (int i = 0; i < 2; ++i) {
    append(entry, large ? std::uint32_t{0xffffffff} : static_cast<std::uint32_t>(member.size));
  }
  append(entry, static_cast<std::uint16_t>(member.name.size()));
  append(entry, static_cast<std::uint16_t>(extra.empty() ? 0 : extra.size() + 4));
  append(entry, std::uint16_t{0});  // no comment
  append(entry, std::uint16_t{0});  // on the first disk
  append(entry, std::uint16_t{0});  // not text
  append(entry, std::uint32_t{0});  // no attributes
  append(entry, far ? std::uint32_t{0xffffffff} : static_cast<std::uint32_t>(member.offset));
  entry += member.name;
  if (extra.empty()) return entry;
  append(entry, kZip64Tag);
  append(entry, static_cast<std::uint16_t>(extra.size()));
  return entry + extra;
}

void NpzWriter::finish() {
  const std::uint64_t start = written_, count = members_.size();
  for (const Member& member : members_) put(central_entry(member));
  const std::uint64_t size = written_ - start, end = written_;
  const bool far = start >= limit_ || size >= limit_;
  std::string tail;
  if (far) {
    tail += "PK\x06\x06";
    append(tail, std::uint64_t{44});  // bytes that follow
    append(tail, kVersion64);
    append(tail, kVersion64);
    append(tail, std::uint64_t{0});  // disks
    append(tail, count);
    append(tail, count);
    append(tail, size);
    append(tail, start);
    tail += "PK\x06\x07";
    append(tail, std::uint32_t{0});
    append(tail, end);
    append(tail, std::uint32_t{1});
  }
  tail += "PK\x05\x06";
  append(tail, std::uint32_t{0});  // disks
  append(tail, static_cast<std::uint16_t>(count));
  append(tail, static_cast<std::uint16_t>(count));
  append(tail, far ? std::uint32_t{0xffffffff} : static_cast<std::uint32_t>(size));
  append(tail, far ? std::uint32_t{0xffffffff} : static_cast<std::uint32_t>(start));
  append(tail, std::uint16_t{0});
  put(tail);
}

void NpzWriter::put(std::string_view bytes) {
  file_.write(bytes);
  written_ += bytes.size();
}

}  // namespace pierce::io
