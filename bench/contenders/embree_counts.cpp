// SPDX-License-Identifier: Apache-2.0
//
// All hits of a ray with Embree: a filter that counts each and takes none.
#include <embree3/rtcore.h>

#include <chrono>
#include <utility>

#include "contenders/embree_engine.h"
#include "contenders/hit_counts.h"

namespace pierce::bench {
namespace {

// Embree may report one triangle twice along a ray, so the triangles seen are remembered.
struct Counter {
  RTCIntersectContext context;  // first: Embree hands a pointer to it back
  std::vector<std::uint32_t> seen;
};

void count_and_reject(const RTCFilterFunctionNArguments* arguments) {
  auto* counter = reinterpret_cast<Counter*>(arguments->context);
  arguments->valid[0] = 0;
  const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
  for (const std::uint32_t before : counter->seen)
    if (before == triangle) return;
  counter->seen.push_back(triangle);
}

}  // namespace

HitCounts embree_hit_counts(const Mesh& mesh, std::span<const Ray<float>> rays, bool robust) {
  RTCDevice device = rtcNewDevice("");
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.vertices.data(), 0, sizeof(Vec3<float>), mesh.vertices.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  rtcSetGeometryIntersectFilterFunction(geometry, count_and_reject);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene);

  HitCounts result;
  result.counts.reserve(rays.size());
  Counter counter;
  const auto begin = std::chrono::steady_clock::now();
  for (const Ray<float>& ray : rays) {
    counter.seen.clear();
    rtcInitIntersectContext(&counter.context);
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &counter.context, &query);
    result.counts.push_back(static_cast<std::uint32_t>(counter.seen.size()));
  }
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  rtcReleaseScene(scene);
  rtcReleaseDevice(device);
  return result;
}

}  // namespace pierce::bench
