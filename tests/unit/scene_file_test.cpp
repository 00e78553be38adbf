// SPDX-License-Identifier: Apache-2.0
//
// Scene files: what is loaded answers as what was saved, to the bit; whatever is wrong with a file
// is refused in one line, by the load or by the query that meets it, and never leads out of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "scene/file/layout.h"
#include "support/checksum.h"

namespace pierce {
namespace {

namespace fs = std::filesystem;

class SceneFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pierce-scene-file-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string path(const char* name = "a.pierce") const { return folder_ / name; }

 private:
  fs::path folder_;
};

template <class Real>
Mesh<Real> cloud(std::uint32_t count, unsigned seed, double spread = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-spread, spread);
  Mesh<Real> mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    const auto near = [&](double c) { return static_cast<Real>(c + 0.2 * uniform(random)); };
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back({near(x), near(y), near(z)});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

template <class Real>
std::vector<Ray<Real>> rays(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::vector<Ray<Real>> all(count);
  for (Ray<Real>& ray : all) {
    const auto any = [&] { return static_cast<Real>(uniform(random)); };
    ray = {{any(), any(), any()}, {any(), any(), any()}};
  }
  return all;
}

std::string contents(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The bytes with a header that says it is whole.
std::string sealed(std::string bytes) {
  const auto head = std::as_bytes(std::span(bytes)).first(sizeof(scene::SceneFileHeader) - 8);
  const std::uint64_t sum = xxh64(head);
  std::memcpy(bytes.data() + head.size(), &sum, sizeof sum);
  return bytes;
}

template <class Real>
void expect_same_answers(const Scene<Real>& a, const Scene<Real>& b) {
  const auto asked = rays<Real>(3000);
  const std::span<const Ray<Real>> all = asked;
  std::vector<Hit<Real>> first(all.size()), second(all.size());
  a.closest_hits(all, first);
  b.closest_hits(all, second);
  EXPECT_EQ(first, second);
  const HitLists<Real> lists = a.all_hits(all), others = b.all_hits(all);
  EXPECT_GT(lists.hits.size(), all.size() / 2);
  EXPECT_EQ(lists.hits, others.hits);
  EXPECT_EQ(lists.offsets, others.offsets);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(a.closest_hit(all[i]), b.closest_hit(all[i]));
    EXPECT_EQ(a.nearest_point(all[i].origin), b.nearest_point(all[i].origin));
    EXPECT_EQ(a.crossings(all[i]), b.crossings(all[i]));
  }
}

template <class Real>
void saves_and_loads(const std::string& path, Quality quality) {
  // Far from the origin a double scene keeps no exact copies; two geometries share an array.
  const Mesh<Real> one = cloud<Real>(700, 1), other = cloud<Real>(300, 2);
  const std::vector<MeshView<Real>> views = {
      one.view(), other.view(), {one.vertices, other.triangles}, {}};
  const std::vector<std::uint32_t> masks = {1, 2, 3, 4};
  const auto scene = Scene<Real>::build(views, {.quality = quality, .masks = masks});
  const std::vector<std::string> names = {"one", "", "b\xc3\xa4r", "nothing"};
  scene.save(path, {.names = names});
  for (const bool verify : {false, true}) {
    auto loaded = Scene<Real>::load(path, {.verify = verify});
    expect_same_answers(scene, loaded);
    const std::span<const MeshView<Real>> meshes = loaded.meshes();
    ASSERT_EQ(meshes.size(), 4U);
    EXPECT_EQ(meshes[2].vertices.data(), meshes[0].vertices.data());  // there once
    const Ray<Real> ray{{0, 0, 2}, {0, 0, -1}};
    EXPECT_EQ(scene.count_hits(ray, {.mask = 2}), loaded.count_hits(ray, {.mask = 2}));
    const auto before = contents(path);
    loaded.refit(views[0].vertices.empty() ? WorkOptions{} : WorkOptions{.threads = 1});
    expect_same_answers(scene, loaded);
    loaded.save(path + "2", {.names = names});
    EXPECT_EQ(contents(path), before) << "a refit has written to the file";
  }
  EXPECT_EQ(contents(path), contents(path + "2"));
  const SceneFileInfo info = scene_file_info(path);
  EXPECT_EQ(info.bits, 8 * sizeof(Real));
  EXPECT_EQ(info.quality, quality);
  EXPECT_EQ(info.triangles, 1300U);
  ASSERT_EQ(info.geometries.size(), 4U);
  EXPECT_EQ(info.geometries[2].name, names[2]);
  EXPECT_EQ(info.geometries[1].triangles, 300U);
  EXPECT_EQ(info.geometries[3].mask, 4U);
}

TEST_F(SceneFile, AnswersAsTheSceneThatWasSaved) {
  for (const Quality quality : {Quality::Balanced, Quality::High, Quality::Compact}) {
    saves_and_loads<float>(path(), quality);
    saves_and_loads<double>(path(), quality);
  }
}

TEST_F(SceneFile, HoldsNothingAndOneTriangle) {
  const Mesh<float> one{{{0, 0, 0}, {1, 0, 0}, {0, 1, -0.0F}}, {{0, 1, 2}}};
  const Ray<float> ray{{0.25F, 0.25F, 1}, {0, 0, -1}};
  for (const std::size_t count : {0U, 1U}) {
    const MeshView<float> view = one.view();
    const auto scene = Scene<float>::build(std::span(&view, count));
    scene.save(path());
    const auto loaded = Scene<float>::load(path(), {.verify = true});
    EXPECT_EQ(loaded.closest_hit(ray), scene.closest_hit(ray));
    EXPECT_EQ(loaded.any_hit(ray), count == 1);
    EXPECT_EQ(loaded.info().triangles, count);
  }
}

template <class Ask>
std::string refusal(const Ask& ask) {
  try {
    ask();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::BadFile) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "";
}

TEST_F(SceneFile, RefusesWhatIsNoSceneFile) {
  const auto load = [&](const std::string& bytes) {
    write(path(), bytes);
    return refusal([&] { (void)Scene<float>::load(path()); });
  };
  const Mesh<float> mesh = cloud<float>(100, 3);
  Scene<float>::build(mesh.view()).save(path("good"));
  const std::string good = contents(path("good"));
  EXPECT_EQ(load(good), "");
  EXPECT_NE(load("ply\nformat").find("is no scene file"), std::string::npos);
  EXPECT_NE(load("").find("is empty"), std::string::npos);
  for (std::size_t size = 1; size < good.size(); size = size < 600 ? size + 7 : size + 1000)
    EXPECT_NE(load(good.substr(0, size)), "") << size;
  EXPECT_NE(load(good.substr(0, good.size() - 1)).find("is cut short"), std::string::npos);
  EXPECT_NE(load(good + "x").find("is too long"), std::string::npos);
  std::string newer = good;
  newer[8] = 3;
  EXPECT_NE(load(newer).find("version 3"), std::string::npos);
  for (std::size_t byte = 0; byte < sizeof(scene::SceneFileHeader); byte += 3) {
    std::string damaged = good;
    damaged[byte] = static_cast<char>(damaged[byte] ^ 0x10);
    EXPECT_NE(load(damaged), "") << "byte " << byte << " of the header";
  }
  EXPECT_NE(
      refusal([&] { (void)Scene<double>::load(path("good")); }).find("load it as Scene<float>"),
      std::string::npos);
  EXPECT_NE(refusal([&] { (void)Scene<float>::load(path("none")); }).find("check the name"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              (void)Scene<float>::load(fs::path(path()).parent_path());
            }).find("is a folder"),
            std::string::npos);
}

