// SPDX-License-Identifier: Apache-2.0
//
// Embree in packets of 16 rays with the coherent flag, as a renderer that works in packets uses it.
#include "contenders/embree_engine.h"
#include "contenders/parallel.h"

namespace pierce::bench {
namespace {

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

std::unique_ptr<Contender> make_embree_packets(const std::string& name, EmbreeEngine& engine) {
  return std::make_unique<EmbreePackets>(name, engine);
}

}  // namespace pierce::bench
