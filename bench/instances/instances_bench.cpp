// SPDX-License-Identifier: Apache-2.0
//
// bench_instances: one mesh in many places, beside Embree's instances in the same process.
//
//   bench_instances [SIDE [CUTS]]
//
// A field of SIDE x SIDE (100) bumpy balls of 2 CUTS^2 (224: 100,352) triangles each, turned and
// scaled at will. Of three kinds of rays it prints ns a ray, one thread, the best of three: pierce
// ray by ray and in batches, Embree (fast) ray by ray. Before that, the answers for a field of
// 12 x 12 are held against those of a flat scene, bit by bit; a difference ends it.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "workloads/prng.h"

namespace pierce::bench {
namespace {

using Instances = std::vector<Instance<float>>;
using Rays = std::vector<Ray<float>>;
using Hits = std::vector<Hit<float>>;

struct Ball {
  std::vector<Vec3<float>> vertices;
  std::vector<Triangle> triangles;
};

Ball bumpy_ball(std::uint32_t cuts) {
  Ball ball;
  for (std::uint32_t i = 0; i <= cuts; ++i) {
    for (std::uint32_t j = 0; j <= cuts; ++j) {
      const double a = std::numbers::pi * i / cuts, b = 2 * std::numbers::pi * j / cuts;
      const double r = 0.4 * (1 + 0.1 * std::sin(7 * a) * std::cos(9 * b) +
                              0.02 * std::sin(41 * a) * std::cos(37 * b));
      ball.vertices.push_back({static_cast<float>(r * std::sin(a) * std::cos(b)),
                               static_cast<float>(r * std::sin(a) * std::sin(b)),
                               static_cast<float>(r * std::cos(a))});
    }
  }
  for (std::uint32_t i = 0; i < cuts; ++i) {
    for (std::uint32_t j = 0; j < cuts; ++j) {
      const std::uint32_t a = i * (cuts + 1) + j, c = a + cuts + 1;
      ball.triangles.push_back({a, c, a + 1});
      ball.triangles.push_back({a + 1, c, c + 1});
    }
  }
  return ball;
}

float symmetric(Prng& random) { return static_cast<float>(2 * random.unit() - 1); }

Transform<float> any_turn(Prng& random) {
  float q[4], n = 0;
  do {
    n = 0;
    for (float& x : q) {
      x = symmetric(random);
      n += x * x;
    }
  } while (n > 1 || n < 0.1F);
  for (float& x : q) x /= std::sqrt(n);
  const float w = q[0], x = q[1], y = q[2], z = q[3], s = 1 + 0.3F * symmetric(random);
  Transform<float> turn;
  turn.rows[0] = {s * (1 - 2 * (y * y + z * z)), s * 2 * (x * y - w * z), s * 2 * (x * z + w * y),
                  0};
  turn.rows[1] = {s * 2 * (x * y + w * z), s * (1 - 2 * (x * x + z * z)), s * 2 * (y * z - w * x),
                  0};
  turn.rows[2] = {s * 2 * (x * z - w * y), s * 2 * (y * z + w * x), s * (1 - 2 * (x * x + y * y)),
                  0};
  return turn;
}

Instances field(const Ball& ball, std::uint32_t side) {
  Prng random(1);
  Instances instances;
  const float half = 0.5F * static_cast<float>(side);
  for (std::uint32_t i = 0; i < side; ++i) {
    for (std::uint32_t j = 0; j < side; ++j) {
      Transform<float> place = any_turn(random);
      place.rows[0][3] = static_cast<float>(i) - half;
      place.rows[1][3] = static_cast<float>(j) - half;
      place.rows[2][3] = 0.3F * symmetric(random);
      instances.push_back({{ball.vertices, ball.triangles}, place});
    }
  }
  return instances;
}

struct Kind {
  const char* name;
  Rays rays;
};

std::vector<Kind> kinds_of_rays(std::uint32_t side) {
  constexpr int kSide = 512;
  Prng random(2);
  const auto size = static_cast<float>(side);
  std::vector<Kind> kinds = {{"camera", {}}, {"from above", {}}, {"among them", {}}};
  const auto place = [&] { return 0.5F * size * symmetric(random); };
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const auto u = static_cast<float>(j - kSide / 2) / kSide;
      const auto v = static_cast<float>(i - kSide / 2) / kSide;
      kinds[0].rays.push_back({{0.1F, -0.6F * size, 0.25F * size}, {u, 1, -0.35F - 0.5F * v}});
      kinds[1].rays.push_back(
          {{place(), place(), 5}, {0.1F * symmetric(random), 0.1F * symmetric(random), -1}});
      kinds[2].rays.push_back({{place(), place(), 0.5F * symmetric(random)},
                               {symmetric(random), symmetric(random), 0.3F * symmetric(random)}});
    }
  }
  return kinds;
}

