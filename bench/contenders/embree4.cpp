// SPDX-License-Identifier: Apache-2.0
//
// Embree 4 beside Embree 3, in one process: loaded by name at run time, its symbols its own. It is
// there if the library is: on the system, or where PIERCE_EMBREE4 says (the Python package embreex
// 4.4 carries one).
#include <dlfcn.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "contenders/embree_engine.h"
#include "contenders/families.h"
#include "contenders/parallel.h"
#include "contenders/ray_by_ray.h"

namespace pierce::bench {
namespace {

// What Embree 4 writes: as Embree 3, but for numbers of instances at the end; their count depends
// on how it was built.
struct alignas(16) RayHit4 {
  RTCRay ray;
  RTCHit hit;
  unsigned more[24];
};

// Of rtcore.h of Embree 4, what is used here. Handles are those of Embree 3 by type only; the
// numbers of formats, flags and qualities are the same.
struct Embree4 {
  RTCDevice (*new_device)(const char*);
  void (*release_device)(RTCDevice);
  RTCError (*device_error)(RTCDevice);
  void (*monitor_memory)(RTCDevice, bool (*)(void*, ssize_t, bool), void*);
  RTCScene (*new_scene)(RTCDevice);
  void (*release_scene)(RTCScene);
  void (*scene_quality)(RTCScene, RTCBuildQuality);
  void (*commit_scene)(RTCScene);
  RTCGeometry (*new_geometry)(RTCDevice, RTCGeometryType);
  void (*geometry_quality)(RTCGeometry, RTCBuildQuality);
  void (*shared_buffer)(RTCGeometry, RTCBufferType, unsigned slot, RTCFormat, const void*,
                        std::size_t offset, std::size_t stride, std::size_t count);
  void (*commit_geometry)(RTCGeometry);
  unsigned (*attach_geometry)(RTCScene, RTCGeometry);
  void (*release_geometry)(RTCGeometry);
  void (*intersect)(RTCScene, RayHit4*, void* arguments);
  void (*occluded)(RTCScene, RTCRay*, void* arguments);
  long (*property)(RTCDevice, int);

  // Null if there is none.
  static const Embree4* loaded() {
    static const Embree4 kFunctions = load();
    return kFunctions.new_device != nullptr ? &kFunctions : nullptr;
  }

 private:
  static Embree4 load() {
    const char* named = std::getenv("PIERCE_EMBREE4");
    const char* const file = named != nullptr && *named != 0 ? named : "libembree4.so.4";
    // Deep: its own functions before those of the same names that the process has already.
    void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
    Embree4 found{};
    if (library == nullptr) {
      if (file == named) throw Error(ErrorCode::InvalidArgument, "PIERCE_EMBREE4: " + error());
      return found;
    }
    const auto get = [library](auto& function, const char* name) {
      function =
          reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
      if (function == nullptr) throw Error(ErrorCode::InvalidArgument, "Embree 4: " + error());
    };
    get(found.new_device, "rtcNewDevice");
    get(found.release_device, "rtcReleaseDevice");
    get(found.device_error, "rtcGetDeviceError");
    get(found.monitor_memory, "rtcSetDeviceMemoryMonitorFunction");
    get(found.new_scene, "rtcNewScene");
    get(found.release_scene, "rtcReleaseScene");
    get(found.scene_quality, "rtcSetSceneBuildQuality");
    get(found.commit_scene, "rtcCommitScene");
    get(found.new_geometry, "rtcNewGeometry");
    get(found.geometry_quality, "rtcSetGeometryBuildQuality");
    get(found.shared_buffer, "rtcSetSharedGeometryBuffer");
    get(found.commit_geometry, "rtcCommitGeometry");
    get(found.attach_geometry, "rtcAttachGeometry");
    get(found.release_geometry, "rtcReleaseGeometry");
    get(found.intersect, "rtcIntersect1");
    get(found.occluded, "rtcOccluded1");
    get(found.property, "rtcGetDeviceProperty");
    return found;
  }
  static std::string error() {
    const char* const text = dlerror();
    return text != nullptr ? text : "not found";
  }
};

class Embree4Engine : public Engine {
 public:
  Embree4Engine(std::string name, RTCBuildQuality quality, const Embree4& embree)
      : Engine(std::move(name)), quality_(quality), embree_(embree) {}
  ~Embree4Engine() override { Embree4Engine::release(); }

