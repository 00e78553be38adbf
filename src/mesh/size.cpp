// SPDX-License-Identifier: Apache-2.0
#include "mesh/size.h"

#include <cstddef>

#include "exact/round_ratio.h"
#include "exact/wide_float.h"
#include "predicate/exact_pair.h"
#include "support/parallel.h"
#include "support/stop_poll.h"

namespace pierce::mesh {
namespace {

using exact::BigInt;
using predicate::Triple;
// More bits than a sum of 2^32 areas, each off by a few units, leaves in doubt. Differences of
// coordinates that are 2^260 times as far apart as they are fine are rounded.
constexpr unsigned kAreaBits = 320;
using AreaFloat = exact::WideFloat<kAreaBits>;

constexpr std::size_t kGrain = 4096;

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
    const AreaFloat area = sum<AreaFloat>([this](const Triangle& t) { return twice_area(t); });
    return {exact::round_ratio<double>(volume, 6, 3 * span_.low),
            exact::narrow<kAreaBits>(area / 2)};
  }

 private:
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

  [[nodiscard]] AreaFloat twice_area(const Triangle& t) const {
    const auto from_first = [&](std::size_t i) {
      const Vec3<double> a = corner(t, 0), p = corner(t, i);
      const auto less = [](double x, double y) {
        return AreaFloat(exact::widen<kAreaBits>(x) - exact::widen<kAreaBits>(y));
      };
      return Triple<AreaFloat>{less(p.x, a.x), less(p.y, a.y), less(p.z, a.z)};
    };
    const auto n = cross(from_first(1), from_first(2));
    return sqrt(dot(n, n));
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
