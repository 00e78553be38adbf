// SPDX-License-Identifier: Apache-2.0
#include "bvh/primitive_refs.h"

#include "support/parallel.h"

namespace pierce::bvh {

HugeBuffer<PrimitiveRef> make_primitive_refs(const Primitives& primitives, std::uint32_t capacity,
                                             BuildControl& control) {
  HugeBuffer<PrimitiveRef> refs(capacity);
  parallel::for_ranges(std::uint32_t{0}, primitives.size(), 16384,
                       [&](std::uint32_t first, std::uint32_t last) {
                         for (std::uint32_t i = first; i != last; ++i) {
                           refs[i] = PrimitiveRef(box_of(primitives.corners(i)), i);
                         }
                         control.advance(last - first);
                       });
  return refs;
}

}  // namespace pierce::bvh
