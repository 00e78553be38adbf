// SPDX-License-Identifier: Apache-2.0
//
// Any bytes as a scene file, with a header whose checksum is right, so that what stands behind it
// is looked at: refused by one line, or loaded, verified or not, and asked every kind of query
// without a step out of the file. The first byte chooses a kind of scene that the rest changes, if
// it is short: bytes of it are replaced, four by four.
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pierce/scene.h"
#include "scene/file/layout.h"
#include "support/checksum.h"

namespace {

using namespace pierce;

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Work>
void allow_bad_file(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    require(error.code() == ErrorCode::BadFile || error.code() == ErrorCode::NotClosed);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
}

template <class Real>
std::string scene_bytes(Quality quality, std::uint32_t count) {
  Mesh<Real> mesh;
  std::uint32_t state = count;
  const auto next = [&state] {
    state = state * 1664525U + 1013904223U;
    return static_cast<Real>(static_cast<int>(state >> 16) - 32768) / Real{16384};
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back({next(), next(), next()});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const std::string path = "/tmp/fuzz-scene-" + std::to_string(::getpid());
  const std::vector<MeshView<Real>> views = {mesh.view(), mesh.view()};
  Scene<Real>::build(views, {.quality = quality}).save(path);
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  ::unlink(path.c_str());
  return bytes;
}

template <class Real>
void ask(const std::string& path) {
  allow_bad_file([&] { (void)Scene<Real>::load(path, {.verify = true, .work = {.threads = 1}}); });
  allow_bad_file([&] {
    const auto scene = Scene<Real>::load(path, {.work = {.threads = 1}});
    std::vector<Ray<Real>> rays;
    for (int i = 0; i < 24; ++i) {
      const auto c = static_cast<Real>(i % 5 - 2), d = static_cast<Real>(i % 7 - 3);
      rays.push_back({{c, d, Real{3}}, {-c / 3, -d / 4, Real{-1}}});
    }
    const std::span<const Ray<Real>> all = rays;
    std::vector<Hit<Real>> hits(rays.size());
    const BatchOptions one{.work = {.threads = 1}};
    allow_bad_file([&] { scene.closest_hits(all, hits, one); });
    allow_bad_file([&] { (void)scene.all_hits(all, one); });
    allow_bad_file([&] { (void)scene.closest_hit(rays[0]); });
    allow_bad_file([&] { (void)scene.any_hit(rays[1], {.mask = 1}); });
    allow_bad_file([&] { (void)scene.crossings(rays[2]); });
    allow_bad_file([&] { (void)scene.nearest_point(rays[3].origin); });
    allow_bad_file([&] { (void)scene.locate(rays[4].origin, {.open_mesh = true}); });
    allow_bad_file([&] { (void)scene.locate(rays[5].origin); });
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string kinds[] = {
      scene_bytes<float>(Quality::Balanced, 40), scene_bytes<float>(Quality::Compact, 30),
      scene_bytes<double>(Quality::Balanced, 30), scene_bytes<double>(Quality::High, 20)};
  if (size == 0) return 0;
  std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (size < 512) {
    bytes = kinds[data[0] % 4];
    for (std::size_t i = 1; i + 6 <= size; i += 6) {  // where, as 16 bits of words; what
      const std::size_t at = (data[i] + 256U * data[i + 1]) * 4U % bytes.size();
      std::memcpy(bytes.data() + at, data + i + 2, std::min<std::size_t>(4, bytes.size() - at));
    }
  }
  if (bytes.size() >= sizeof(scene::SceneFileHeader)) {
    const auto head = std::as_bytes(std::span(bytes)).first(sizeof(scene::SceneFileHeader) - 8);
    const std::uint64_t sum = xxh64(head);
    std::memcpy(bytes.data() + head.size(), &sum, sizeof sum);
  }
  const int file = ::memfd_create("scene", 0);
  require(file >= 0 &&
          ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()));
  const std::string path = "/proc/self/fd/" + std::to_string(file);
  ask<float>(path);
  ask<double>(path);
  ::close(file);
  return 0;
}
