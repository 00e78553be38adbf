// SPDX-License-Identifier: Apache-2.0
//
// Every Error says in numbers, too, whom it is about: its code has a name, and index and count are
// those of its text.
#include "pierce/error.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/bad_file.h"
#include "io/mesh.h"
#include "io/rays.h"
#include "io/read_mesh.h"
#include "pierce/closed.h"
#include "pierce/scene.h"
#include "support/io_files.h"

namespace pierce {
namespace {

constexpr auto kNone64 = Error::kNoIndex;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Told {
  ErrorCode code;
  std::uint64_t index, count;
  friend bool operator==(const Told&, const Told&) = default;
};

void PrintTo(const Told& told, std::ostream* out) {
  *out << name_of(told.code) << " index " << told.index << " count " << told.count;
}

/// What the call's Error says of itself. Its text is one line, and names the index.
Told told_by(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    if (e.index() != kNone64) {
      EXPECT_NE(text.find(std::to_string(e.index())), std::string::npos) << text;
    }
    if (e.count() > 1) {
      EXPECT_NE(text.find("of " + std::to_string(e.count())), std::string::npos) << text;
    }
    return {e.code(), e.index(), e.count()};
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::BadFile, 0, 0};
}

Mesh<double> tetrahedron() {
  return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

TEST(Error, codes_have_their_names) {
  constexpr std::array kNames = {"NonFiniteVertex", "IndexOutOfRange", "TooManyTriangles",
                                 "InvalidRay",      "InvalidPoint",    "SizeMismatch",
                                 "InvalidArgument", "NotClosed",       "UnknownKernel",
                                 "Stopped",         "BadFile"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    EXPECT_STREQ(name_of(static_cast<ErrorCode>(i)), kNames[i]);
  }
  EXPECT_STREQ(name_of(static_cast<ErrorCode>(kNames.size())), "unknown error");
  EXPECT_EQ(ErrorCode::BadFile, static_cast<ErrorCode>(kNames.size() - 1)) << "no code is left out";
}

TEST(Error, is_about_one_thing_without_a_number_unless_told_otherwise) {
  const Error error(ErrorCode::Stopped, "text");
  EXPECT_EQ(error.index(), Error::kNoIndex);
  EXPECT_EQ(error.count(), 1U);
}

TEST(Error, bad_meshes) {
  const auto build = [](const Mesh<double>& mesh) {
    return [&mesh] { (void)Scene<double>::build(mesh.view()); };
  };
  auto mesh = tetrahedron();
  mesh.vertices[1].y = kNaN;
  EXPECT_EQ(told_by(build(mesh)), (Told{ErrorCode::NonFiniteVertex, 0, 3}));
  mesh.triangles[2][1] = 4;
  EXPECT_EQ(told_by(build(mesh)), (Told{ErrorCode::IndexOutOfRange, 2, 1}));
  const std::vector<MeshView<double>> meshes = {mesh.view(), mesh.view()};
  const std::vector<std::uint32_t> masks(1);
  EXPECT_EQ(told_by([&] { (void)Scene<double>::build(meshes, {.masks = masks}); }),
            (Told{ErrorCode::SizeMismatch, kNone64, 1}));
}

TEST(Error, too_many_triangles) {
  // 2^16 times the same 2^16 triangles, none of which is copied.
  Mesh<double> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}};
  mesh.triangles.resize(1 << 16, {0, 1, 2});
  const std::vector<MeshView<double>> meshes(1 << 16, mesh.view());
  EXPECT_EQ(told_by([&] { (void)Scene<double>::build(meshes); }),
            (Told{ErrorCode::TooManyTriangles, kNone64, 1}));
}

TEST(Error, instances_that_are_too_large) {
  const auto mesh = tetrahedron();
  Transform<double> large;
  for (auto& row : large.rows) {
    for (double& x : row) x *= 0x1p1023;
  }
  const std::vector<Instance<double>> instances = {{mesh.view(), {}}, {mesh.view(), large}};
  const Told told = told_by([&] { (void)Scene<double>::build(instances); });
  EXPECT_EQ(told.code, ErrorCode::NonFiniteVertex);
  EXPECT_EQ(told.index, 1U);
  EXPECT_EQ(told.count, 3U);
}

