// SPDX-License-Identifier: Apache-2.0
//
// Rays and hits in arrays of every layout give the answers of Ray and Hit arrays, bit by bit, and
// nothing is written beside what was asked for.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "pierce/scene.h"
#include "support/hard_rays.h"
#include "support/meshes.h"
#include "support/run_cases.h"
#include "support/show.h"
#include "support/strided_array.h"

namespace pierce {
namespace {

using hard::kLayouts;
using hard::Layout;
using hard::Rng;
using hard::StridedArray;
using hard::Style;

constexpr std::size_t kCounts[] = {0, 1, 2, 255, 256, 257, 600};

template <class T>
bool same(const T& x, const T& y) {
  return std::memcmp(&x, &y, sizeof x) == 0;
}

template <class Real>
class RayArraysTest : public testing::Test {
 public:
  hard::Mesh<Real> mesh = hard::icosphere<Real>(3);
  Scene<Real> scene = Scene<Real>::build(mesh.view());
  Rng rng{hard::seed(), 77};

  std::vector<Ray<Real>> draw(std::size_t count) {
    std::vector<Ray<Real>> rays;
    for (std::size_t i = 0; i < count; ++i) {
      Ray<Real> ray = {{0, 0, 4}, {Real(rng.symmetric()) / 3, Real(rng.symmetric()) / 3, -1}};
      if (rng.coin()) ray = hard::aimed_ray(rng, mesh, Style::Unit).ray;
      if (rng.one_in(4)) ray.t_min = Real(rng.symmetric());
      if (rng.one_in(4)) ray.t_max = Real(5 * rng.unit());
      rays.push_back(ray);
    }
    return rays;
  }