TEST_F(SceneFile, VerifyNoticesEveryByte) {
  const Mesh<double> mesh = cloud<double>(40, 4);
  Scene<double>::build(mesh.view()).save(path("good"));
  const std::string good = contents(path("good"));
  scene::SceneFileHeader header{};
  std::memcpy(&header, good.data(), sizeof header);
  scene::GeometryRecord geometry{};
  std::memcpy(&geometry, good.data() + header.table.offset, sizeof geometry);
  for (const scene::Section& section : {header.nodes, header.leaves, header.table, header.names,
                                        geometry.vertices, geometry.triangles}) {
    ASSERT_GT(section.bytes, 0U);
    for (std::uint64_t i = 0; i < section.bytes; i += 1 + section.bytes / 40) {
      std::string damaged = good;
      damaged[section.offset + i] = static_cast<char>(damaged[section.offset + i] ^ 1);
      write(path(), damaged);
      EXPECT_NE(refusal([&] { (void)Scene<double>::load(path(), {.verify = true}); }), "") << i;
    }
  }
}

// Every query of a scene whose file may be anything.
template <class Real>
void ask_all(const Scene<Real>& scene, const std::vector<Ray<Real>>& all) {
  std::vector<Hit<Real>> hits(all.size());
  std::vector<Crossings> crossings(all.size());
  const auto ask = [](const auto& question) { (void)refusal(question); };
  ask([&] { scene.closest_hits(std::span<const Ray<Real>>(all), hits, {.work = {.threads = 1}}); });
  ask([&] { (void)scene.all_hits(all, {.work = {.threads = 1}}); });
  ask([&] {
    scene.crossings(std::span<const Ray<Real>>(all), crossings, {.work = {.threads = 1}});
  });
  for (std::size_t i = 0; i < 4; ++i) {
    ask([&] { (void)scene.closest_hit(all[i]); });
    ask([&] { (void)scene.any_hit(all[i], {.mask = 1}); });
    ask([&] { (void)scene.nearest_point(all[i].origin); });
    ask([&] { (void)scene.locate(all[i].origin, {.open_mesh = true}); });
  }
  try {
    (void)scene.locate(all[0].origin);
  } catch (const Error&) {
  }
}

