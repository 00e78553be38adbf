// SPDX-License-Identifier: Apache-2.0
//
// Embree's default scene, one ray a call. All hits: a filter that notes each and takes none, then a
// sort. A refitted subject is a scene whose geometry is said to be refitted.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <utility>

#include "contenders/embree_engine.h"
#include "unkind/ways.h"

namespace pierce::bench {
namespace {

using Float3 = Vec3<float>;

// A back that faces the ray does not count, or a front.
template <bool kFront>
void one_side(const RTCFilterFunctionNArguments* arguments) {
  RTCRayN* const ray = arguments->ray;
  RTCHitN* const hit = arguments->hit;
  const unsigned n = arguments->N;
  const float along = RTCHitN_Ng_x(hit, n, 0) * RTCRayN_dir_x(ray, n, 0) +
                      RTCHitN_Ng_y(hit, n, 0) * RTCRayN_dir_y(ray, n, 0) +
                      RTCHitN_Ng_z(hit, n, 0) * RTCRayN_dir_z(ray, n, 0);
  if ((along < 0) != kFront) arguments->valid[0] = 0;
}

// What a ray met. Embree may report a triangle twice along a ray.
struct Collector {
  RTCIntersectContext context;  // first: Embree hands a pointer to it back
  std::vector<std::pair<float, unsigned>> met;
};

void note_and_reject(const RTCFilterFunctionNArguments* arguments) {
  auto* collector = reinterpret_cast<Collector*>(arguments->context);
  arguments->valid[0] = 0;
  collector->met.emplace_back(RTCRayN_tfar(arguments->ray, arguments->N, 0),
                              RTCHitN_primID(arguments->hit, arguments->N, 0));
}

// The square of the distance to a segment.
float to_segment(const Float3& p, const Float3& a, const Float3& b) {
  const Float3 along = b - a;
  const float square = dot(along, along);
  const float s = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0F, 1.0F) : 0.0F;
  const Float3 off = p - (a + s * along);
  return dot(off, off);
}

// The square of the distance to a triangle: to its plane over the inside, else to an edge.
float to_triangle(const Float3& p, const Float3& a, const Float3& b, const Float3& c) {
  const Float3 normal = cross(b - a, c - a);
  const float square = dot(normal, normal);
  const Float3 pa = a - p;
  const Float3 pb = b - p;
  const Float3 pc = c - p;
  if (square > 0 && dot(normal, cross(pa, pb)) >= 0 && dot(normal, cross(pb, pc)) >= 0 &&
      dot(normal, cross(pc, pa)) >= 0) {
    const float height = dot(normal, pa);
    return height * height / square;
  }
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

class EmbreeAsked {
 public:
  EmbreeAsked(const Subject& subject, Ask ask) : ask_(ask) {
    vertices_ = converted(subject.shape.vertices, subject.centre);
    vertices_.reserve(vertices_.size() + 1);  // Embree reads past the last
    triangles_ = subject.shape.triangles;
    points_ = converted(subject.points, subject.centre);
    for (const Ray<double>& r : subject.rays)
      rays_.push_back({to_float(r.origin - subject.centre), to_float(r.direction)});
    build(subject);
    if (!subject.moved.empty()) refit(converted(subject.moved, subject.centre));
  }
  EmbreeAsked(const EmbreeAsked&) = delete;
  EmbreeAsked& operator=(const EmbreeAsked&) = delete;
  ~EmbreeAsked() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] std::size_t count() const { return std::max(rays_.size(), points_.size()); }
  [[nodiscard]] bool knows_masks() const {
    return rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0;
  }

  void answer(std::vector<double>& answers) {
    const FlushDenormals flush;
    for (std::size_t i = 0; i < count(); ++i) answers[i] = one(i);
  }

 private:
  static std::vector<Float3> converted(const std::vector<Double3>& points, const Double3& centre) {
    std::vector<Float3> all;
    for (const Double3& p : points) all.push_back(to_float(p - centre));
    return all;
  }

  void build(const Subject& subject) {
    const bool moves = !subject.moved.empty();
    const FlushDenormals flush;
    device_ = rtcNewDevice("threads=1");
    if (device_ == nullptr) throw Error(ErrorCode::InvalidArgument, "Embree gives no device");
    scene_ = rtcNewScene(device_);
    if (moves) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    const std::size_t seen = triangles_.size() - subject.hidden;
    attach(subject, 0, seen);
    if (subject.hidden != 0) attach(subject, seen, subject.hidden);
    rtcCommitScene(scene_);
  }

  void attach(const Subject& subject, std::size_t first, std::size_t count) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(
        geometry, subject.moved.empty() ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_REFIT);
    rtcSetGeometryMask(geometry, first == 0 ? 1 : 2);
    if (subject.sides != Sides::Both) {
      rtcSetGeometryIntersectFilterFunction(
          geometry, subject.sides == Sides::Front ? one_side<true> : one_side<false>);
    }
    mask_ = subject.hidden != 0 ? 1 : ~0U;
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices_.data(), 0, sizeof(Float3), vertices_.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               triangles_.data(), first * sizeof(Triangle), sizeof(Triangle),
                               count);
    if (ask_ == Ask::AllHits || ask_ == Ask::Count || ask_ == Ask::Locate)
      rtcSetGeometryIntersectFilterFunction(geometry, note_and_reject);
    if (ask_ == Ask::Nearest) {
      rtcSetGeometryUserData(geometry, this);
      rtcSetGeometryPointQueryFunction(geometry, nearer);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }

