// SPDX-License-Identifier: Apache-2.0
//
// Scenes over meshes as people have them: any layout, any type of index, owned or viewed; and that
// none can be built over temporaries.
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "pierce/pierce.h"
#include "support/meshes.h"
#include "support/run_cases.h"
#include "support/strided_array.h"

namespace pierce {
namespace {

using hard::kLayouts;
using hard::Layout;
using hard::Rng;
using hard::StridedArray;

template <class Real>
std::vector<Vec3<Real>> make_vertices() {
  return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
}
[[maybe_unused]] std::vector<Triangle> make_triangles() { return {{0, 1, 2}}; }
template <class Real>
const std::vector<Vec3<Real>> make_const_vertices() {
  return make_vertices<Real>();
}

template <class Real, class Vertices, class Triangles>
concept CanBuild = requires(Vertices&& vertices, Triangles&& triangles) {
  Scene<Real>::build({std::forward<Vertices>(vertices), std::forward<Triangles>(triangles)});
};
template <class Real, class Vertices, class Triangles>
concept CanView = requires(Vertices&& vertices, Triangles&& triangles) {
  MeshView<Real>{std::forward<Vertices>(vertices), std::forward<Triangles>(triangles)};
};
template <class Real>
concept NoTemporaries = !requires {
  Scene<Real>::build({make_vertices<Real>(), make_triangles()});
}
&&!requires(std::vector<Triangle> & kept) { Scene<Real>::build({make_vertices<Real>(), kept}); }
&&!requires(std::vector<Vec3<Real>> & kept) { Scene<Real>::build({kept, make_triangles()}); }
&&!requires(std::vector<Triangle> & kept) { MeshView<Real>{make_const_vertices<Real>(), kept}; }
&&!requires { Mesh<Real>{}.view(); }
&&!requires { row_for_all(Real(1)); }
&&!requires { rows(make_vertices<Real>()); };

template <class Real>
constexpr bool safe() {
  using V = Vec3<Real>;
  using Ts = std::vector<Triangle>;
  static_assert(NoTemporaries<Real>);
  static_assert(CanBuild<Real, std::vector<V>&, Ts&>);
  static_assert(CanBuild<Real, const std::vector<V>&, const Ts&>);
  static_assert(CanBuild<Real, std::span<V>, std::span<const Triangle>>);
  static_assert(CanBuild<Real, V(&)[3], Triangle(&)[1]>);
  static_assert(CanBuild<Real, const std::array<V, 3>&, std::array<Triangle, 1>&>);
  static_assert(CanView<Real, std::vector<V>&, std::span<Triangle>>);
  static_assert(!CanBuild<Real, std::vector<V>, Ts&>);
  static_assert(!CanBuild<Real, std::vector<V>&, Ts>);
  static_assert(!CanBuild<Real, std::array<V, 3>, Ts&>);
  static_assert(!CanView<Real, std::vector<V>, Ts&>);
  static_assert(!CanView<Real, const std::vector<V>, const Ts>);
  static_assert(!CanView<Real, std::vector<Real>&, Ts&>);  // numbers are no vertices
  static_assert(std::is_aggregate_v<MeshView<Real>>);
  return true;
}
static_assert(safe<float>() && safe<double>());

template <class Real>
class MeshArraysTest : public testing::Test {
 public:
  hard::Mesh<Real> mesh = hard::icosphere<Real>(2);
  Rng rng{hard::seed(), 78};

  /// That the scene answers as one over a plain view does.
  void compare(const Scene<Real>& scene, const hard::Mesh<Real>& to) {
    const auto plain = Scene<Real>::build(to.view());
    for (int i = 0; i < 200; ++i) {
      const Vec3<Real> from = {Real(rng.symmetric()), Real(rng.symmetric()), 3};
      const Ray<Real> ray = {from, {Real(rng.symmetric()), Real(rng.symmetric()), -3}};
      ASSERT_EQ(scene.closest_hit(ray), plain.closest_hit(ray));
    }
    ASSERT_EQ(scene.info().triangles, to.triangles.size());
  }

  template <class Index>
  void compare_layouts() {
    for (const Layout layout : kLayouts) {
      StridedArray<Real> vertices(rng, layout, mesh.vertices.size(), 3);
      StridedArray<Index> triangles(rng, layout, mesh.triangles.size(), 3);
      for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec3<Real>& v = mesh.vertices[i];
        const Real row[] = {v.x, v.y, v.z};
        for (std::size_t j = 0; j < 3; ++j) vertices.set(i, j, row[j]);
      }
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          triangles.set(i, j, static_cast<Index>(mesh.triangles[i][j]));
        }
      }
      MeshArrays<Real> arrays;
      arrays.vertices = vertices.rows();
      arrays.triangles = Rows<const Index>(triangles.rows());
      const auto copy = Mesh<Real>::from(arrays);
      ASSERT_EQ(copy.vertices, mesh.vertices);
      ASSERT_EQ(copy.triangles, mesh.triangles);
      auto scene = Scene<Real>::build(arrays);
      compare(scene, mesh);
      // In place, a vertex moves; one that was copied is copied again.
      const Real before = vertices.get(5, 2);
      vertices.set(5, 2, before * 2);
      auto moved = mesh;
      moved.vertices[5].z *= 2;
      scene.refit();
      compare(scene, moved);
      ASSERT_TRUE(vertices.guards_stand() && triangles.guards_stand());
      // Only what does not lie right is copied.
      const bool right = layout == Layout::Packed;
      const std::size_t kept = scene.info().bytes - Scene<Real>::build(mesh.view()).info().bytes;
      const std::size_t vertex_bytes = right ? 0 : mesh.vertices.size() * sizeof(Vec3<Real>);
      const std::size_t index_bytes =
          right && sizeof(Index) == 4 ? 0 : mesh.triangles.size() * sizeof(Triangle);
      if (layout != Layout::Mixed && layout != Layout::Spread) {
        EXPECT_EQ(kept, vertex_bytes + index_bytes);
      }
    }
  }
};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(MeshArraysTest, Reals);

