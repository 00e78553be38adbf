// SPDX-License-Identifier: Apache-2.0
//
// The sum of solid angles without SIMD: the operations of winding-inl.h in their order.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bvh/tree.h"
#include "kernels/points/winding.h"
#include "predicate/angle.h"

namespace pierce::kernels {
namespace {

struct Triple {
  double x, y, z;
};

double dot(const Triple& p, const Triple& q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }

double expansion(const WindingNode& node, int lane, const Triple& d, double inverse_square) {
  double powers[kWindingOrder + 1];
  powers[1] = d.z;
  for (int i = 2; i <= kWindingOrder; ++i) powers[i] = powers[i - 1] * d.z;
  double sum = 0;
  int next = kWindingTerms;
  for (int degree = kWindingOrder; degree > 0; --degree) {
    next -= (degree + 1) * (degree + 2) / 2;
    int t = next;
    double in_x = 0;
    for (int left = 0; left <= degree; ++left) {
      double in_y = node.term[t++][lane];
      for (int c = 1; c <= left; ++c) in_y = in_y * d.y + node.term[t++][lane] * powers[c];
      in_x = left == 0 ? in_y : in_x * d.x + in_y;
    }
    sum = degree == kWindingOrder ? in_x : sum * inverse_square + in_x;
  }
  return sum;
}

bool add_cluster(const WindingNode& node, int lane, const double* point, double share,
                 winding::Lanes& lanes) {
  const Triple d{point[0] - node.centre[0][lane], point[1] - node.centre[1][lane],
                 point[2] - node.centre[2][lane]};
  const double square = dot(d, d);
  const double inverse = 1.0 / square;
  const double inverse_length = std::sqrt(square) * inverse;
  const double ratio = node.radius[lane] * inverse_length;
  double power = inverse;
  for (int l = 0; l < kWindingOrder; l += 2) power *= inverse;
  const double factor = winding::kLeastLeft + winding::kMoreLeft * ratio;
  const double bound =
      node.bound[lane] * power * factor + node.area[lane] * inverse * winding::kRounding;
  if (!(ratio <= 0.5 && bound <= share && square >= winding::kNearestSquare)) return false;
  lanes.far[lane] += expansion(node, lane, d, inverse) * (inverse_length * inverse);
  lanes.far_error[lane] += bound;
  return true;
}

bool add_triangle(const WindingLeaf& leaf, std::uint32_t lane, const double* point,
                  winding::Lanes& lanes) {
  const auto corner = [&](int row) {
    return Triple{leaf.corner[row][lane] - point[0], leaf.corner[row + 1][lane] - point[1],
                  leaf.corner[row + 2][lane] - point[2]};
  };
  const Triple a = corner(0), b = corner(3), c = corner(6);
  const double aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
  const double la = std::sqrt(aa), lb = std::sqrt(bb), lc = std::sqrt(cc);
  const Triple n{b.y * c.z - b.z * c.y, b.z * c.x - b.x * c.z, b.x * c.y - b.y * c.x};
  const double up = dot(a, n);
  const double size = la * lb * lc;
  const double across = (size + dot(a, b) * lc) + (dot(b, c) * la + dot(c, a) * lb);
  const double larger = std::max(across, std::fabs(up));
  if (!(larger >= size * winding::kSmallest && across > 0 &&
        std::min({aa, bb, cc}) >= winding::kNearestCorner)) {
    return false;
  }
  const double inverse = 1.0 / larger;
  const double x = across * inverse, y = up * inverse;
  const double re = lanes.real[lane], im = lanes.imaginary[lane];
  const double new_re = re * x - im * y, new_im = re * y + im * x;
  if (im >= 0 && y >= 0 && new_im < 0) lanes.turns[lane] += 1;
  if (im < 0 && y < 0 && new_re < 0 && new_im >= 0) lanes.turns[lane] -= 1;
  lanes.real[lane] = new_re;
  lanes.imaginary[lane] = new_im;
  lanes.error[lane] += size * inverse;
  return true;
}

void scale_lanes(winding::Lanes& lanes) {
  for (int i = 0; i < kWindingLanes; ++i) {
    const double inverse = 1.0 / (std::fabs(lanes.real[i]) + std::fabs(lanes.imaginary[i]));
    lanes.real[i] *= inverse;
    lanes.imaginary[i] *= inverse;
  }
}

}  // namespace

WindingSum winding_plain(const WindingTree& tree, const double* point, double share,
                         WindingResolver& resolver) {
  winding::Lanes lanes{};
  std::fill_n(lanes.real, kWindingLanes, 1.0);
  std::uint32_t stack[kWindingLanes * bvh::kMaxDepth];
  std::uint32_t* top = stack;
  std::uint32_t leaves = 0;
  if (tree.root != bvh::kNoChild) *top++ = tree.root;
  while (top != stack) {
    const std::uint32_t ref = *--top;
    if (bvh::is_leaf(ref)) {
      const WindingLeaf& leaf = tree.leaves[ref & ~bvh::kLeafBit];
      for (std::uint32_t i = 0; i < leaf.count; ++i) {
        if (!add_triangle(leaf, i, point, lanes)) resolver.near(leaf.triangle[i]);
      }
      if (++leaves % winding::kLeavesPerScaling == 0) scale_lanes(lanes);
      continue;
    }
    const WindingNode& node = tree.nodes[ref];
    for (int i = 0; i < kWindingLanes; ++i) {
      const bool open = !add_cluster(node, i, point, share, lanes);
      if (open && node.child[i] != bvh::kNoChild) *top++ = node.child[i];
    }
  }
  if (leaves == 0) return winding::sum_of(lanes, nullptr);
  double angle[kWindingLanes];
  for (int i = 0; i < kWindingLanes; ++i) {
    angle[i] = predicate::angle_of(lanes.real[i], lanes.imaginary[i]);
  }
  return winding::sum_of(lanes, angle);
}

}  // namespace pierce::kernels
