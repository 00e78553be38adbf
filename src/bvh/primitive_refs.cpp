// SPDX-License-Identifier: Apache-2.0
#include "bvh/primitive_refs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pierce::bvh {

HugeBuffer<PrimitiveRef> make_primitive_refs(const Primitives& primitives, std::uint32_t capacity,
                                             BuildControl& control) {
  HugeBuffer<PrimitiveRef> refs(capacity);
  tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, primitives.size(), 16384),
                    [&](const tbb::blocked_range<std::uint32_t>& range) {
                      for (std::uint32_t i = range.begin(); i != range.end(); ++i) {
                        refs[i] = PrimitiveRef(box_of(primitives.corners(i)), i);
                      }
                      control.advance(range.size());
                    });
  return refs;
}

}  // namespace pierce::bvh
