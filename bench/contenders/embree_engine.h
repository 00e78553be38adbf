// SPDX-License-Identifier: Apache-2.0
//
// Embree 3 as its manual advises: shared buffers, denormals flushed (only in here), scenes static.
// One device a scene, so that memory is counted a scene.
#pragma once

#include <embree3/rtcore.h>
#include <immintrin.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "contenders/contender.h"
#include "pierce/error.h"

namespace pierce::bench {

// Flush-to-zero and denormals-are-zero while it lives: Embree wants it, nobody else may have it.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040U); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
  ~FlushDenormals() { _mm_setcsr(before_); }

 private:
  unsigned before_;
};

class EmbreeEngine : public Engine {
 public:
  EmbreeEngine(std::string name, RTCSceneFlags flags, RTCBuildQuality quality)
      : Engine(std::move(name)), flags_(flags), quality_(quality) {}
  ~EmbreeEngine() override { release(); }

  BuildFigures build(const Mesh& mesh, unsigned threads) override {
    release();
    const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
    device_ = rtcNewDevice(config.c_str());
    if (device_ == nullptr) throw Error(ErrorCode::InvalidArgument, "Embree gives no device");
    rtcSetDeviceMemoryMonitorFunction(device_, count_memory, this);
    const std::int64_t before = bytes_;
    const auto start = std::chrono::steady_clock::now();
    const FlushDenormals flush;
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags_);
    rtcSetSceneBuildQuality(scene_, quality_);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality_);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.vertices.data(), 0, sizeof(Vec3<float>), mesh.vertices.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
      throw Error(ErrorCode::InvalidArgument, "Embree reports error " + std::to_string(error));
    return {time.count(), static_cast<std::uint64_t>(bytes_ - before), 0};
  }

  void release() override {
    if (scene_ != nullptr) rtcReleaseScene(scene_);
    if (device_ != nullptr) rtcReleaseDevice(device_);
    scene_ = nullptr;
    device_ = nullptr;
  }

  [[nodiscard]] RTCScene scene() const { return scene_; }

 private:
  static bool count_memory(void* self, ssize_t bytes, bool /*post*/) {
    static_cast<EmbreeEngine*>(self)->bytes_ += bytes;
    return true;
  }

  RTCSceneFlags flags_;
  RTCBuildQuality quality_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::int64_t> bytes_{0};
};

[[nodiscard]] inline RTCRay embree_ray(const Ray<float>& ray) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          ray.t_min,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          0,
          ray.t_max,
          ~0U,
          0,
          0};
}

/// Coherent packets of 16.
std::unique_ptr<Contender> make_embree_packets(const std::string& name, EmbreeEngine& engine);

}  // namespace pierce::bench
