// SPDX-License-Identifier: Apache-2.0
//
// XXH64 after its published specification: four sums take 8 bytes each in turn, are joined, and
// take what is left; multiplications and rotations spread every bit.
#include "support/checksum.h"

#include <bit>
#include <cstring>
#include <vector>

#include "support/parallel.h"

namespace pierce {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87U;
constexpr std::uint64_t kPrime2 = 0xC2B2AE3D27D4EB4FU;
constexpr std::uint64_t kPrime3 = 0x165667B19E3779F9U;
constexpr std::uint64_t kPrime4 = 0x85EBCA77C2B2AE63U;
constexpr std::uint64_t kPrime5 = 0x27D4EB2F165667C5U;

static_assert(std::endian::native == std::endian::little, "words are read as they lie");

template <class Word>
Word word_at(const std::byte* place) {
  Word word;
  std::memcpy(&word, place, sizeof word);
  return word;
}

std::uint64_t round_of(std::uint64_t sum, std::uint64_t word) {
  return std::rotl(sum + word * kPrime2, 31) * kPrime1;
}

std::uint64_t join(std::uint64_t hash, std::uint64_t sum) {
  return (hash ^ round_of(0, sum)) * kPrime1 + kPrime4;
}

}  // namespace

std::uint64_t xxh64(std::span<const std::byte> bytes) {
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  std::uint64_t hash = kPrime5;
  if (left >= 32) {
    std::uint64_t a = kPrime1 + kPrime2, b = kPrime2, c = 0, d = 0 - kPrime1;
    for (; left >= 32; at += 32, left -= 32) {
      a = round_of(a, word_at<std::uint64_t>(at));
      b = round_of(b, word_at<std::uint64_t>(at + 8));
      c = round_of(c, word_at<std::uint64_t>(at + 16));
      d = round_of(d, word_at<std::uint64_t>(at + 24));
    }
    hash = std::rotl(a, 1) + std::rotl(b, 7) + std::rotl(c, 12) + std::rotl(d, 18);
    for (const std::uint64_t sum : {a, b, c, d}) hash = join(hash, sum);
  }
  hash += bytes.size();
  for (; left >= 8; at += 8, left -= 8) {
    hash = std::rotl(hash ^ round_of(0, word_at<std::uint64_t>(at)), 27) * kPrime1 + kPrime4;
  }
  if (left >= 4) {
    hash = std::rotl(hash ^ (word_at<std::uint32_t>(at) * kPrime1), 23) * kPrime2 + kPrime3;
    at += 4;
    left -= 4;
  }
  for (; left > 0; ++at, --left) {
    hash = std::rotl(hash ^ (static_cast<std::uint64_t>(*at) * kPrime5), 11) * kPrime1;
  }
  hash = (hash ^ (hash >> 33)) * kPrime2;
  hash = (hash ^ (hash >> 29)) * kPrime3;
  return hash ^ (hash >> 32);
}

std::uint64_t checksum(std::span<const std::byte> bytes, void (*between)(const void*),
                       const void* context) {
  std::vector<std::uint64_t> sums((bytes.size() + kChecksumPiece - 1) / kChecksumPiece);
  parallel::for_each(std::size_t{0}, sums.size(), [&](std::size_t i) {
    if (between != nullptr) between(context);
    const std::span<const std::byte> rest = bytes.subspan(i * kChecksumPiece);
    sums[i] = xxh64(rest.first(rest.size() < kChecksumPiece ? rest.size() : kChecksumPiece));
  });
  return xxh64(std::as_bytes(std::span<const std::uint64_t>(sums)));
}

std::uint64_t checksum(std::span<const std::byte> bytes) {
  return checksum(bytes, nullptr, nullptr);
}

}  // namespace pierce