TYPED_TEST(MeshArraysTest, every_layout_and_type_of_index) {
  this->template compare_layouts<std::uint16_t>();
  this->template compare_layouts<std::uint32_t>();
  this->template compare_layouts<std::uint64_t>();
  this->template compare_layouts<std::int32_t>();
  this->template compare_layouts<std::int64_t>();
}

TYPED_TEST(MeshArraysTest, a_scene_takes_meshes_over) {
  using Real = TypeParam;
  Mesh<Real> plain_mesh{this->mesh.vertices, this->mesh.triangles};
  auto scene = Scene<Real>::build(Mesh<Real>(plain_mesh));
  this->compare(scene, this->mesh);
  scene.refit();  // nothing has moved
  this->compare(scene, this->mesh);
  auto elsewhere = std::move(scene);
  this->compare(elsewhere, this->mesh);
  auto other = this->mesh;
  for (auto& v : other.vertices) v.x *= 2;
  elsewhere.refit(Mesh<Real>{other.vertices, other.triangles});
  this->compare(elsewhere, other);
  elsewhere.refit(plain_mesh.view());
  this->compare(elsewhere, this->mesh);
  std::vector<Mesh<Real>> two = {plain_mesh, Mesh<Real>{other.vertices, other.triangles}};
  const std::vector<MeshView<Real>> views = {plain_mesh.view(), two[1].view()};
  const auto plain = Scene<Real>::build(std::span<const MeshView<Real>>(views));
  const auto both = Scene<Real>::build(std::vector<Mesh<Real>>(two));
  std::vector<Hit<Real>> all, expected;
  for (int i = 0; i < 100; ++i) {
    const Ray<Real> ray = {{3, Real(i) / 100, 0}, {-1, 0, 0}};
    both.all_hits(ray, all);
    plain.all_hits(ray, expected);
    ASSERT_EQ(all, expected);
  }
}

TYPED_TEST(MeshArraysTest, empty_meshes_are_welcome) {
  using Real = TypeParam;
  const Ray<Real> ray = {{0, 0, 1}, {0, 0, -1}};
  EXPECT_FALSE(Scene<Real>::build(MeshArrays<Real>{}).any_hit(ray));
  EXPECT_FALSE(Scene<Real>::build(Mesh<Real>{}).any_hit(ray));
  EXPECT_FALSE(Scene<Real>::build(std::vector<Mesh<Real>>{}).any_hit(ray));
  auto scene = Scene<Real>::build(std::vector<Mesh<Real>>{});
  scene.refit();
  EXPECT_EQ(Mesh<Real>::from({}).vertices.size(), 0U);
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

TYPED_TEST(MeshArraysTest, indices_that_name_no_vertex_are_refused) {
  using Real = TypeParam;
  const auto vertices = make_vertices<Real>();
  const auto refused = [&](const TriangleRows& triangles) {
    MeshArrays<Real> arrays;
    arrays.vertices = rows(vertices);
    arrays.triangles = triangles;
    const auto build =
        complaint(ErrorCode::IndexOutOfRange, [&] { (void)Scene<Real>::build(arrays); });
    EXPECT_EQ(build,
              complaint(ErrorCode::IndexOutOfRange, [&] { (void)Mesh<Real>::from(arrays); }));
    return build;
  };
  const auto text = [](const std::string& index) {
    return "triangle 1 (the first of 2): names vertex " + index +
           ", but there are only 3; correct the index";
  };
  const auto with = [&]<class T>(T bad) {
    const std::vector<T> indices = {0, 1, 2, 0, bad, bad, 2, 1, 0, 1, bad, 0};
    return refused(Rows<const T>{indices.data(), 4, 3 * sizeof(T)});
  };
  EXPECT_EQ(with(std::int32_t{-1}), text("-1"));
  EXPECT_EQ(with(std::int32_t{3}), text("3"));
  EXPECT_EQ(with(std::int64_t{-1}), text("-1"));
  EXPECT_EQ(with(std::int64_t{1} << 32), text("4294967296"));
  EXPECT_EQ(with(std::uint64_t{1} << 63), text("9223372036854775808"));
  EXPECT_EQ(with(std::uint32_t{3}), text("3"));
  EXPECT_EQ(with(std::uint16_t{65535}), text("65535"));
  MeshArrays<Real> arrays;
  arrays.vertices = {nullptr, 3};
  EXPECT_EQ(complaint(ErrorCode::InvalidArgument, [&] { (void)Mesh<Real>::from(arrays); }),
            "vertices has 3 rows but no data; point it at them");
}

}  // namespace
}  // namespace pierce