class EmbreeField {
 public:
  EmbreeField(const Ball& ball, const Instances& instances) {
    RTCScene mesh = rtcNewScene(device_);
    RTCGeometry triangles = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    const auto copy = [&](RTCBufferType type, RTCFormat format, const void* data,
                          std::size_t count) {
      void* to = rtcSetNewGeometryBuffer(triangles, type, 0, format, 12, count);
      if (to == nullptr) throw std::runtime_error("Embree: no memory");
      std::memcpy(to, data, 12 * count);
    };
    copy(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, ball.vertices.data(), ball.vertices.size());
    copy(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, ball.triangles.data(), ball.triangles.size());
    attach(triangles, mesh);
    rtcCommitScene(mesh);
    for (const Instance<float>& instance : instances) {
      RTCGeometry place = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(place, mesh);
      rtcSetGeometryTransform(place, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                              instance.transform.rows[0].data());
      attach(place, scene_);
    }
    rtcReleaseScene(mesh);
    rtcCommitScene(scene_);
  }
  EmbreeField(const EmbreeField&) = delete;
  EmbreeField& operator=(const EmbreeField&) = delete;
  ~EmbreeField() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] bool closest(const Ray<float>& ray, Hit<float>& hit) const {
    RTCRayHit query{ray_of(ray), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit.geometry = query.hit.instID[0];
    hit.triangle = query.hit.primID;
    return true;
  }
  [[nodiscard]] bool any(const Ray<float>& ray) const {
    RTCRay query = ray_of(ray);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_, &context, &query);
    return query.tfar < 0;
  }

 private:
  static void attach(RTCGeometry geometry, RTCScene scene) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  static RTCRay ray_of(const Ray<float>& ray) {
    RTCRay query{};
    query.org_x = ray.origin.x;
    query.org_y = ray.origin.y;
    query.org_z = ray.origin.z;
    query.dir_x = ray.direction.x;
    query.dir_y = ray.direction.y;
    query.dir_z = ray.direction.z;
    query.tfar = std::numeric_limits<float>::infinity();
    query.mask = 0xffffffffU;
    return query;
  }

  RTCDevice device_ = rtcNewDevice(nullptr);
  RTCScene scene_ = rtcNewScene(device_);
};

double seconds(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double best_ns(std::size_t rays, const std::function<void()>& work) {
  double best = seconds(work);
  for (int i = 0; i < 2; ++i) best = std::min(best, seconds(work));
  return best * 1e9 / static_cast<double>(rays);
}

Scene<float> build(const Instances& instances, std::uint64_t flatten_limit) {
  BuildOptions options;
  options.flatten_limit = flatten_limit;
  return Scene<float>::build(instances, options);
}

/// Throws if there is a difference.
void compare_with_flat(const Ball& ball) {
  constexpr std::uint32_t kSide = 12;
  const Instances instances = field(ball, kSide);
  const Scene<float> shared = build(instances, 0);
  const Scene<float> flat = build(instances, std::numeric_limits<std::uint64_t>::max());
  for (const Kind& kind : kinds_of_rays(kSide)) {
    Hits hits(kind.rays.size()), expected(kind.rays.size());
    shared.closest_hits(kind.rays, hits);
    flat.closest_hits(kind.rays, expected);
    if (hits != expected) throw std::runtime_error(std::string("differs from flat: ") + kind.name);
  }
  fmt::print("{} triangles: as in a flat scene, bit by bit\n",
             instances.size() * ball.triangles.size());
}

void run(std::uint32_t side, std::uint32_t cuts) {
  const Ball ball = bumpy_ball(cuts);
  compare_with_flat(bumpy_ball(std::min(cuts, 64U)));
  const Instances instances = field(ball, side);
  std::vector<Scene<float>> built;
  const double build_time = seconds([&] { built.push_back(build(instances, 0)); });
  const Scene<float>& scene = built[0];
  fmt::print("{:.3g} triangles: built in {:.3f} s\n",
             static_cast<double>(instances.size() * ball.triangles.size()), build_time);
  const EmbreeField embree(ball, instances);
  fmt::print("{:<12} {:>6} | {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} | {}\n", "ns a ray", "hits",
             "closest", "batch", "Embree", "any", "batch", "Embree", "other hits");
  BatchOptions one_thread;
  one_thread.work.threads = 1;
  for (const Kind& kind : kinds_of_rays(side)) {
    const std::size_t n = kind.rays.size();
    Hits hits(n), batch(n), other(n);
    std::vector<std::uint8_t> found(n), any(n);
    const double single = best_ns(n, [&] {
      for (std::size_t i = 0; i < n; ++i)
        hits[i] = scene.closest_hit(kind.rays[i]).value_or(Hit<float>{});
    });
    const double together = best_ns(n, [&] { scene.closest_hits(kind.rays, batch, one_thread); });
    const double peer = best_ns(n, [&] {
      for (std::size_t i = 0; i < n; ++i) {
        other[i] = {};
        (void)embree.closest(kind.rays[i], other[i]);
      }
    });
    const double any_single = best_ns(n, [&] {
      for (std::size_t i = 0; i < n; ++i) any[i] = scene.any_hit(kind.rays[i]) ? 1 : 0;
    });
    const double any_batch = best_ns(n, [&] { scene.any_hits(kind.rays, found, one_thread); });
    const double any_peer = best_ns(n, [&] {
      for (std::size_t i = 0; i < n; ++i) any[i] = embree.any(kind.rays[i]) ? 1 : 0;
    });
    if (hits != batch) throw std::runtime_error("batch and single differ");
    std::size_t hit = 0, differ = 0;
    for (std::size_t i = 0; i < n; ++i) {
      hit += hits[i].triangle != kNone ? 1 : 0;
      differ += hits[i].triangle != other[i].triangle || hits[i].geometry != other[i].geometry;
    }
    fmt::print("{:<12} {:>6.2f} | {:>8.0f} {:>8.0f} {:>8.0f} | {:>8.0f} {:>8.0f} {:>8.0f} | {}\n",
               kind.name, static_cast<double>(hit) / static_cast<double>(n), single, together, peer,
               any_single, any_batch, any_peer, differ);
  }
}

}  // namespace
}  // namespace pierce::bench

int main(int argc, char** argv) {
  try {
    const auto number = [&](int i, std::uint32_t otherwise) {
      return argc > i ? static_cast<std::uint32_t>(std::stoul(argv[i])) : otherwise;
    };
    pierce::bench::run(number(1, 100), number(2, 224));
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_instances: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