TEST(Error, bad_rays) {
  const auto mesh = tetrahedron();
  const auto scene = Scene<double>::build(mesh.view());
  std::vector<Ray<double>> rays(70, {{1, 1, -1}, {0, 0, 1}});
  rays[66].origin.x = kNaN;
  rays[69].direction = {0, 0, 0};
  std::vector<Hit<double>> hits(70), found(70, scene.closest_hit(rays[0]).value());
  std::vector<std::uint8_t> any(70);
  std::vector<std::uint32_t> counts(70);
  std::vector<Crossings> crossings(70);
  std::vector<std::optional<Vec3<double>>> starts(70);
  std::vector<Hit<double>> list;
  const Told first{ErrorCode::InvalidRay, 66, 2}, alone{ErrorCode::InvalidRay, kNone64, 1};
  EXPECT_EQ(told_by([&] { scene.closest_hits(rays, hits); }), first);
  EXPECT_EQ(told_by([&] { scene.any_hits(rays, any); }), first);
  EXPECT_EQ(told_by([&] { (void)scene.all_hits(rays); }), first);
  EXPECT_EQ(told_by([&] { scene.count_hits(rays, counts); }), first);
  EXPECT_EQ(told_by([&] { scene.crossings(rays, crossings); }), first);
  EXPECT_EQ(told_by([&] { scene.next_origins(rays, found, Side::Before, starts); }), first);
  const auto asked_about_each = [](std::uint64_t, const Hit<double>&) { return true; };
  EXPECT_EQ(told_by([&] { scene.closest_hits(rays, hits, {.filter = asked_about_each}); }), first);
  const Ray<double> bad = rays[69];
  EXPECT_EQ(told_by([&] { (void)scene.closest_hit(bad); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.any_hit(bad); }), alone);
  EXPECT_EQ(told_by([&] { scene.all_hits(bad, list); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.count_hits(bad); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.crossings(bad); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.next_origin(bad, found[0], Side::Before); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.hit_point(bad, found[0]); }), alone);
  // A hit that is none of a bad ray's is the offence here, whatever is wrong with the ray.
  std::vector<Vec3<double>> points(70);
  EXPECT_EQ(told_by([&] { scene.hit_points(rays, found, points); }),
            (Told{ErrorCode::InvalidArgument, 66, 2}));
  EXPECT_EQ(told_by([&] { scene.closest_hits(rays, std::span(hits).first(69)); }),
            (Told{ErrorCode::SizeMismatch, kNone64, 1}));
}

TEST(Error, bad_points) {
  const auto mesh = tetrahedron();
  const auto scene = Scene<double>::build(mesh.view());
  std::vector<Vec3<double>> points(40, {1, 1, 1});
  points[17].z = points[39].x = kInfinity<double>;
  std::vector<Location> locations(40);
  std::vector<NearestPoint<double>> nearest(40);
  std::vector<double> distances(40);
  const Told first{ErrorCode::InvalidPoint, 17, 2}, alone{ErrorCode::InvalidPoint, kNone64, 1};
  EXPECT_EQ(told_by([&] { scene.locate(points, locations); }), first);
  EXPECT_EQ(told_by([&] { scene.nearest_points(points, nearest); }), first);
  EXPECT_EQ(told_by([&] { scene.signed_distances(points, distances); }), first);
  EXPECT_EQ(told_by([&] { (void)scene.locate(points[17]); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.nearest_point(points[17]); }), alone);
  EXPECT_EQ(told_by([&] { (void)scene.signed_distance(points[17]); }), alone);
  EXPECT_EQ(told_by([&] {
              (void)scene.nearest_point({1, 1, 1}, -1);
            }),
            (Told{ErrorCode::InvalidArgument, kNone64, 1}));
}

