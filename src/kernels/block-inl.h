// SPDX-License-Identifier: Apache-2.0
//
// A block of rays: neighbours that run alike go together as packets, all others as a stream.
#if defined(PIERCE_KERNELS_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PIERCE_KERNELS_BLOCK_INL_H_
#undef PIERCE_KERNELS_BLOCK_INL_H_
#else
#define PIERCE_KERNELS_BLOCK_INL_H_
#endif

#include <algorithm>

#include "kernels/packet_walk-inl.h"
#include "kernels/road-inl.h"
#include "kernels/stream-inl.h"

HWY_BEFORE_NAMESPACE();
namespace pierce::kernels::HWY_NAMESPACE {

// Calls `packet(base, p)` for each sixteen rays that run alike, then `stream(rest)`.
template <class OnPacket, class OnStream>
HWY_INLINE void for_packets(const RayBlock& block, Referees& referees, const OnPacket& packet,
                            const OnStream& stream) {
  Packet p;
  Stream rest;
  rest.block = &block;
  rest.referees = &referees;
  for (std::uint32_t base = 0; base < block.count; base += kPacketSize) {
    const std::uint32_t size = std::min(kPacketSize, block.count - base);
    const bool alike = block.raw != nullptr ? make_packet(block.raw + base, block.scale, size, p)
                                            : make_packet(block.rays + base, size, p);
    if (alike) {
      packet(base, p);
      continue;
    }
    if (block.raw != nullptr) {
      quick_roads(block.scale, block.raw + base, size, block.rays + base);
    }
    for (std::uint32_t i = 0; i < size; ++i) rest.numbers[rest.count++] = base + i;
  }
  if (rest.count != 0) stream(rest);
}

inline void closest_block(const bvh::Tree& tree, const RayBlock& block, Referees& referees,
                          Candidate* out, KernelCounts* counts) {
  if (tree.root == bvh::kNoChild) {
    std::fill(out, out + block.count, Candidate{});
    return;
  }
  for_packets(
      block, referees,
      [&](std::uint32_t base, Packet& p) {
        closest_packet({&tree, &block, base, &p, &referees, counts}, out);
      },
      [&](const Stream& rest) {
        run_stream<false>(tree, rest, counts,
                          [&](std::uint32_t ray, const Candidate& hit) { out[ray] = hit; });
      });
}

inline void any_block(const bvh::Tree& tree, const RayBlock& block, Referees& referees,
                      std::uint8_t* out, KernelCounts* counts) {
  std::fill(out, out + block.count, std::uint8_t{0});
  if (tree.root == bvh::kNoChild) return;
  for_packets(
      block, referees,
      [&](std::uint32_t base, Packet& p) {
        any_packet({&tree, &block, base, &p, &referees, counts}, out);
      },
      [&](const Stream& rest) {
        run_stream<true>(tree, rest, counts, [&](std::uint32_t ray, const Candidate& hit) {
          out[ray] = hit.primitive != kNone ? 1 : 0;
        });
      });
}

}  // namespace pierce::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard
