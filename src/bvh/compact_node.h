// SPDX-License-Identifier: Apache-2.0
//
// The data sheet of the compact tree (Quality::Compact): the same tree as in node.h in half the
// memory. Boxes are 8-bit steps in the frame of their node, corners 16-bit steps in the frame of
// their leaf. Child references are those of node.h.
//
// CompactNode (128 bytes, 2 cache lines, aligned to 64):
//
//   offset  0  origin x y z, 0    floats
//          16  step x y z, 0      floats of at most 16 significant bits, at least kLeastStep
//          32  lower x of the 8 children, lower y, lower z     8 bits each
//          56  upper x, upper y, upper z
//          80  child references
//         112  pad
//
// A plane is origin + q step, rounded to float once (q step is exact, with fma or without); that
// number is outward of the true box.
// Unused lanes have lower = 255 and upper = 0 and the reference kNoChild. Because of kLeastStep
// their boxes are turned inside out by 255 * 2^-20, far more than the pad of the box test, so no
// ray enters them.
//
// Compact leaf block of n triangles, 16 + 22 n bytes, rounded up to a multiple of kLeafUnit (192
// bytes, three cache lines, for eight):
//
//   origin x y z         floats: the corner of the box of all its corners
//   step                 float of at most 8 significant bits, the same for x, y, z
//   ax[n] ay[n] az[n] bx[n] ... cz[n]     uint16: a coordinate is origin + q step, rounded once
//   primitive[n]         uint32, at an offset that is even but, for odd n, no multiple of 4
//
// A coordinate is within step / 2 + 2^-23 of the true one, and no edge has a component larger than
// 65535 step, rounded. Rows are read 8 wide, past their end; the leaf memory ends in kLeafSlack.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bvh/node.h"

namespace pierce::bvh {

/// Planes that are nearer together than the pad of the box test are not worth telling apart.
inline constexpr float kLeastStep = 0x1p-20F;

struct alignas(64) CompactNode {
  float origin[4];
  float step[4];
  std::uint8_t lower[3][kWidth];
  std::uint8_t upper[3][kWidth];
  std::uint32_t child[kWidth];
  std::uint32_t pad[4];
};
static_assert(sizeof(CompactNode) == 128);

}  // namespace pierce::bvh