  void refit(const std::vector<Float3>& moved) {
    const FlushDenormals flush;
    std::copy(moved.begin(), moved.end(), vertices_.begin());
    RTCGeometry geometry = rtcGetGeometry(scene_, 0);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry);
    rtcCommitScene(scene_);
  }

  double one(std::size_t i) {
    if (ask_ == Ask::Nearest) return nearest(points_[i]);
    if (ask_ == Ask::Closest) return closest(rays_[i]);
    if (ask_ == Ask::Locate) return hits_of({points_[i], {0, 0, 1}}) % 2 == 1 ? 1 : -1;
    return static_cast<double>(hits_of(rays_[i]));
  }

  double closest(const Ray<float>& ray) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query;
    query.ray = embree_ray(ray);
    query.ray.mask = mask_;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kInfinity<double>
                                                       : static_cast<double>(query.ray.tfar);
  }

  std::size_t hits_of(const Ray<float>& ray) {
    auto& met = collector_.met;
    met.clear();
    rtcInitIntersectContext(&collector_.context);
    RTCRayHit query{};
    query.ray = embree_ray(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &collector_.context, &query);
    std::sort(met.begin(), met.end());
    return static_cast<std::size_t>(std::unique(met.begin(), met.end()) - met.begin());
  }

  static bool nearer(RTCPointQueryFunctionArguments* arguments) {
    const auto* self = static_cast<const EmbreeAsked*>(arguments->userPtr);
    const RTCPointQuery& query = *arguments->query;
    const auto& [a, b, c] = self->triangles_[arguments->primID];
    const float square = to_triangle({query.x, query.y, query.z}, self->vertices_[a],
                                     self->vertices_[b], self->vertices_[c]);
    if (square >= query.radius * query.radius) return false;
    arguments->query->radius = std::sqrt(square);
    return true;
  }

  double nearest(const Float3& p) {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{p.x, p.y, p.z, 0, kInfinity<float>};
    rtcPointQuery(scene_, &query, &context, nullptr, this);
    return static_cast<double>(query.radius);
  }

  Ask ask_;
  std::vector<Float3> vertices_, points_;
  std::vector<Triangle> triangles_;
  std::vector<Ray<float>> rays_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  unsigned mask_ = ~0U;  // of the rays
  Collector collector_;
};

}  // namespace

void add_embree_way(const Subject& subject, Ask ask, std::vector<Way>& ways) {
  switch (ask) {
    case Ask::Closest:
    case Ask::AllHits:
    case Ask::Count:
    case Ask::Locate:
    case Ask::Nearest:
      break;
    case Ask::NextOrigin:
    case Ask::SignedDistance:
    case Ask::Voxelise:
      return;
  }
  const auto asked = std::make_shared<EmbreeAsked>(subject, ask);
  if (subject.hidden != 0 && !asked->knows_masks()) return;
  ways.push_back({"embree", asked->count(), [asked](std::vector<double>& a) { asked->answer(a); }});
}

}  // namespace pierce::bench