  /// All queries, from Ray arrays and from these.
  void compare(const std::vector<Ray<Real>>& rays, const RayArrays<Real>& arrays) {
    const std::size_t n = rays.size();
    const BatchOptions options{.work = {.threads = 2}};
    std::vector<Hit<Real>> hits(n), other_hits(n);
    scene.closest_hits(rays, hits, options);
    HitArrays<Real> whole;
    whole.hits = other_hits;
    scene.closest_hits(arrays, whole, options);
    std::vector<std::uint8_t> any(n), other_any(n);
    scene.any_hits(rays, any, options);
    scene.any_hits(arrays, rows(other_any), options);
    std::vector<std::uint32_t> counts(n), other_counts(n);
    scene.count_hits(rays, counts, options);
    scene.count_hits(arrays, rows(other_counts), options);
    std::vector<Crossings> crossings(n), other_crossings(n);
    scene.crossings(rays, crossings, options);
    CrossingsArrays all_crossings;
    all_crossings.crossings = other_crossings;
    scene.crossings(arrays, all_crossings, options);
    const HitLists<Real> all = scene.all_hits(rays, options);
    const HitLists<Real> other_all = scene.all_hits(arrays, options);
    EXPECT_EQ(hits, other_hits);
    EXPECT_EQ(any, other_any);
    EXPECT_EQ(counts, other_counts);
    EXPECT_EQ(crossings, other_crossings);
    EXPECT_EQ(all.offsets, other_all.offsets);
    EXPECT_EQ(all.hits, other_all.hits);
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(RayArraysTest, Reals);

TYPED_TEST(RayArraysTest, rows_of_six_and_eight) {
  using Real = TypeParam;
  for (const std::size_t n : kCounts) {
    auto rays = this->draw(n);
    this->compare(rays, RayArrays<Real>::of(rays));
    for (const Layout layout : kLayouts) {
      StridedArray<Real> table(this->rng, layout, n, 8);
      for (std::size_t i = 0; i < n; ++i) {
        const Ray<Real>& ray = rays[i];
        const Real row[] = {ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                            ray.direction.y, ray.direction.z, ray.t_min,    ray.t_max};
        for (std::size_t j = 0; j < 8; ++j) table.set(i, j, row[j]);
      }
      this->compare(rays, {table.rows(0), table.rows(3), table.rows(6), table.rows(7)});
      auto unlimited = rays;
      for (Ray<Real>& ray : unlimited) ray = {ray.origin, ray.direction};
      this->compare(unlimited, {table.rows(0), table.rows(3)});
    }
  }
}

TYPED_TEST(RayArraysTest, columns_apart_and_one_row_for_all) {
  using Real = TypeParam;
  for (const std::size_t n : kCounts) {
    for (const Layout layout : kLayouts) {
      auto rays = this->draw(n);
      if (rays.empty()) rays.push_back({{0, 0, 4}, {0, 0, -1}});  // whose values are for all
      StridedArray<Real> origins(this->rng, layout, n, 3), directions(this->rng, layout, n, 3);
      StridedArray<Real> t_min(this->rng, layout, n, 1), t_max(this->rng, layout, n, 1);
      for (int kind = 0; kind < 16; ++kind) {
        const Ray<Real> one = rays[0];
        std::vector<Ray<Real>> plain(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(n));
        for (std::size_t i = 0; i < n; ++i) {
          Ray<Real>& ray = plain[i];
          if ((kind & 1) != 0) ray.origin = one.origin;
          if ((kind & 2) != 0 && (kind & 1) == 0) ray.direction = one.direction;
          if ((kind & 4) != 0) ray.t_min = one.t_min;
          if ((kind & 8) != 0) ray.t_max = one.t_max;
          const Real o[] = {ray.origin.x, ray.origin.y, ray.origin.z};
          const Real d[] = {ray.direction.x, ray.direction.y, ray.direction.z};
          for (std::size_t j = 0; j < 3; ++j) origins.set(i, j, o[j]), directions.set(i, j, d[j]);
          t_min.set(i, 0, ray.t_min);
          t_max.set(i, 0, ray.t_max);
        }
        RayArrays<Real> arrays{origins.rows(), directions.rows(), t_min.rows(), t_max.rows()};
        if ((kind & 1) != 0) arrays.origins = row_for_all(one.origin);
        if ((kind & 2) != 0 && (kind & 1) == 0) arrays.directions = row_for_all(one.direction);
        if ((kind & 4) != 0) arrays.t_min = row_for_all(one.t_min);
        if ((kind & 8) != 0) arrays.t_max = row_for_all(one.t_max);
        if (n == 0) arrays.t_min = arrays.t_max = {};
        this->compare(plain, arrays);
        if (kind != 1) continue;
        arrays.origins = {&one.origin.x, n, 0};  // the same with a stride of 0
        this->compare(plain, arrays);
      }
    }
  }
}

TYPED_TEST(RayArraysTest, any_subset_of_columns_in_any_layout) {
  using Real = TypeParam;
  for (const std::size_t n : kCounts) {
    const auto rays = this->draw(n);
    std::vector<Hit<Real>> hits(n);
    this->scene.closest_hits(rays, hits);
    for (const Layout layout : kLayouts) {
      for (int round = 0; round < 20; ++round) {
        StridedArray<Real> t(this->rng, layout, n, 1), u(this->rng, layout, n, 1),
            v(this->rng, layout, n, 1), w(this->rng, layout, n, 1);
        StridedArray<std::uint32_t> geometry(this->rng, layout, n, 1),
            triangle(this->rng, layout, n, 1);
        StridedArray<std::int64_t> wide_geometry(this->rng, layout, n, 1),
            wide_triangle(this->rng, layout, n, 1);
        StridedArray<std::uint8_t> facing(this->rng, layout, n, 1);
        const std::uint64_t wanted = round == 0 ? 0 : round == 1 ? ~0ULL : this->rng.bits();
        const auto is_wanted = [&](int i) { return ((wanted >> i) & 1) != 0; };
        HitArrays<Real> arrays;
        if (is_wanted(0)) arrays.t = t.rows();
        if (is_wanted(1)) arrays.u = u.rows();
        if (is_wanted(2)) arrays.v = v.rows();
        if (is_wanted(3)) arrays.w = w.rows();
        if (is_wanted(4)) arrays.facing = facing.rows();
        if (is_wanted(5)) arrays.geometry = geometry.rows();
        if (is_wanted(6)) arrays.geometry = wide_geometry.rows();
        if (is_wanted(7)) arrays.triangle = triangle.rows();
        if (is_wanted(8)) arrays.triangle = wide_triangle.rows();
        this->scene.closest_hits(RayArrays<Real>::of(rays), arrays);
        for (std::size_t i = 0; i < n; ++i) {
          const Hit<Real>& hit = hits[i];
          const bool miss = hit.triangle == kNone;
          ASSERT_TRUE(!(is_wanted(0)) || same(t.get(i), hit.t));
          ASSERT_TRUE(!(is_wanted(1)) || same(u.get(i), hit.u));
          ASSERT_TRUE(!(is_wanted(2)) || same(v.get(i), hit.v));
          ASSERT_TRUE(!(is_wanted(3)) || same(w.get(i), hit.w));
          ASSERT_TRUE(!is_wanted(4) || facing.get(i) == static_cast<std::uint8_t>(hit.facing));
          ASSERT_TRUE(!(is_wanted(5) && !is_wanted(6)) || geometry.get(i) == hit.geometry);
          ASSERT_TRUE(!is_wanted(6) ||
                      wide_geometry.get(i) == (miss ? -1 : std::int64_t{hit.geometry}));
          ASSERT_TRUE(!(is_wanted(7) && !is_wanted(8)) || triangle.get(i) == hit.triangle);
          ASSERT_TRUE(!is_wanted(8) ||
                      wide_triangle.get(i) == (miss ? -1 : std::int64_t{hit.triangle}));
        }
        const auto guarded = [](auto&... all) { return (all.guards_stand() && ...); };
        ASSERT_TRUE(guarded(t, u, v, w, geometry, triangle, wide_geometry, wide_triangle, facing));
      }
      StridedArray<std::uint8_t> any(this->rng, layout, n, 1), on(this->rng, layout, n, 1);
      StridedArray<std::uint32_t> counts(this->rng, layout, n, 1),
          passages(this->rng, layout, n, 1);
      StridedArray<std::int32_t> winding(this->rng, layout, n, 1);
      const auto arrays = RayArrays<Real>::of(rays);
      this->scene.any_hits(arrays, any.rows());
      this->scene.count_hits(arrays, counts.rows());
      CrossingsArrays crossings;
      crossings.count = passages.rows();
      crossings.signed_count = winding.rows();
      crossings.origin_on_surface = on.rows();
      this->scene.crossings(arrays, crossings);
      for (std::size_t i = 0; i < n; ++i) {
        const Crossings plain = this->scene.crossings(rays[i]);
        ASSERT_EQ(any.get(i), this->scene.any_hit(rays[i]) ? 1 : 0);
        ASSERT_EQ(counts.get(i), this->scene.count_hits(rays[i]));
        ASSERT_EQ(passages.get(i), plain.count);
        ASSERT_EQ(winding.get(i), plain.signed_count);
        ASSERT_EQ(on.get(i), plain.origin_on_surface ? 1 : 0);
      }
      const auto guarded = [](auto&... all) { return (all.guards_stand() && ...); };
      ASSERT_TRUE(guarded(any, on, counts, passages, winding));
    }
  }
}

TYPED_TEST(RayArraysTest, all_hits_fill_columns_piece_by_piece) {
  using Real = TypeParam;
  for (const std::size_t n : {0, 1, 257, 5000}) {
    const auto rays = this->draw(n);
    const HitLists<Real> lists = this->scene.all_hits(rays);
    std::vector<std::uint64_t> offsets = {0};
    std::vector<Real> t(lists.hits.size());
    std::vector<std::int64_t> triangle(lists.hits.size());
    const HitRoom<Real> room = [&](std::uint64_t first, std::span<const std::uint64_t> piece) {
      EXPECT_EQ(first + 1, offsets.size());
      EXPECT_EQ(piece[0], 0U);
      const std::uint64_t before = offsets.back();
      for (const std::uint64_t offset : piece.subspan(1)) offsets.push_back(before + offset);
      HitArrays<Real> columns;
      columns.t = {t.data() + before, piece.back()};
      columns.triangle = Rows<std::int64_t>{triangle.data() + before, piece.back()};
      return columns;
    };
    this->scene.all_hits(RayArrays<Real>::of(rays), {}, room);
    ASSERT_EQ(offsets, lists.offsets);
    for (std::size_t i = 0; i < lists.hits.size(); ++i) {
      ASSERT_TRUE(same(t[i], lists.hits[i].t));
      ASSERT_EQ(triangle[i], lists.hits[i].triangle);
    }
  }
}

template <class Call>
std::string complaint(ErrorCode code, const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  return "no error";
}

TYPED_TEST(RayArraysTest, arrays_that_do_not_fit_are_refused_in_one_line) {
  using Real = TypeParam;
  std::vector<Vec3<Real>> five(5, {0, 0, 1}), three(3, {0, 0, 1});
  std::vector<Real> t(5), short_t(4);
  std::vector<std::uint8_t> any(4);
  RayArrays<Real> rays{rows(five), rows(five)};
  const auto cast = [&](const RayArrays<Real>& from, const HitArrays<Real>& to) {
    return [&] { this->scene.closest_hits(from, to); };
  };
  const HitArrays<Real> none;
  RayArrays<Real> bad = rays;
  bad.directions = rows(three);
  EXPECT_EQ(complaint(ErrorCode::SizeMismatch, cast(bad, none)),
            "origins has 5 rows but directions has 3; give one a ray, or one for all");
  bad = rays;
  bad.t_max = rows(short_t);
  EXPECT_EQ(complaint(ErrorCode::SizeMismatch, cast(bad, none)),
            "origins has 5 rows but t_max has 4; give one a ray, or one for all");
  bad = rays;
  bad.directions.data = nullptr;
  EXPECT_EQ(complaint(ErrorCode::InvalidArgument, cast(bad, none)),
            "directions has 5 rows but no data; point it at them");
  bad = rays;
  bad.origins.count = static_cast<std::size_t>(-5);
  EXPECT_EQ(complaint(ErrorCode::InvalidArgument, cast(bad, none)),
            "the number of rows of origins is negative; give 0 or more");
  HitArrays<Real> out;
  out.t = rows(t);
  out.u = rows(short_t);
  EXPECT_EQ(complaint(ErrorCode::SizeMismatch, cast(rays, out)),
            "there are 5 rays but u has 4 rows; give it one a ray, or none");
  out.u = {nullptr, 5};
  EXPECT_EQ(complaint(ErrorCode::InvalidArgument, cast(rays, out)),
            "u has 5 rows but no data; point it at them");
  EXPECT_EQ(complaint(ErrorCode::SizeMismatch, [&] { this->scene.any_hits(rays, rows(any)); }),
            "there are 5 rays but room for 4 results; make the spans equally long");
  five[3].z = five[4].z = 0;  // directions now
  EXPECT_EQ(complaint(ErrorCode::InvalidRay, cast(rays, none)),
            "bad ray 3 (the first of 2): its direction is zero; give it a component that is not");
}

}  // namespace
}  // namespace pierce
