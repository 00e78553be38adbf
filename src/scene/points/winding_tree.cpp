// SPDX-License-Identifier: Apache-2.0
//
// Expansions of clusters: of |y|^l |r|^l P_l(cos) = K_l(y, r), a polynomial in both, the solid
// angle of a triangle about a centre is -sum over l of (integral of n . grad_y K_l) / |r|^(2l+1).
// So of each cluster the integrals of n . grad y^b are summed for all monomials y^b, which takes
// the centre elsewhere by binomials; then they are turned into one polynomial in r for each l.
#include "scene/points/winding_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bvh/leaf_access.h"
#include "support/for_chunks.h"

namespace pierce::scene {
namespace {

using kernels::kWindingLanes;
using kernels::kWindingOrder;
using kernels::kWindingTerms;
using kernels::WindingLeaf;
using kernels::WindingNode;
using kernels::WindingTree;

using Terms = std::array<double, kWindingTerms>;
using Point = std::array<double, 3>;

struct Power {
  int of[3];
};

constexpr int index_of(int x, int y, int z) {
  const int degree = x + y + z, left = y + z;
  return degree * (degree + 1) * (degree + 2) / 6 - 1 + left * (left + 1) / 2 + z;
}

constexpr std::array<Power, kWindingTerms> kPowers = [] {
  std::array<Power, kWindingTerms> powers{};
  for (int degree = 1; degree <= kWindingOrder; ++degree) {
    for (int x = degree; x >= 0; --x) {
      for (int y = degree - x; y >= 0; --y) {
        const int z = degree - x - y;
        powers[static_cast<std::size_t>(index_of(x, y, z))] = {{x, y, z}};
      }
    }
  }
  return powers;
}();

constexpr double factorial(int n) { return n <= 1 ? 1 : n * factorial(n - 1); }
constexpr double choose(int n, int k) { return factorial(n) / (factorial(k) * factorial(n - k)); }

// Calls `use(x, y, z, count)` for each monomial of (a + b + c)^n.
template <class Use>
constexpr void for_each_monomial(int n, const Use& use) {
  for (int x = 0; x <= n; ++x) {
    for (int y = 0; y <= n - x; ++y) {
      const int z = n - x - y;
      use(x, y, z, factorial(n) / (factorial(x) * factorial(y) * factorial(z)));
    }
  }
}

// Of y^b in K_l the polynomial in r, over 4 pi and with the sign that makes a winding number of it.
const std::vector<Terms>& kernel_table() {
  static const std::vector<Terms> kTable = [] {
    std::vector<Terms> table(kWindingTerms, Terms{});
    for (int l = 1; l <= kWindingOrder; ++l) {
      for (int j = 0; 2 * j <= l; ++j) {  // (y . r)^(l - 2j) (y^2 r^2)^j
        const double legendre =
            (j % 2 == 0 ? 1 : -1) * factorial(2 * l - 2 * j) /
            (std::ldexp(1.0, l) * factorial(j) * factorial(l - j) * factorial(l - 2 * j));
        for_each_monomial(l - 2 * j, [&](int ax, int ay, int az, double a) {
          for_each_monomial(j, [&](int bx, int by, int bz, double b) {
            for_each_monomial(j, [&](int cx, int cy, int cz, double c) {
              const int in_y = index_of(ax + 2 * bx, ay + 2 * by, az + 2 * bz);
              const int in_r = index_of(ax + 2 * cx, ay + 2 * cy, az + 2 * cz);
              table[static_cast<std::size_t>(in_y)][static_cast<std::size_t>(in_r)] -=
                  legendre * a * b * c / (4 * std::numbers::pi);
            });
          });
        });
      }
    }
    return table;
  }();
  return kTable;
}

struct Corners {
  Point at[3];
};

Point minus(const Point& p, const Point& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }
Point cross(const Point& p, const Point& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
double dot(const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
double length(const Point& p) { return std::sqrt(dot(p, p)); }

// What one triangle adds: area n . grad y^b in seven points, exact up to the third degree.
static_assert(kWindingOrder <= 4);
void add_triangle(const Corners& t, const Point& centre, Terms& terms) {
  const Point a = minus(t.at[0], centre), b = minus(t.at[1], centre), c = minus(t.at[2], centre);
  const Point n = cross(minus(t.at[1], t.at[0]), minus(t.at[2], t.at[0]));
  const auto add = [&](double wa, double wb, double wc, double weight) {
    double power[3][kWindingOrder + 1];
    for (std::size_t k = 0; k < 3; ++k) {
      power[k][0] = 1;
      const double y = wa * a[k] + wb * b[k] + wc * c[k];
      for (int i = 1; i <= kWindingOrder; ++i) power[k][i] = power[k][i - 1] * y;
    }
    for (std::size_t i = 0; i < terms.size(); ++i) {
      const int* p = kPowers[i].of;
      double slope = 0;
      if (p[0] > 0) slope += n[0] * p[0] * power[0][p[0] - 1] * power[1][p[1]] * power[2][p[2]];
      if (p[1] > 0) slope += n[1] * p[1] * power[0][p[0]] * power[1][p[1] - 1] * power[2][p[2]];
      if (p[2] > 0) slope += n[2] * p[2] * power[0][p[0]] * power[1][p[1]] * power[2][p[2] - 1];
      terms[i] += weight / 2 * slope;
    }
  };
  for (std::size_t k = 0; k < 3; ++k) {
    add(k == 0 ? 1 : 0, k == 1 ? 1 : 0, k == 2 ? 1 : 0, 1.0 / 20);
    add(k == 0 ? 0 : 0.5, k == 1 ? 0 : 0.5, k == 2 ? 0 : 0.5, 2.0 / 15);
  }
  add(1.0 / 3, 1.0 / 3, 1.0 / 3, 9.0 / 20);
}

// The mean of the fourth power of the distance from `centre` over a triangle, not below the true
// one. For numbers w with the exponential distribution, it is the mean of |wa a + wb b + wc c|^4
// over that of (wa + wb + wc)^4: by cumulants. `reach`: no corner is farther.
static_assert(kWindingOrder == 4);
double mean_power(const Corners& t, const Point& centre, double reach) {
  const Point v[3] = {minus(t.at[0], centre), minus(t.at[1], centre), minus(t.at[2], centre)};
  const Point mean{v[0][0] + v[1][0] + v[2][0], v[0][1] + v[1][1] + v[2][1],
                   v[0][2] + v[1][2] + v[2][2]};
  const double mm = dot(mean, mean);
  double trace = 0, squares = 0, rest = 0;
  for (const Point& p : v) {
    const double pp = dot(p, p), pm = dot(p, mean);
    trace += pp;
    rest += 4 * pm * pm + 8 * pp * pm + 6 * pp * pp;
    for (const Point& q : v) squares += dot(p, q) * dot(p, q);
  }
  const double sum = mm * mm + 2 * mm * trace + trace * trace + 2 * squares + rest;
  const double square = reach * reach;
  return sum / 360 + square * square * 0x1p-45;  // the magnitudes add up to 360 reach^4 at most
}

// What was summed about one centre, about another one, `from` it.
void add_moved(const Terms& terms, const Point& from, Terms& sum) {
  double power[3][kWindingOrder + 1];
  for (std::size_t k = 0; k < 3; ++k) {
    power[k][0] = 1;
    for (int i = 1; i <= kWindingOrder; ++i) power[k][i] = power[k][i - 1] * from[k];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const int* b = kPowers[i].of;
    for (int x = 0; x <= b[0]; ++x) {
      for (int y = 0; y <= b[1]; ++y) {
        for (int z = 0; z <= b[2]; ++z) {
          if (x + y + z == 0) continue;
          sum[i] += choose(b[0], x) * choose(b[1], y) * choose(b[2], z) * power[0][b[0] - x] *
                    power[1][b[1] - y] * power[2][b[2] - z] *
                    terms[static_cast<std::size_t>(index_of(x, y, z))];
        }
      }
    }
  }
}

// The triangles below a child lie together in the order of leaves.
struct Stretch {
  std::uint32_t begin = 0, end = 0;
};

class Builder {
 public:
  template <class Real>
  Builder(const bvh::Tree& tree, const Geometries<Real>& geometries, WindingTree& out)
      : tree_(tree), out_(out) {
    double largest = 0;
    for (const Vec3<Real>& v : geometries.meshes()[0].vertices) {
      const Vec3<double> p = predicate::to_double(v);
      largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    out_.scale = std::ldexp(1.0, std::min(-exponent, 1000));
    out_.nodes.resize(tree.nodes.size());
    ranges_.resize(tree.nodes.size());
    corners_.reserve(geometries.size());
    const auto take = [&](std::uint32_t triangle) {
      const predicate::TriangleD t = geometries.triangle(triangle);
      const auto scaled = [this](const Vec3<double>& p) {
        return Point{p.x * out_.scale, p.y * out_.scale, p.z * out_.scale};
      };
      corners_.push_back({{scaled(t.a), scaled(t.b), scaled(t.c)}});
    };
    if (tree.root != bvh::kNoChild) out_.root = place(tree.root, take);
  }

  void run(const WorkOptions& work) {
    sums_.resize(out_.nodes.size());
    scene::for_chunks(out_.nodes.size(), work, 64, [this](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) describe(i);
    });
    // Children come after their parents.
    for (std::size_t i = out_.nodes.size(); i-- > 0;) gather(i);
    scene::for_chunks(out_.nodes.size(), work, 64, [this](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) finish(i);
    });
    double area = 0;
    for (const Corners& t : corners_) area += area_of(t).most;
    out_.area = area * (1 + 0x1p-20) / (4 * std::numbers::pi);
  }

 private:
  struct Area {
    double likely, most;  // both not below the true one; `most` without cancellation
  };
  static Area area_of(const Corners& t) {
    const Point e = minus(t.at[1], t.at[0]), f = minus(t.at[2], t.at[0]);
    const double most = length(e) * length(f) / 2 * (1 + 0x1p-40);
    return {length(cross(e, f)) / 2 * (1 + 0x1p-40) + most * 0x1p-45, most};
  }

  template <class Take>
  std::uint32_t place(std::uint32_t ref, const Take& take) {
    if (!bvh::is_leaf(ref)) {
      const bvh::Node& node = tree_.nodes[ref];
      for (std::uint32_t i = 0; i < kWindingLanes; ++i) {
        const auto begin = static_cast<std::uint32_t>(corners_.size());
        const bool none = node.child[i] == bvh::kNoChild;
        out_.nodes[ref].child[i] = none ? bvh::kNoChild : place(node.child[i], take);
        ranges_[ref][i] = {begin, static_cast<std::uint32_t>(corners_.size())};
      }
      return ref;
    }
    WindingLeaf leaf;
    leaf.count = bvh::leaf_count(ref);
    const bvh::LeafNumber* numbers = bvh::leaf_numbers(tree_, ref);
    std::fill_n(&leaf.corner[0][0], 9 * kWindingLanes, std::numeric_limits<double>::quiet_NaN());
    for (std::uint32_t i = 0; i < leaf.count; ++i) {
      leaf.triangle[i] = numbers[i];
      take(numbers[i]);
      for (std::size_t k = 0; k < 9; ++k) leaf.corner[k][i] = corners_.back().at[k / 3][k % 3];
    }
    out_.leaves.push_back(leaf);
    return static_cast<std::uint32_t>(out_.leaves.size() - 1) | bvh::kLeafBit;
  }

  // Where a node's children are and how large, and the terms of those that are leaves.
  void describe(std::size_t number) {
    WindingNode& node = out_.nodes[number];
    for (std::size_t i = 0; i < kWindingLanes; ++i) {
      const Stretch range = ranges_[number][i];
      Point low{2, 2, 2}, high{-2, -2, -2};
      for (std::uint32_t t = range.begin; t < range.end; ++t) {
        for (const Point& p : corners_[t].at) {
          for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
          }
        }
      }
      Point centre{};
      for (std::size_t k = 0; k < 3; ++k) {
        centre[k] = (low[k] + high[k]) / 2;
        node.centre[k][i] = centre[k];
      }
      double radius = 0, bound = 0, area = 0;
      for (std::uint32_t t = range.begin; t < range.end; ++t) {
        double reach = 0;
        for (const Point& p : corners_[t].at) reach = std::max(reach, length(minus(p, centre)));
        reach = reach * (1 + 0x1p-40) + 0x1p-500;
        const Area of_this = area_of(corners_[t]);
        radius = std::max(radius, reach);
        area += of_this.most;
        bound += of_this.likely * mean_power(corners_[t], centre, reach) + 0x1p-1000;
        if ((node.child[i] & bvh::kLeafBit) != 0) {
          add_triangle(corners_[t], centre, sums_[number][i]);
        }
      }
      node.radius[i] = radius;
      const double whole = 4 * std::numbers::pi / (1 + 0x1p-20);
      node.bound[i] = bound / whole;
      node.area[i] = area / whole;
    }
  }

  void gather(std::size_t number) {
    const WindingNode& node = out_.nodes[number];
    for (std::size_t i = 0; i < kWindingLanes; ++i) {
      const std::uint32_t child = node.child[i];
      if (child == bvh::kNoChild || (child & bvh::kLeafBit) != 0) continue;
      const WindingNode& below = out_.nodes[child];
      for (std::size_t j = 0; j < kWindingLanes; ++j) {
        if (below.child[j] == bvh::kNoChild) continue;
        const Point from{below.centre[0][j] - node.centre[0][i],
                         below.centre[1][j] - node.centre[1][i],
                         below.centre[2][j] - node.centre[2][i]};
        add_moved(sums_[child][j], from, sums_[number][i]);
      }
    }
  }

  void finish(std::size_t number) {
    const std::vector<Terms>& table = kernel_table();
    for (std::size_t i = 0; i < kWindingLanes; ++i) {
      Terms terms{};
      for (std::size_t b = 0; b < terms.size(); ++b) {
        for (std::size_t r = 0; r < terms.size(); ++r) {
          terms[r] += sums_[number][i][b] * table[b][r];
        }
      }
      for (std::size_t r = 0; r < terms.size(); ++r) out_.nodes[number].term[r][i] = terms[r];
    }
  }

  const bvh::Tree& tree_;
  WindingTree& out_;
  std::vector<std::array<Stretch, kWindingLanes>> ranges_;
  std::vector<Corners> corners_;
  std::vector<std::array<Terms, kWindingLanes>> sums_;
};

}  // namespace

template <class Real>
WindingTree winding_tree(const bvh::Tree& tree, const Geometries<Real>& geometries,
                         const WorkOptions& work) {
  WindingTree result;
  Builder(tree, geometries, result).run(work);
  return result;
}

template WindingTree winding_tree(const bvh::Tree&, const Geometries<float>&, const WorkOptions&);
template WindingTree winding_tree(const bvh::Tree&, const Geometries<double>&, const WorkOptions&);

}  // namespace pierce::scene
