// SPDX-License-Identifier: Apache-2.0
//
// Embree 3 as its manual advises: shared buffers, denormals flushed (only in here), scenes static,
// rays aligned. Fast is its default scene, robust the one it offers for watertight results; packets
// of 16 carry the coherent flag. One device a scene, so that memory is counted a scene.
#include <embree3/rtcore.h>
#include <immintrin.h>

#include <atomic>
#include <bit>
#include <chrono>
#include <limits>
#include <string>

#include "contenders/families.h"
#include "contenders/parallel.h"
#include "pierce/error.h"

namespace pierce::bench {
namespace {

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

class EmbreeSingle : public Contender {
 public:
  EmbreeSingle(std::string name, EmbreeEngine& engine)
      : Contender(std::move(name), Kind::Other, engine), embree_(engine) {}

  void prepare(const RaySet& set, Query query, unsigned threads) override {
    threads_ = threads;
    query_ = query;
    rays_ = set.rays;
    hits_.assign(query == Query::Closest ? rays_.size() : 0, {});
    any_.assign(query == Query::Any ? rays_.size() : 0, 0);
  }

  void run() override {
    in_chunks(rays_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      const FlushDenormals flush;
      query_ == Query::Closest ? closest(begin, end) : any(begin, end);
    });
  }

  void collect(Answers& answers) override { answers = {hits_, {}, any_}; }

 private:
  static void load(RTCRay& out, const Ray<float>& ray) {
    out = {ray.origin.x,
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

  void closest(std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    for (std::size_t i = begin; i < end; ++i) {
      load(query.ray, rays_[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.primID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(embree_.scene(), &context, &query);
      const RTCHit& hit = query.hit;
      if (hit.geomID == RTC_INVALID_GEOMETRY_ID) {
        hits_[i] = {};
      } else {
        hits_[i] = {query.ray.tfar, hit.u, hit.v, 1 - hit.u - hit.v, 0, hit.primID, Facing::Front};
      }
    }
  }

  void any(std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray;
    for (std::size_t i = begin; i < end; ++i) {
      load(ray, rays_[i]);
      rtcOccluded1(embree_.scene(), &context, &ray);
      any_[i] = ray.tfar < 0 ? 1 : 0;
    }
  }

  EmbreeEngine& embree_;
  Query query_ = Query::Closest;
  std::span<const Ray<float>> rays_;
  std::vector<Hit<float>> hits_;
  std::vector<std::uint8_t> any_;
};

constexpr std::size_t kPacket = 16;

// Rays wait in packets, structure of arrays, as a renderer that works in packets has them.
class EmbreePackets : public Contender {
 public:
  EmbreePackets(std::string name, EmbreeEngine& engine)
      : Contender(std::move(name), Kind::Other, engine), embree_(engine) {}

  void prepare(const RaySet& set, Query query, unsigned threads) override {
    threads_ = threads;
    query_ = query;
    count_ = set.rays.size();
    packets_.assign((count_ + kPacket - 1) / kPacket, RTCRay16{});
    results_.assign(packets_.size(), Result{});
    for (std::size_t i = 0; i < count_; ++i) {
      RTCRay16& p = packets_[i / kPacket];
      const std::size_t lane = i % kPacket;
      const Ray<float>& ray = set.rays[i];
      p.org_x[lane] = ray.origin.x;
      p.org_y[lane] = ray.origin.y;
      p.org_z[lane] = ray.origin.z;
      p.tnear[lane] = ray.t_min;
      p.dir_x[lane] = ray.direction.x;
      p.dir_y[lane] = ray.direction.y;
      p.dir_z[lane] = ray.direction.z;
      p.tfar[lane] = ray.t_max;
      p.mask[lane] = ~0U;
    }
  }

  void run() override {
    in_chunks(packets_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      const FlushDenormals flush;
      query_ == Query::Closest ? closest(begin, end) : any(begin, end);
    });
  }

  void collect(Answers& answers) override {
    answers = {};
    for (std::size_t i = 0; i < count_; ++i) {
      const Result& r = results_[i / kPacket];
      const std::size_t lane = i % kPacket;
      if (query_ == Query::Any) {
        answers.any.push_back(r.t[lane] < 0 ? 1 : 0);
      } else if (r.triangle[lane] == RTC_INVALID_GEOMETRY_ID) {
        answers.hits.push_back({});
      } else {
        answers.hits.push_back({r.t[lane], r.u[lane], r.v[lane], 1 - r.u[lane] - r.v[lane], 0,
                                r.triangle[lane], Facing::Front});
      }
    }
  }

 private:
  struct alignas(64) Result {
    float t[kPacket], u[kPacket], v[kPacket];
    unsigned triangle[kPacket];
  };

  // Lanes past the last ray are asleep.
  void load_active(std::size_t packet, int (&active)[kPacket]) const {
    for (std::size_t lane = 0; lane < kPacket; ++lane)
      active[lane] = packet * kPacket + lane < count_ ? -1 : 0;
  }

  void closest(std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int active[kPacket];
    alignas(64) RTCRayHit16 query;
    for (std::size_t p = begin; p < end; ++p) {
      load_active(p, active);
      query.ray = packets_[p];
      for (std::size_t lane = 0; lane < kPacket; ++lane) {
        query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        query.hit.primID[lane] = RTC_INVALID_GEOMETRY_ID;
      }
      rtcIntersect16(active, embree_.scene(), &context, &query);
      Result& out = results_[p];
      for (std::size_t lane = 0; lane < kPacket; ++lane) {
        out.t[lane] = query.ray.tfar[lane];
        out.u[lane] = query.hit.u[lane];
        out.v[lane] = query.hit.v[lane];
        out.triangle[lane] = query.hit.primID[lane];
      }
    }
  }

  void any(std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int active[kPacket];
    for (std::size_t p = begin; p < end; ++p) {
      load_active(p, active);
      alignas(64) RTCRay16 ray = packets_[p];
      rtcOccluded16(active, embree_.scene(), &context, &ray);
      for (std::size_t lane = 0; lane < kPacket; ++lane) results_[p].t[lane] = ray.tfar[lane];
    }
  }

  EmbreeEngine& embree_;
  Query query_ = Query::Closest;
  std::size_t count_ = 0;
  std::vector<RTCRay16> packets_;
  std::vector<Result> results_;
};

}  // namespace

bool add_embree(Field& field, const std::string& name) {
  const bool robust = name == "embree-robust";
  const bool high = name == "embree-high";
  if (!robust && !high && name != "embree" && name != "embree-16") return false;
  auto& engine =
      shared_engine<EmbreeEngine>(field,
                                  robust ? "embree-robust"
                                  : high ? "embree-high"
                                         : "embree",
                                  robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE,
                                  high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
  if (name == "embree-16") {
    field.contenders.push_back(std::make_unique<EmbreePackets>(name, engine));
  } else {
    field.contenders.push_back(std::make_unique<EmbreeSingle>(name, engine));
  }
  return true;
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace pierce::bench
