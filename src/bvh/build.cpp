// SPDX-License-Identifier: Apache-2.0
//
// The build, phase by phase: boxes, binary tree, collapse.
#include "bvh/binary_build.h"
#include "bvh/build_control.h"
#include "bvh/collapse.h"
#include "bvh/primitive_refs.h"
#include "bvh/tree.h"

namespace pierce::bvh {

Tree build(const Primitives& primitives, const BuildOptions& options) {
  BuildControl control(options);
  control.poll();
  if (primitives.size() == 0) return {};
  control.phase(0.0, 0.1, primitives.size());
  HugeBuffer<PrimitiveRef> refs = make_primitive_refs(primitives, control);
  control.phase(0.1, 0.8, primitives.size());
  const BinaryTree binary = build_binary(refs, control);
  control.phase(0.8, 1.0, primitives.size());
  Tree tree = collapse(binary, refs, primitives, control);
  control.report(1);
  return tree;
}

}  // namespace pierce::bvh