TEST(Error, surfaces_that_are_not_closed_name_the_edges_first_triangle) {
  auto far = tetrahedron(), open = tetrahedron();
  for (auto& v : far.vertices) v.x += 100;
  std::swap(open.triangles[0], open.triangles[3]);
  open.triangles.pop_back();  // {0, 2, 1}
  const auto alone = Scene<double>::build(open.view());
  const std::vector<Vec3<double>> points(3, {1, 1, 1});
  std::vector<Location> locations(3);
  std::vector<double> distances(3);
  const Told told{ErrorCode::NotClosed, 0, 3};
  EXPECT_EQ(told_by([&] { (void)alone.locate({1, 1, 1}); }), told);
  EXPECT_EQ(told_by([&] { alone.locate(points, locations); }), told);
  EXPECT_EQ(told_by([&] { alone.signed_distances(points, distances); }), told);
  // Of several geometries it is the number in its own.
  std::rotate(open.triangles.begin(), open.triangles.begin() + 1, open.triangles.end());
  const std::vector<MeshView<double>> both = {far.view(), open.view()};
  const auto scene = Scene<double>::build(both);
  EXPECT_EQ(told_by([&] { (void)scene.locate({1, 1, 1}); }), told);
  // Closed, but one face turned: its three edges are each used twice the same way.
  auto turned = tetrahedron();
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  const auto winding = Scene<double>::build(turned.view());
  EXPECT_EQ(winding.locate({1, 1, 1}), Location::Inside);
  EXPECT_EQ(told_by([&] {
              (void)winding.locate({1, 1, 1}, {.rule = InsideRule::NonZero});
            }),
            (Told{ErrorCode::NotClosed, 0, 3}));
}

TEST(Error, kernels_that_are_not_there_and_work_that_is_stopped) {
  const auto mesh = tetrahedron();
  const auto build = [&] { return Scene<double>::build(mesh.view()); };
  const char* before = std::getenv("PIERCE_KERNEL");
  const std::optional<std::string> kept =
      before ? std::optional<std::string>(before) : std::nullopt;
  ::setenv("PIERCE_KERNEL", "abacus", 1);
  EXPECT_EQ(told_by([&] { (void)build(); }), (Told{ErrorCode::UnknownKernel, kNone64, 1}));
  kept ? ::setenv("PIERCE_KERNEL", kept->c_str(), 1) : ::unsetenv("PIERCE_KERNEL");
  const auto scene = build();
  const std::atomic<bool> stop = true;
  const std::vector<Ray<double>> rays(3, {{1, 1, -1}, {0, 0, 1}});
  std::vector<Hit<double>> hits(3);
  EXPECT_EQ(told_by([&] { scene.closest_hits(rays, hits, {.work = {.stop = &stop}}); }),
            (Told{ErrorCode::Stopped, kNone64, 1}));
}

TEST(Error, files_name_the_line_the_byte_or_the_row) {
  const io::TempFolder folder;
  const auto mesh = [&](const char* name, std::string_view bytes) {
    const auto path = folder.write(name, bytes);
    return [path] { (void)io::read_mesh(path); };
  };
  EXPECT_EQ(told_by(mesh("m.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n")),
            (Told{ErrorCode::BadFile, 3, 1}));
  EXPECT_EQ(told_by(mesh("m.stl", std::string(83, 'x'))), (Told{ErrorCode::BadFile, 83, 1}));
  EXPECT_EQ(told_by(mesh("none.obj/x.obj", "")), (Told{ErrorCode::BadFile, kNone64, 1}));
  const auto rays = folder.write("r.csv", "0,0,0,0,0,1\n0,0,0,0,0,one\n");
  EXPECT_EQ(told_by([&] { (void)io::RayFile(rays); }), (Told{ErrorCode::BadFile, 2, 1}));
  const io::RayFile large({0, 0, 0, 0, 0, 1, 0, 9, 0, 0, 1e39, 0, 0, 1, 0, 9}, "--ray");
  std::vector<Ray<float>> read(2);
  EXPECT_EQ(told_by([&] { large.read(0, std::span(read)); }), (Told{ErrorCode::BadFile, 1, 1}));
  const std::vector<Vec3<double>> vertices = {{0, 0, 0}, {0, 0, 0}, {0, -1e39, 0}};
  EXPECT_EQ(told_by([&] { (void)io::to_float(vertices); }),
            (Told{ErrorCode::InvalidArgument, 2, 1}));
}

}  // namespace
}  // namespace pierce
