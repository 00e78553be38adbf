// SPDX-License-Identifier: Apache-2.0
#include "scene/fine_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "bvh/box.h"
#include "bvh/leaf_access.h"

namespace pierce::scene {
namespace {

// A leaf is coarse if its edges are less than 2^9 eps of its reach: a sixth of what is hit is then
// no certain hit, and boxes are wider by a tenth.
constexpr float kCoarse = 0x1p-15F;
// A part's width, at most, times its distance from the centre.
constexpr float kNarrow = 0x1p-6F;
// Smaller ones are not worth a place in the top tree.
constexpr std::size_t kLeastTriangles = 64;

class Finder {
 public:
  explicit Finder(const bvh::Tree& tree) : tree_(tree) {}

  std::vector<std::vector<std::uint32_t>> run() {
    if (bvh::is_leaf(tree_.root)) return {};
    visit_children(tree_.root);
    if (parts_.empty()) return {};
    for (const std::uint32_t ref : others_) gather(ref, rest_);
    parts_.push_back(once(std::move(rest_)));
    return std::move(parts_);
  }

 private:
  // Subtrees that are narrow enough for a space of their own, and need it; else what is below them.
  void visit_children(std::uint32_t ref) {
    const bvh::Node& node = tree_.nodes[ref];
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      if (is_narrow(bvh::child_box(node, i))) {
        std::size_t coarse = 0, leaves = 0;
        count(node.child[i], coarse, leaves);
        if (2 * coarse > leaves) {
          std::vector<std::uint32_t> triangles;
          gather(node.child[i], triangles);
          triangles = once(std::move(triangles));
          if (triangles.size() >= kLeastTriangles) {
            parts_.push_back(std::move(triangles));
            continue;
          }
        }
        others_.push_back(node.child[i]);
      } else if (bvh::is_leaf(node.child[i])) {
        others_.push_back(node.child[i]);
      } else {
        visit_children(node.child[i]);
      }
    }
  }

  static bool is_narrow(const bvh::Box& box) {
    float width = 0, far = 0;
    for (int k = 0; k < 3; ++k) {
      width = std::max(width, box.upper[k] - box.lower[k]);
      far = std::max({far, std::fabs(box.lower[k]), std::fabs(box.upper[k])});
    }
    return width <= kNarrow * far;
  }

  template <class Visit>
  void for_each_leaf(std::uint32_t ref, const Visit& visit) const {
    if (bvh::is_leaf(ref)) return visit(ref);
    const bvh::Node& node = tree_.nodes[ref];
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      for_each_leaf(node.child[i], visit);
    }
  }
  void count(std::uint32_t ref, std::size_t& coarse, std::size_t& leaves) const {
    bvh::LeafScratch scratch;
    for_each_leaf(ref, [&](std::uint32_t leaf) {
      const float* head = bvh::leaf_block(tree_, leaf, scratch);
      ++leaves;
      coarse += head[0] < kCoarse * head[1] ? 1 : 0;
    });
  }
  void gather(std::uint32_t ref, std::vector<std::uint32_t>& triangles) const {
    for_each_leaf(ref, [&](std::uint32_t leaf) {
      const std::uint32_t* numbers = bvh::leaf_numbers(tree_, leaf);
      triangles.insert(triangles.end(), numbers, numbers + bvh::leaf_count(leaf));
    });
  }
  // One that was cut lies in several leaves.
  static std::vector<std::uint32_t> once(std::vector<std::uint32_t> triangles) {
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    return triangles;
  }

  const bvh::Tree& tree_;
  std::vector<std::vector<std::uint32_t>> parts_;
  std::vector<std::uint32_t> others_;  // references
  std::vector<std::uint32_t> rest_;
};

/// Some triangles of a scene, in a filter space of their own.
template <class Real>
class PartPrimitives final : public bvh::Primitives {
 public:
  PartPrimitives(const Geometries<Real>& scene, const std::vector<std::uint32_t>& triangles)
      : scene_(scene), triangles_(triangles) {
    for (const std::uint32_t number : triangles) {
      const predicate::TriangleD t = scene.triangle(number);
      for (const Vec3<double>& p : {t.a, t.b, t.c}) extent_.include(p);
    }
    space_ = space::FilterSpace(extent_.lower, extent_.upper);
  }
  [[nodiscard]] std::uint32_t size() const override {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  [[nodiscard]] bvh::Corners corners(std::uint32_t i) const override {
    const predicate::TriangleD t = scene_.triangle(triangles_[i]);
    return {space_.map(t.a), space_.map(t.b), space_.map(t.c)};
  }
  [[nodiscard]] const space::FilterSpace& space() const { return space_; }
  [[nodiscard]] const Extent& extent() const { return extent_; }

 private:
  const Geometries<Real>& scene_;
  const std::vector<std::uint32_t>& triangles_;
  Extent extent_;
  space::FilterSpace space_;
};

void rename(bvh::Tree& tree, std::uint32_t ref, const std::vector<std::uint32_t>& names) {
  if (!bvh::is_leaf(ref)) return;
  auto* const numbers = const_cast<std::uint32_t*>(bvh::leaf_numbers(tree, ref));
  for (std::uint32_t i = 0; i < bvh::leaf_count(ref); ++i) numbers[i] = names[numbers[i]];
}

}  // namespace

std::vector<std::vector<std::uint32_t>> fine_parts(const bvh::Tree& tree) {
  return Finder(tree).run();
}

template <class Real>
bvh::Tree tree_of_part(const Geometries<Real>& scene, const std::vector<std::uint32_t>& triangles,
                       const BuildOptions& options, Extent& extent, space::AffineMap& map) {
  const PartPrimitives<Real> primitives(scene, triangles);
  extent = primitives.extent();
  map = primitives.space().affine_map(false);
  bvh::Tree tree = bvh::build(primitives, options);
  rename(tree, tree.root, triangles);
  for (const bvh::Node& node : tree.nodes) {
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      rename(tree, node.child[i], triangles);
    }
  }
  return tree;
}

template bvh::Tree tree_of_part(const Geometries<float>&, const std::vector<std::uint32_t>&,
                                const BuildOptions&, Extent&, space::AffineMap&);
template bvh::Tree tree_of_part(const Geometries<double>&, const std::vector<std::uint32_t>&,
                                const BuildOptions&, Extent&, space::AffineMap&);

}  // namespace pierce::scene
