// SPDX-License-Identifier: Apache-2.0
//
// The build, phase by phase: boxes, binary tree, second thoughts about its upper part, collapse.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "bvh/binary_build.h"
#include "bvh/box.h"
#include "bvh/collapse.h"
#include "bvh/forests.h"
#include "bvh/leaf_block.h"
#include "bvh/primitive_refs.h"
#include "bvh/reinsertion.h"
#include "bvh/tree.h"
#include "pierce/vector.h"
#include "support/build_control.h"
#include "support/parallel.h"

namespace pierce::bvh {

namespace {

/// What spatial splits may add to the number of refs.
constexpr double kSpatialBudget = 0.3;

/// Of Balanced where boxes_are_airy.
constexpr BinaryBuildSettings kCuttingSettings = {
    .stop_at = 4, .sample = 2048, .spatial_splits = true};

BinaryBuildSettings settings_for(Quality quality) {
  switch (quality) {
    case Quality::Fast:
      return {.stop_at = kWidth, .sample = 512};
    case Quality::High:
      return {.stop_at = 1, .sample = 8192, .spatial_splits = true};
    case Quality::Balanced:
    case Quality::Compact:
      break;
  }
  return {.stop_at = kWidth, .sample = 2048};
}

/// Whether boxes hold mostly air, as those of long thin triangles askew do, and many lie in one
/// another: then cutting pays, wherever that is. A random line meets a triangle, or its box, with a
/// chance in proportion to their areas.
bool boxes_are_airy(const PrimitiveRef* refs, std::uint32_t count, const Primitives& primitives) {
  constexpr double kAir = 16;    // areas of boxes over areas of triangles: 2 ... 5 for most meshes
  constexpr double kDepth = 50;  // boxes that a line through the scene meets
  constexpr std::uint32_t kSample = 4096;
  const std::uint32_t stride = std::max(count / kSample, 1U);
  double boxes = 0, triangles = 0;
  for (std::uint32_t i = 0; i < count; i += stride) {
    const Corners c = primitives.corners(refs[i].primitive());
    boxes += static_cast<double>(half_area(refs[i].box));
    const Vec3<double> normal = cross(c.b - c.a, c.c - c.a);
    triangles += 0.5 * std::sqrt(dot(normal, normal));
  }
  if (boxes <= kAir * triangles) return false;
  Box whole;
  for (std::uint32_t i = 0; i < count; ++i) whole.grow(refs[i].box);
  return boxes * stride > kDepth * static_cast<double>(half_area(whole));
}

/// Even full leaves, eight triangles each, must have a place that a reference can name.
void check_size(std::uint32_t count, Layout layout) {
  const std::uint64_t blocks = (std::uint64_t{count} + kWidth - 1) / kWidth;
  if (blocks * leaf_units(layout, kWidth) <= leaf_offset(~0U)) return;
  throw Error(
      ErrorCode::TooManyTriangles,
      std::to_string(count) + " triangles are more than one search tree can hold (" +
          std::to_string(std::uint64_t{leaf_offset(~0U)} / leaf_units(layout, kWidth) * kWidth) +
          "); split the scene");
}

Tree build_here(const Primitives& primitives, const BuildOptions& options, Layout layout,
                bool single_leaves = false) {
  BuildControl control(options.work);
  control.poll();
  const std::uint32_t count = primitives.size();
  if (count == 0) return {};
  check_size(count, layout);
  BinaryBuildSettings settings = settings_for(options.quality);
  if (single_leaves) settings = {.stop_at = 1, .sample = 2048, .largest_leaf = 1};
  const bool may_cut = options.quality != Quality::Fast && layout == Layout::Full;
  const std::uint64_t budget = may_cut ? static_cast<std::uint64_t>(kSpatialBudget * count) : 0;
  auto capacity = static_cast<std::uint32_t>(
      std::min<std::uint64_t>(count + budget, std::numeric_limits<std::uint32_t>::max()));

  control.phase(0.0, 0.15, count);
  HugeBuffer<PrimitiveRef> refs = make_primitive_refs(primitives, capacity, control);
  if (!single_leaves && options.quality == Quality::Balanced &&
      boxes_are_airy(refs.data(), count, primitives)) {
    settings = kCuttingSettings;
  }
  if (!settings.spatial_splits) capacity = count;
  Tree tree;
  tree.layout = layout;
  if (layout == Layout::Compact) tree.primitives = &primitives;
  tree.leaves = HugeBuffer<std::byte>(max_leaf_bytes(capacity));
  // Until full leaves are written, their memory is the builder's second buffer. Compact leaves
  // would not use up what it touches.
  HugeBuffer<PrimitiveRef> own_scratch(layout == Layout::Compact ? capacity : 0);
  PrimitiveRef* const scratch = layout == Layout::Compact
                                    ? own_scratch.data()
                                    : reinterpret_cast<PrimitiveRef*>(tree.leaves.data());
  control.phase(0.15, 0.7, binary_build_steps(count));
  BinaryTree binary =
      build_binary(refs.data(), scratch, count, capacity, primitives, settings, control);
  if (options.quality != Quality::Fast) reinsert_largest(binary, control);
  choose_forests(binary, settings.largest_leaf, control);
  own_scratch.clear();
  refs.clear();
  control.phase(0.7, 1.0, count);
  collapse(binary, primitives, control, tree);
  control.poll();
  control.report(1);
  return tree;
}

}  // namespace

Tree build_over_boxes(const Primitives& boxes, const WorkOptions& work) {
  return parallel::with_threads(work.threads, [&] {
    Tree tree = build_here(boxes, {.work = work}, Layout::Compact, true);
    tree.primitives = nullptr;  // nobody asks for their corners
    return tree;
  });
}

Tree build(const Primitives& primitives, const BuildOptions& options, Layout layout) {
  return parallel::with_threads(options.work.threads,
                                [&] { return build_here(primitives, options, layout); });
}

}  // namespace pierce::bvh
