// SPDX-License-Identifier: Apache-2.0
//
// Nearest points against the definition over rationals: the triangle, the feature and every bit of
// every number, on points made to be hard.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/hard_points.h"
#include "support/nearest_oracle.h"
#include "support/outliers.h"
#include "support/run_cases.h"
#include "support/show.h"

namespace pierce {
namespace {

using hard::Mesh;
using hard::Rng;
using hard::Style;

template <class Real>
std::string text(const NearestPoint<Real>& n) {
  return show::joined("triangle ", n.geometry, ':', n.triangle, " feature ",
                      static_cast<int>(n.feature), " at ", show::text(n.point), " distance ",
                      show::text(n.distance), " u ", show::text(n.u), " v ", show::text(n.v), " w ",
                      show::text(n.w));
}

template <class Real>
bool same_bits(const NearestPoint<Real>& x, const NearestPoint<Real>& y) {
  return x.geometry == y.geometry && x.triangle == y.triangle && x.feature == y.feature &&
         show::same_bits(x.distance, y.distance) && show::same_bits(x.u, y.u) &&
         show::same_bits(x.v, y.v) && show::same_bits(x.w, y.w) &&
         show::same_bits(x.point.x, y.point.x) && show::same_bits(x.point.y, y.point.y) &&
         show::same_bits(x.point.z, y.point.z);
}

template <class Real>
Mesh<Real> hard_mesh(Rng& rng, Style style) {
  switch (rng.below(6)) {
    case 0:
      return hard::icosphere<Real>(0);
    case 1:
      return hard::lattice_cube<Real>(1);
    case 2:
      return hard::needles<Real>(rng, 8);
    case 3:
      return hard::copies<Real>(rng, hard::soup<Real>(rng, style, 4), 2);
    default:
      return hard::soup<Real>(rng, style, static_cast<std::uint32_t>(rng.between(1, 12)));
  }
}

template <class Real>
class NearestAgainstOracle : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(NearestAgainstOracle, Reals);

TYPED_TEST(NearestAgainstOracle, triangle_feature_and_every_bit_are_those_of_the_definition) {
  using Real = TypeParam;
  constexpr int kPointsPerMesh = 8;
  const auto fails = [](std::uint64_t i) {
    Rng rng(hard::seed() + 500, i);
    const Style style = rng.pick(hard::kAllStyles);
    Mesh<Real> mesh = hard_mesh<Real>(rng, style);
    if (rng.one_in(4)) hard::add_outlier(rng, mesh);
    const MeshView<Real> view = mesh.view();
    const auto scene =
        Scene<Real>::build(view, {.quality = static_cast<Quality>(i % 4), .work = {.threads = 1}});
    for (int k = 0; k < kPointsPerMesh; ++k) {
      const Vec3<Real> point = hard::hard_point(rng, mesh, style);
      const auto truth = oracle::nearest_point<Real>({&view, 1}, point);
      const Real nudged = std::max(hard::nudged(truth.distance, rng.between(-1, 1)), Real(0));
      const Real radius = rng.one_in(4) ? nudged : kInfinity<Real>;
      const auto expected =
          std::isinf(radius) ? truth : oracle::nearest_point<Real>({&view, 1}, point, radius);
      const auto found = scene.nearest_point(point, radius);
      if (same_bits(found.value_or(NearestPoint<Real>{}), expected)) continue;
      ADD_FAILURE() << "case " << i << '/' << k << " style " << static_cast<int>(style) << " point "
                    << show::text(point) << " radius " << show::text(radius) << "\n found    "
                    << text(found.value_or(NearestPoint<Real>{})) << "\n expected "
                    << text(expected);
      return true;
    }
    return false;
  };
  EXPECT_EQ(hard::first_failure(hard::case_count(250), fails), std::nullopt);
}

}  // namespace
}  // namespace pierce
