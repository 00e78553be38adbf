// SPDX-License-Identifier: Apache-2.0
//
// Kept vertices lie in the cells of a grid, four distances wide, in a hash table. Rounding is
// monotone, so whatever is within [x - d, x + d] has a cell between those of the two ends as
// computed, at most three of them.
#include "io/weld.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

#include "exact/double_double.h"
#include "pierce/error.h"
#include "pierce/vector.h"

namespace pierce::io {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Cell = std::array<double, 3>;

bool finite(const Vec3<double>& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

// Exactly: |a - b|^2 <= d^2. In double the sum is off by less than a part in 2^50 unless something
// is too small for it.
bool within(const Vec3<double>& a, const Vec3<double>& b, double d) {
  if (a == b) return true;
  if (d == 0) return false;
  const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  const double sum = x * x + y * y + z * z, limit = d * d;
  constexpr double kSlack = 0x1p-48, kLeast = 0x1p-900, kMost = 0x1p1000;
  if (limit > kLeast && limit < kMost && sum > kLeast) {
    if (sum < limit * (1 - kSlack)) return true;
    if (sum > limit * (1 + kSlack)) return false;
  }
  const auto square = [](double p, double q) -> Rational {
    const Rational difference = Rational(p) - Rational(q);
    return difference * difference;
  };
  const Rational exact = square(a.x, b.x) + square(a.y, b.y) + square(a.z, b.z);
  return exact <= Rational(d) * Rational(d);
}

// Rounded once, from a hundred bits.
double distance_of(const Vec3<double>& a, const Vec3<double>& b) {
  const auto of = [](double p, double q) { return exact::two_sum(p, -q); };
  const exact::DoubleDouble d[3] = {of(a.x, b.x), of(a.y, b.y), of(a.z, b.z)};
  const double most = std::max({std::fabs(d[0].high), std::fabs(d[1].high), std::fabs(d[2].high)});
  if (most == 0) return 0;
  const int place = std::ilogb(most);
  exact::DoubleDouble sum;
  for (const exact::DoubleDouble& x : d) {
    const exact::DoubleDouble one{std::ldexp(x.high, -place), std::ldexp(x.low, -place)};
    sum = sum + one * one;
  }
  const double root = std::sqrt(sum.high);
  const exact::DoubleDouble rest = sum - exact::two_product(root, root);
  return std::ldexp(root + rest.high / (2 * root), place);
}

std::size_t hash_of(const Cell& cell) {
  std::uint64_t hash = 0;
  for (const double c : cell) {
    hash ^= std::bit_cast<std::uint64_t>(c + 0.0);  // -0 is 0
    hash *= 0x9e3779b97f4a7c15u;
    hash ^= hash >> 29;
  }
  return static_cast<std::size_t>(hash);
}

// Numbers of kept vertices by their cells.
class Grid {
 public:
  Grid(std::size_t vertices, double distance, double largest)
      : distance_(distance),
        // No finer than can be told apart, lest coordinates run over.
        cell_(std::max(4 * distance, largest * 0x1p-60)),
        heads_(std::bit_ceil(std::max<std::size_t>(vertices, 1)), kNone) {}

  /// The first one, by number, that `fits`; kNone if none does.
  template <class Fits>
  std::uint32_t find(const Vec3<double>& p, Fits fits) const {
    std::array<std::array<double, 3>, 3> cells = {};
    std::array<std::size_t, 3> counts = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double x = axis == 0 ? p.x : axis == 1 ? p.y : p.z;
      const double low = cell_of(x - distance_), high = cell_of(x + distance_);
      std::size_t& n = counts[axis];
      cells[axis][n++] = low;
      if (low + 1 < high) cells[axis][n++] = low + 1;
      if (low < high) cells[axis][n++] = high;
    }
    std::uint32_t found = kNone;
    for (std::size_t i = 0; i < counts[0]; ++i) {
      for (std::size_t j = 0; j < counts[1]; ++j) {
        for (std::size_t k = 0; k < counts[2]; ++k) {
          for (std::uint32_t at = heads_[slot({cells[0][i], cells[1][j], cells[2][k]})];
               at != kNone; at = next_[at]) {
            if (at < found && fits(at)) found = at;
          }
        }
      }
    }
    return found;
  }

  /// Vertices are added in order: 0, 1, ...
  void add(const Vec3<double>& p, bool findable) {
    const auto number = static_cast<std::uint32_t>(next_.size());
    next_.push_back(kNone);
    if (!findable) return;
    std::uint32_t& head = heads_[slot({cell_of(p.x), cell_of(p.y), cell_of(p.z)})];
    next_.back() = head;
    head = number;
  }

 private:
  [[nodiscard]] double cell_of(double x) const {
    return distance_ == 0 ? x : std::floor(x / cell_);
  }
  [[nodiscard]] std::size_t slot(const Cell& cell) const {
    return hash_of(cell) & (heads_.size() - 1);
  }

  double distance_, cell_;
  std::vector<std::uint32_t> heads_, next_;
};

}  // namespace

template <class Real>
WeldedMesh<Real> weld(MeshView<Real> mesh, double distance, scene::StopPoll stop) {
  if (!(distance >= 0) || std::isinf(4 * distance)) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the distance to weld by cannot be {}; give a number from 0 to 4e307",
                            distance));
  }
  double largest = 0;
  for (const Vec3<Real>& p : mesh.vertices) {
    const Vec3<double> q = convert<double>(p);
    if (finite(q)) largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  }
  WeldedMesh<Real> out;
  out.vertex_of.reserve(mesh.vertices.size());
  Grid grid(mesh.vertices.size(), distance, largest);
  for (const Vec3<Real>& vertex : mesh.vertices) {
    stop.sometimes();
    const Vec3<double> p = convert<double>(vertex);
    std::uint32_t kept = kNone;
    if (finite(p)) {
      kept = grid.find(p, [&](std::uint32_t at) {
        return within(p, convert<double>(out.vertices[at]), distance);
      });
    }
    if (kept == kNone) {
      kept = static_cast<std::uint32_t>(out.vertices.size());
      out.vertices.push_back(vertex);
      grid.add(p, finite(p));
    } else {
      const Vec3<double> q = convert<double>(out.vertices[kept]);
      out.farthest = std::max(out.farthest, distance_of(p, q));
    }
    out.vertex_of.push_back(kept);
  }
  out.triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    stop.sometimes();
    Triangle triangle = mesh.triangles[i];
    for (std::uint32_t& corner : triangle) {
      if (corner >= out.vertex_of.size()) {
        throw Error(ErrorCode::IndexOutOfRange,
                    fmt::format("triangle {} names vertex {}, there are {}", i, corner,
                                out.vertex_of.size()),
                    i);
      }
      corner = out.vertex_of[corner];
    }
    const bool flat =
        triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (flat) {
      ++out.collapsed;
    } else {
      out.triangles.push_back(triangle);
    }
  }
  return out;
}

template WeldedMesh<float> weld(MeshView<float>, double, scene::StopPoll);
template WeldedMesh<double> weld(MeshView<double>, double, scene::StopPoll);

}  // namespace pierce::io
