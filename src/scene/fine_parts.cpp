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
// So many of the parts found last may be joined by the next: neighbours are found soon after.
constexpr std::size_t kNeighbours = 16;

class Finder {
 public:
  explicit Finder(const bvh::Tree& tree) : tree_(tree) {}

  std::vector<std::vector<std::uint32_t>> run() {
    if (bvh::is_leaf(tree_.root)) return {};
    visit_children(tree_.root);
    std::vector<std::vector<std::uint32_t>> found;
    for (Part& part : parts_) {
      std::vector<std::uint32_t> triangles = once(std::move(part.triangles));
      if (triangles.size() >= kLeastTriangles) {
        found.push_back(std::move(triangles));
      } else {
        rest_.insert(rest_.end(), triangles.begin(), triangles.end());
      }
    }
    if (!found.empty()) found.push_back(once(std::move(rest_)));
    return found;
  }

 private:
  struct Part {
    bvh::Box box;
    std::vector<std::uint32_t> triangles;  // perhaps twice
  };

  // Subtrees that are narrow enough for a space of their own, and need it; else what is below them.
  void visit_children(std::uint32_t ref) {
    const bvh::Node& node = tree_.nodes[ref];
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      const std::uint32_t child = node.child[i];
      const bvh::Box box = bvh::child_box(node, i);
      const bool leaf = bvh::is_leaf(child);
      if (!leaf && (!is_narrow(box) || is_two_heaps(child, box))) {
        visit_children(child);
        continue;
      }
      if (is_narrow(box) && is_coarse(child, [](const float* head) { return head[1]; })) {
        Part part{box, {}};
        gather(child, part.triangles);
        add(std::move(part));
      } else {
        gather(child, rest_);
      }
    }
  }

  // Most of the leaves are coarse, where their reach is this.
  template <class Reach>
  [[nodiscard]] bool is_coarse(std::uint32_t ref, const Reach& reach) const {
    std::size_t coarse = 0, leaves = 0;
    bvh::LeafScratch scratch;
    for_each_leaf(ref, [&](std::uint32_t leaf) {
      const float* head = bvh::leaf_block(tree_, leaf, scratch);
      ++leaves;
      coarse += head[0] < kCoarse * reach(head) ? 1 : 0;
    });
    return 2 * coarse > leaves;
  }

  // Most of the box is air, and so wide that a space of its own would be no good.
  [[nodiscard]] bool is_two_heaps(std::uint32_t ref, const bvh::Box& box) const {
    const bvh::Node& node = tree_.nodes[ref];
    float filled = 0;
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      filled += bvh::half_area(bvh::child_box(node, i));
    }
    return filled < 0.25F * bvh::half_area(box) &&
           is_coarse(ref, [own = 0.5F * width(box)](const float*) { return own; });
  }

  // A part and one of those before it become one where a ray that meets either mostly meets both:
  // the surface of their common box is no larger than theirs together. The floats of this space,
  // in which boxes are wide, decide that: the top tree has no others.
  void add(Part part) {
    const std::size_t oldest = parts_.size() > kNeighbours ? parts_.size() - kNeighbours : 0;
    for (std::size_t i = parts_.size(); i-- > oldest;) {
      Part& before = parts_[i];
      const bvh::Box common = bvh::merged(before.box, part.box);
      if (!is_narrow(common) ||
          bvh::half_area(common) > bvh::half_area(before.box) + bvh::half_area(part.box)) {
        continue;
      }
      before.triangles.insert(before.triangles.end(), part.triangles.begin(), part.triangles.end());
      Part joined{common, std::move(before.triangles)};
      parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(i));
      return add(std::move(joined));
    }
    parts_.push_back(std::move(part));
  }

  static float width(const bvh::Box& box) {
    return std::max(
        {box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
  }
  static bool is_narrow(const bvh::Box& box) {
    float far = 0;
    for (int k = 0; k < 3; ++k) {
      far = std::max({far, std::fabs(box.lower[k]), std::fabs(box.upper[k])});
    }
    return width(box) <= kNarrow * far;
  }

  template <class Visit>
  void for_each_leaf(std::uint32_t ref, const Visit& visit) const {
    if (bvh::is_leaf(ref)) return visit(ref);
    const bvh::Node& node = tree_.nodes[ref];
    for (int i = 0; i < bvh::kWidth && node.child[i] != bvh::kNoChild; ++i) {
      for_each_leaf(node.child[i], visit);
    }
  }
  void gather(std::uint32_t ref, std::vector<std::uint32_t>& triangles) const {
    for_each_leaf(ref, [&](std::uint32_t leaf) {
      const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree_, leaf);
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
  std::vector<Part> parts_;
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
  auto* const numbers = const_cast<bvh::LeafNumber*>(bvh::leaf_numbers(tree, ref));
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
