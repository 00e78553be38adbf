// SPDX-License-Identifier: Apache-2.0
#include "mesh/size.h"

#include <cstddef>

#include "exact/bounded.h"
#include "exact/round_ratio.h"
#include "exact/wide_float.h"
#include "pierce/types.h"
#include "predicate/exact_pair.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce::mesh {
namespace {

using exact::BigInt;
using predicate::Triple;
// More bits than a sum of 2^32 areas, each off by a few units, leaves in doubt.
constexpr unsigned kAreaBits = 320;
using AreaFloat = exact::WideFloat<kAreaBits>;
using BoundedArea = exact::Bounded<exact::DoubleDouble>;

constexpr std::size_t kGrain = 4096;

// Areas that double-doubles know well enough, and the others.
struct QuickAreas {
  BoundedArea bounded;
  AreaFloat others;

  QuickAreas(int zero = 0) : bounded{}, others(zero) {}
  QuickAreas(const BoundedArea& a, const AreaFloat& b) : bounded(a), others(b) {}
  friend QuickAreas operator+(const QuickAreas& a, const QuickAreas& b) {
    return {a.bounded + b.bounded, a.others + b.others};
  }
  QuickAreas& operator+=(const QuickAreas& a) { return *this = *this + a; }
};

template <class Real>
class Sizes {
 public:
  Sizes(MeshView<Real> mesh, const WorkOptions& work) : mesh_(mesh), stop_(work.stop) {
    for (const Triangle& t : mesh.triangles) {
      for (const std::uint32_t corner : t) {
        const Vec3<Real>& p = mesh.vertices[corner];
        span_.include(static_cast<double>(p.x));
        span_.include(static_cast<double>(p.y));
        span_.include(static_cast<double>(p.z));
      }
    }
  }

  [[nodiscard]] Size find() const {
    if (span_.empty()) return {0, 0};
    const BigInt volume =
        span_.width() <= exact::kCoordinateBits<1>
            ? sum<BigInt>([this](const Triangle& t) {
                return exact::to_big(determinant<exact::FixedInt<1>>(t));
              })
            : sum<BigInt>([this](const Triangle& t) { return determinant<BigInt>(t); });
    return {exact::round_ratio<double>(volume, 6, 3 * span_.low), area()};
  }

 private:
  [[nodiscard]] double area() const {
    const auto quick = sum<QuickAreas>([this](const Triangle& t) {
      QuickAreas one;
      one.bounded = bounded_twice_area(t);
      if (!(one.bounded.err < kInfinity<double>)) one = {{}, exact_twice_area(t)};
      return one;
    });
    // Mostly all that it may be rounds alike.
    const auto [value, error] = quick.bounded;
    if (value.high + value.low + error < kInfinity<double>) {  // no NaN either
      const AreaFloat found = wide(value.high) + wide(value.low) + quick.others;
      const double low = exact::narrow<kAreaBits>((found - wide(error)) / 2);
      if (low == exact::narrow<kAreaBits>((found + wide(error)) / 2)) return low;
    }
    return exact_area();
  }

  [[nodiscard]] double exact_area() const {
    return exact::narrow<kAreaBits>(
        sum<AreaFloat>([this](const Triangle& t) { return exact_twice_area(t); }) / 2);
  }

  static AreaFloat wide(double x) { return exact::widen<kAreaBits>(x); }

  template <class Number, class Value>
  Number sum(const Value& value) const {
    const auto body = [&](std::size_t first, std::size_t last) {
      stop_.now();
      Number part = 0;
      for (std::size_t i = first; i < last; ++i) part += value(mesh_.triangles[i]);
      return part;
    };
    return parallel::reduce(std::size_t{0}, mesh_.triangles.size(), kGrain, Number(0), body,
                            [](const Number& a, const Number& b) { return Number(a + b); });
  }

  [[nodiscard]] Vec3<double> corner(const Triangle& t, std::size_t i) const {
    return predicate::to_double(mesh_.vertices[t[i]]);
  }

  template <class Integer>
  [[nodiscard]] auto determinant(const Triangle& t) const {
    const auto at = [&](std::size_t i) {
      return predicate::scaled_triple<Integer>(corner(t, i), span_.low);
    };
    return dot(cross(at(0), at(1)), at(2));
  }

  [[nodiscard]] BoundedArea bounded_twice_area(const Triangle& t) const {
    const auto difference = [](double x, double y) {
      return BoundedArea{exact::two_sum(x, -y), 0};
    };
    const auto from_first = [&](std::size_t i) {
      const Vec3<double> a = corner(t, 0), p = corner(t, i);
      return Triple<BoundedArea>{difference(p.x, a.x), difference(p.y, a.y), difference(p.z, a.z)};
    };
    const auto n = cross(from_first(1), from_first(2));
    return square_root(dot(n, n));
  }

  [[nodiscard]] AreaFloat exact_twice_area(const Triangle& t) const {
    const auto at = [&](std::size_t i) {
      return predicate::scaled_triple<BigInt>(corner(t, i), span_.low);
    };
    const auto first = at(0);
    const auto n = cross(at(1) - first, at(2) - first);
    return ldexp(sqrt(AreaFloat(dot(n, n))), 2 * span_.low);
  }

  MeshView<Real> mesh_;
  scene::StopPoll stop_;
  exact::BitSpan span_;
};

}  // namespace

template <class Real>
Size size_of(MeshView<Real> mesh, const WorkOptions& work) {
  return Sizes<Real>(mesh, work).find();
}

template Size size_of(MeshView<float>, const WorkOptions&);
template Size size_of(MeshView<double>, const WorkOptions&);

}  // namespace pierce::mesh
