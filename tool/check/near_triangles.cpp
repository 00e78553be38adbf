// SPDX-License-Identifier: Apache-2.0
#include "check/near_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

double largest(const Vec& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

Vec times_two_to(const Vec& v, int power) {
  return {std::ldexp(v.x, power), std::ldexp(v.y, power), std::ldexp(v.z, power)};
}

// An interval of values of one product, (p - o) d.
struct Term {
  double low, high;
  Term(double low_p, double high_p, double o, double d) {
    const double x = (low_p - o) * d, y = (high_p - o) * d;
    low = std::min(x, y);
    high = std::max(x, y);
    if (std::isnan(x) || std::isnan(y)) low = high = std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] double size() const { return std::max(std::fabs(low), std::fabs(high)); }
};

// Whether a - b is surely not zero for any values of the terms.
bool apart(const Term& a, const Term& b) {
  const double error = 0x1p-50 * (a.size() + b.size()) + 0x1p-1000;
  return a.low - b.high > error || b.low - a.high > error;
}

// Whether the three corners' a - b surely have one and the same sign.
bool one_side(const double (&a)[3], const double (&b)[3]) {
  bool positive = true, negative = true;
  for (int i = 0; i < 3; ++i) {
    const double error = 0x1p-50 * (std::fabs(a[i]) + std::fabs(b[i])) + 0x1p-1000;
    positive = positive && a[i] - b[i] > error;
    negative = negative && b[i] - a[i] > error;
  }
  return positive || negative;
}

struct Line {
  Vec o, d;

  [[nodiscard]] bool misses_box(const Vec& low, const Vec& high) const {
    const auto pair = [&](double low_i, double high_i, double o_i, double d_i, double low_j,
                          double high_j, double o_j, double d_j) {
      return apart(Term(low_i, high_i, o_i, d_j), Term(low_j, high_j, o_j, d_i));
    };
    return pair(low.x, high.x, o.x, d.x, low.y, high.y, o.y, d.y) ||
           pair(low.y, high.y, o.y, d.y, low.z, high.z, o.z, d.z) ||
           pair(low.z, high.z, o.z, d.z, low.x, high.x, o.x, d.x);
  }

  [[nodiscard]] bool misses_triangle(const Vec& a, const Vec& b, const Vec& c) const {
    const auto pair = [&](double Vec::*i, double Vec::*j) {
      const double u[3] = {(a.*i - o.*i) * d.*j, (b.*i - o.*i) * d.*j, (c.*i - o.*i) * d.*j};
      const double v[3] = {(a.*j - o.*j) * d.*i, (b.*j - o.*j) * d.*i, (c.*j - o.*j) * d.*i};
      return one_side(u, v);
    };
    return pair(&Vec::x, &Vec::y) || pair(&Vec::y, &Vec::z) || pair(&Vec::z, &Vec::x);
  }
};

// The bits of three numbers from 0 to 1023, interleaved: near in this order, near in space.
std::uint32_t interleaved(const Vec& at) {
  std::uint32_t code = 0;
  for (unsigned bit = 10; bit-- > 0;) {
    for (const double x : {at.x, at.y, at.z}) {
      code = code << 1U | (static_cast<std::uint32_t>(std::clamp(x, 0.0, 1023.0)) >> bit & 1U);
    }
  }
  return code;
}

}  // namespace

void NearTriangles::Box::grow(const Vec& p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
}

template <class Real>
NearTriangles::NearTriangles(MeshView<Real> mesh) {
  double size = 0;
  for (const Vec3<Real>& v : mesh.vertices) size = std::max(size, largest(convert<double>(v)));
  if (size > 0) scale_ = -std::ilogb(size);
  const auto corner = [&](std::uint32_t v) {
    return times_two_to(convert<double>(mesh.vertices[v]), scale_);
  };
  sorted_.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    sorted_.push_back({corner(t[0]), corner(t[1]), corner(t[2]), i});
  }
  sort_into_clusters();
}

void NearTriangles::sort_into_clusters() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
  for (std::uint32_t i = 0; i < sorted_.size(); ++i) {
    const Corners& t = sorted_[i];  // coordinates lie in (-2, 2)
    order.emplace_back(interleaved(85 * (t.a + t.b + t.c) + Vec{512, 512, 512}), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<Corners> sorted;
  sorted.reserve(sorted_.size());
  for (const auto& [code, i] : order) sorted.push_back(sorted_[i]);
  sorted_ = std::move(sorted);

  // As many clusters as triangles in each: a ray looks at two small lists.
  const auto in_cluster =
      static_cast<std::size_t>(std::max(4.0, std::sqrt(static_cast<double>(sorted_.size())) / 4));
  for (std::size_t begin = 0; begin < sorted_.size(); begin += in_cluster) {
    Cluster cluster{
        {sorted_[begin].a, sorted_[begin].a}, begin, std::min(begin + in_cluster, sorted_.size())};
    for (std::size_t i = begin; i < cluster.end; ++i) {
      for (const Vec& p : {sorted_[i].a, sorted_[i].b, sorted_[i].c}) cluster.box.grow(p);
    }
    clusters_.push_back(cluster);
  }
}

template <class Real>
void NearTriangles::find(const Ray<Real>& ray, std::vector<std::uint32_t>& out) const {
  const Vec d = convert<double>(ray.direction);
  const Line line = {times_two_to(convert<double>(ray.origin), scale_),
                     times_two_to(d, -std::ilogb(largest(d)))};
  out.clear();
  for (const Cluster& cluster : clusters_) {
    if (line.misses_box(cluster.box.low, cluster.box.high)) continue;
    for (std::size_t i = cluster.begin; i < cluster.end; ++i) {
      const Corners& t = sorted_[i];
      if (!line.misses_triangle(t.a, t.b, t.c)) out.push_back(t.triangle);
    }
  }
}

template NearTriangles::NearTriangles(MeshView<float>);
template NearTriangles::NearTriangles(MeshView<double>);
template void NearTriangles::find(const Ray<float>&, std::vector<std::uint32_t>&) const;
template void NearTriangles::find(const Ray<double>&, std::vector<std::uint32_t>&) const;

}  // namespace pierce::tool
