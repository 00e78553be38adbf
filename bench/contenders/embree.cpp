// SPDX-License-Identifier: Apache-2.0
//
// Embree ray by ray. Fast is its default scene, robust the one it offers for watertight results.
#include "contenders/embree_engine.h"
#include "contenders/families.h"
#include "contenders/parallel.h"
#include "contenders/ray_by_ray.h"

namespace pierce::bench {
namespace {

class EmbreeSingle : public RayByRay<float> {
 public:
  EmbreeSingle(std::string name, EmbreeEngine& engine)
      : RayByRay(std::move(name), engine), embree_(engine) {}

  void run() override {
    in_chunks(rays_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      const FlushDenormals flush;
      query_ == Query::Closest ? closest(begin, end) : any(begin, end);
    });
  }

 private:
  void closest(std::size_t begin, std::size_t end) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    for (std::size_t i = begin; i < end; ++i) {
      query.ray = embree_ray(rays_[i]);
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
      ray = embree_ray(rays_[i]);
      rtcOccluded1(embree_.scene(), &context, &ray);
      any_[i] = ray.tfar < 0 ? 1 : 0;
    }
  }

  EmbreeEngine& embree_;
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
    field.contenders.push_back(make_embree_packets(name, engine));
  } else {
    field.contenders.push_back(std::make_unique<EmbreeSingle>(name, engine));
  }
  return true;
}

std::string embree_version() { return RTC_VERSION_STRING; }

}  // namespace pierce::bench