  BuildFigures build(const Mesh& mesh, unsigned threads) override {
    release();
    const std::string config = threads == 0 ? "" : "threads=" + std::to_string(threads);
    device_ = embree_.new_device(config.c_str());
    if (device_ == nullptr) throw Error(ErrorCode::InvalidArgument, "Embree 4 gives no device");
    embree_.monitor_memory(device_, count_memory, this);
    const std::int64_t before = bytes_;
    const auto start = std::chrono::steady_clock::now();
    const FlushDenormals flush;
    scene_ = embree_.new_scene(device_);
    embree_.scene_quality(scene_, quality_);
    RTCGeometry geometry = embree_.new_geometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    embree_.geometry_quality(geometry, quality_);
    embree_.shared_buffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                          mesh.vertices.data(), 0, sizeof(Vec3<float>), mesh.vertices.size());
    embree_.shared_buffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                          mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
    embree_.commit_geometry(geometry);
    embree_.attach_geometry(scene_, geometry);
    embree_.release_geometry(geometry);
    embree_.commit_scene(scene_);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    if (const RTCError error = embree_.device_error(device_); error != RTC_ERROR_NONE)
      throw Error(ErrorCode::InvalidArgument, "Embree 4 reports error " + std::to_string(error));
    return {time.count(), static_cast<std::uint64_t>(bytes_ - before), 0};
  }

  void release() override {
    if (scene_ != nullptr) embree_.release_scene(scene_);
    if (device_ != nullptr) embree_.release_device(device_);
    scene_ = nullptr;
    device_ = nullptr;
  }

  // Whether the ray hits; fills the hit.
  bool closest(RayHit4& query) const {
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.primID = RTC_INVALID_GEOMETRY_ID;
    embree_.intersect(scene_, &query, nullptr);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
  bool any(RTCRay& ray) const {
    embree_.occluded(scene_, &ray, nullptr);
    return ray.tfar < 0;
  }

 private:
  static bool count_memory(void* self, ssize_t bytes, bool /*post*/) {
    static_cast<Embree4Engine*>(self)->bytes_ += bytes;
    return true;
  }

  RTCBuildQuality quality_;
  const Embree4& embree_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::atomic<std::int64_t> bytes_{0};
};

class Embree4Single : public RayByRay<float> {
 public:
  Embree4Single(std::string name, Embree4Engine& engine)
      : RayByRay(std::move(name), engine), embree_(engine) {}

  void run() override {
    in_chunks(rays_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      const FlushDenormals flush;
      RayHit4 query{};
      for (std::size_t i = begin; i < end; ++i) {
        query.ray = embree_ray(rays_[i]);
        if (query_ == Query::Any) {
          any_[i] = embree_.any(query.ray) ? 1 : 0;
        } else if (embree_.closest(query)) {
          const RTCHit& hit = query.hit;
          hits_[i] = {query.ray.tfar, hit.u,        hit.v, 1 - hit.u - hit.v, 0,
                      hit.primID,     Facing::Front};
        } else {
          hits_[i] = {};
        }
      }
    });
  }

 private:
  Embree4Engine& embree_;
};

}  // namespace

bool has_embree4() { return Embree4::loaded() != nullptr; }

bool add_embree4(Field& field, const std::string& name) {
  const bool high = name == "embree4-high";
  if (!high && name != "embree4") return false;
  const Embree4* const embree = Embree4::loaded();
  if (embree == nullptr) {
    throw Error(ErrorCode::InvalidArgument,
                name + ": there is no libembree4.so.4; say where in PIERCE_EMBREE4");
  }
  auto& engine = shared_engine<Embree4Engine>(
      field, name, high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM, *embree);
  field.contenders.push_back(std::make_unique<Embree4Single>(name, engine));
  return true;
}

std::string embree4_version() {
  const Embree4* const embree = Embree4::loaded();
  if (embree == nullptr) return "none";
  RTCDevice device = embree->new_device("");
  const long version = embree->property(device, RTC_DEVICE_PROPERTY_VERSION);  // 40401: 4.4.1
  embree->release_device(device);
  return std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." +
         std::to_string(version % 100);
}

}  // namespace pierce::bench