// Bytes changed at random behind a header that says all is well: refused, or asked without harm.
template <class Real>
void attack(const std::string& path, const std::string& good, unsigned seed, int times) {
  std::mt19937_64 random(seed);
  const auto asked = rays<Real>(40);
  const std::uint32_t words[] = {0,          1,          0x7f800000, 0x7fc00000,
                                 0xffffffff, 0x7fffffff, 0x80000000, 0x0000ffff};
  for (int i = 0; i < times; ++i) {
    std::string bytes = good;
    for (std::uint64_t n = random() % 4; n < 4; ++n) {
      const std::size_t at = (random() % 3 == 0 ? random() % 512 : random() % bytes.size()) / 4 * 4;
      const std::uint32_t word = random() % 2 == 0 ? words[random() % std::size(words)]
                                                   : static_cast<std::uint32_t>(random());
      std::memcpy(bytes.data() + at, &word, random() % 2 == 0 ? 4 : 1);
    }
    write(path, sealed(std::move(bytes)));
    (void)refusal([&] { ask_all(Scene<Real>::load(path), asked); });
    (void)refusal([&] { (void)Scene<Real>::load(path, {.verify = true}); });
  }
}

TEST_F(SceneFile, DamageNeverLeadsOutOfTheFile) {
  const char* const cases = std::getenv("PIERCE_CASES");
  const int times = cases != nullptr ? std::atoi(cases) : 50;
  for (const Quality quality : {Quality::Balanced, Quality::Compact}) {
    const Mesh<float> mesh = cloud<float>(60, 5);
    Scene<float>::build(mesh.view(), {.quality = quality}).save(path("good"));
    attack<float>(path(), contents(path("good")), 6, times);
    const Mesh<double> wide = cloud<double>(60, 6, 1e6);
    Scene<double>::build(wide.view(), {.quality = quality}).save(path("good"));
    attack<double>(path(), contents(path("good")), 7, times);
  }
}

// The tree's copies of a triangle are hit, and the mesh names one corner twice: nothing can be
// right, and nothing may go wrong.
template <class Real>
void flatten_each(const std::string& path, const Mesh<Real>& mesh) {
  Scene<Real>::build(mesh.view()).save(path);
  std::string bytes = contents(path);
  std::vector<Ray<Real>> through;
  for (const Triangle& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    through.push_back({{(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3, Real(2e7)}, {0, 0, -1}});
    through.push_back({through.back().origin, {Real(1e-9), Real(-1e-9), -1}});
    const std::string_view corners(reinterpret_cast<const char*>(t.data()), sizeof t);
    const std::size_t at = bytes.find(corners);
    ASSERT_NE(at, std::string::npos);
    std::memcpy(bytes.data() + at + 8, &t[1], 4);
  }
  write(path, bytes);
  ask_all(Scene<Real>::load(path), through);
}
TEST_F(SceneFile, TrianglesThatLostTheirAreaDoNoHarm) {
  flatten_each(path("float"), cloud<float>(60, 9));
  flatten_each(path("double"), cloud<double>(60, 10));
  flatten_each(path("far"), cloud<double>(60, 11, 1e6));
}

TEST_F(SceneFile, WhatCannotBeWrittenLeavesNothing) {
  const Mesh<float> mesh = cloud<float>(10, 8);
  const auto scene = Scene<float>::build(mesh.view());
  EXPECT_NE(refusal([&] { scene.save(path("no/a")); }).find("make its folder first"),
            std::string::npos);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(scene.save(path(), {.work = {.stop = &stop}}), Error);
  EXPECT_TRUE(fs::is_empty(fs::path(path()).parent_path()));
  const std::vector<std::string> names(2);
  EXPECT_THROW(scene.save(path(), {.names = names}), Error);
}

TEST(Checksum, IsXxh64) {  // of the reference implementation
  const auto of = [](const std::string& text) { return xxh64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(of(""), 0xef46db3751d8e999U);
  EXPECT_EQ(of("a"), 0xd24ec4f1a98c6e5bU);
  EXPECT_EQ(of("abc"), 0x44bc2cf5ad770999U);
  EXPECT_EQ(of("Nobody inspects the spammish repetition"), 0xfbcea83c8a378bf1U);
}

}  // namespace
}  // namespace pierce
