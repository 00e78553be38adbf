// SPDX-License-Identifier: Apache-2.0
//
// Triangles for the tests of the search tree: generated on demand, nothing stored.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bvh/primitives.h"
#include "bvh/tree.h"

namespace pierce::bvh {

/// Primitives from a function of their number.
class Generated final : public Primitives {
 public:
  Generated(std::string name, std::uint32_t size, std::function<Corners(std::uint32_t)> make)
      : name_(std::move(name)), size_(size), make_(std::move(make)) {}
  [[nodiscard]] std::uint32_t size() const override { return size_; }
  [[nodiscard]] Corners corners(std::uint32_t i) const override { return make_(i); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::uint32_t size_;
  std::function<Corners(std::uint32_t)> make_;
};

/// The k-th number of a stream, in [-1, 1): splitmix64.
inline double random_at(std::uint64_t k) {
  k = (k + 1) * 0x9e3779b97f4a7c15ULL;
  k = (k ^ (k >> 30)) * 0xbf58476d1ce4e5b9ULL;
  k = (k ^ (k >> 27)) * 0x94d049bb133111ebULL;
  return std::ldexp(static_cast<double>(static_cast<std::int64_t>(k ^ (k >> 31))), -63);
}

inline Vec3<double> random_point(std::uint64_t k, double scale) {
  return {scale * random_at(3 * k), scale * random_at(3 * k + 1), scale * random_at(3 * k + 2)};
}

inline Vec3<double> sum(const Vec3<double>& a, const Vec3<double>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

/// Small triangles anywhere, each component a full double (so boxes do round).
inline Generated random_soup(std::uint32_t n) {
  return {"random soup", n, [](std::uint32_t i) {
            const Vec3<double> a = random_point(3ULL * i, 0.9);
            return Corners{a, sum(a, random_point(3ULL * i + 1, 0.05)),
                           sum(a, random_point(3ULL * i + 2, 0.05))};
          }};
}

/// A wavy height field of side x side quads, two triangles each.
inline Generated grid(std::uint32_t side) {
  return {"grid", 2 * side * side, [side](std::uint32_t i) {
            const auto point = [side](std::uint32_t column, std::uint32_t row) {
              const double x = 2.0 * column / side - 1, y = 2.0 * row / side - 1;
              return Vec3<double>{x, y, 0.1 * std::sin(9 * x) * std::cos(7 * y)};
            };
            const std::uint32_t column = i / 2 % side, row = i / 2 / side;
            return i % 2 == 0
                       ? Corners{point(column, row), point(column + 1, row), point(column, row + 1)}
                       : Corners{point(column + 1, row), point(column + 1, row + 1),
                                 point(column, row + 1)};
          }};
}

inline Generated identical(std::uint32_t n) {
  return {"identical", n, [](std::uint32_t) {
            return Corners{{-0.3, 0.1, 0.2}, {0.4, 0.1, 0.7}, {0.1, 0.9, -0.5}};
          }};
}

/// Triangles of every size around one common centre of their boxes.
inline Generated concentric(std::uint32_t n) {
  return {"concentric", n, [n](std::uint32_t i) {
            const double s = (i + 1.0) / n;
            return Corners{{-s, -s, -s}, {s, s, s}, {s, -s, s}};
          }};
}

/// Long thin triangles across the whole scene in all directions.
inline Generated needles(std::uint32_t n) {
  return {"needles", n, [](std::uint32_t i) {
            const Vec3<double> a = random_point(3ULL * i, 0.99);
            return Corners{a, sum(a, random_point(3ULL * i + 1, 1e-4)),
                           random_point(3ULL * i + 2, 1.0)};
          }};
}

/// Sizes and distances that halve again and again, down to denormal floats: every split by area
/// takes off only a few.
inline Generated shrinking(std::uint32_t n) {
  return {"shrinking", n, [](std::uint32_t i) {
            const double s = std::ldexp(1.0, -static_cast<int>(i % 1000));
            return Corners{{s, s, s}, {s, 0.5 * s, s}, {0.75 * s, s, 0.5 * s}};
          }};
}

/// Flat along two axes: points on a line as triangles without area.
inline Generated points_on_a_line(std::uint32_t n) {
  return {"points on a line", n, [n](std::uint32_t i) {
            const Vec3<double> p{2.0 * i / n - 1, 0.0, -0.0};
            return Corners{p, p, p};
          }};
}

/// The tree of a quality in the layout that goes with it.
inline Tree build_tree(const Primitives& source, const BuildOptions& options) {
  return build(source, options,
               options.quality == Quality::Compact ? Layout::Compact : Layout::Full);
}

inline std::vector<Generated> all_sources(std::uint32_t n) {
  return {random_soup(n),     grid(static_cast<std::uint32_t>(std::sqrt(n / 2.0)) + 1),
          identical(n),       concentric(n),
          needles(n),         shrinking(n),
          points_on_a_line(n)};
}

}  // namespace pierce::bvh
