// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>

#include "pierce/pierce.h"
#include "unkind/ways.h"

namespace pierce::bench {
namespace {

WorkOptions one_thread() { return {.threads = 1}; }

// A subject in the numbers of its scene, and the scene.
template <class Real>
class Asked {
 public:
  explicit Asked(const Subject& subject, Ask ask) : ask_(ask) {
    vertices_ = converted(subject.shape.vertices);
    triangles_ = subject.shape.triangles;
    points_ = converted(subject.points);
    for (const Ray<double>& r : subject.rays)
      rays_.push_back({convert<Real>(r.origin), convert<Real>(r.direction)});
    grid_ = {convert<Real>(subject.grid.origin), convert<Real>(subject.grid.spacing),
             subject.grid.size};
    locate_.open_mesh = subject.open_mesh;
    locate_.work = one_thread();
    nearest_.work = one_thread();
    batch_.work = one_thread();
    batch_.sides = query_.sides = subject.sides;
    build(subject);
    if (!subject.moved.empty()) {
      vertices_ = converted(subject.moved);
      scene_->refit(MeshView<Real>{vertices_, triangles_}, one_thread());
    }
    if (ask == Ask::NextOrigin) keep_rays_that_hit();
    count_ = ask == Ask::Voxelise ? grid_.cells() : std::max(rays_.size(), points_.size());
    together_ = subject.together == 0 ? count_ : subject.together;
    make_room();
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  void one_by_one(std::vector<double>& answers) {
    for (std::size_t i = 0; i < count_; ++i) answers[i] = one(i);
  }

  void in_batches(std::vector<double>& answers) {
    for (std::size_t i = 0; i < count_; i += together_)
      batch(i, std::min(together_, count_ - i), answers);
  }

 private:
  static std::vector<Vec3<Real>> converted(const std::vector<Double3>& points) {
    std::vector<Vec3<Real>> all;
    for (const Double3& p : points) all.push_back(convert<Real>(p));
    return all;
  }

  void build(const Subject& subject) {
    const std::span<const Triangle> all = triangles_;
    const std::size_t seen = all.size() - subject.hidden;
    std::vector<MeshView<Real>> meshes = {{vertices_, all.first(seen)}};
    std::vector<std::uint32_t> masks = {1};
    if (subject.hidden != 0) {
      meshes.push_back({vertices_, all.subspan(seen)});
      masks.push_back(2);
      batch_.mask = query_.mask = 1;
    }
    scene_ = Scene<Real>::build(meshes,
                                {.quality = subject.quality, .masks = masks, .work = one_thread()});
  }

  void keep_rays_that_hit() {
    std::vector<Ray<Real>> kept;
    for (const Ray<Real>& ray : rays_) {
      const auto hit = scene_->closest_hit(ray);
      if (!hit) continue;
      kept.push_back(ray);
      hits_.push_back(*hit);
    }
    rays_ = std::move(kept);
  }

  void make_room() {
    if (ask_ == Ask::Closest) hits_.resize(count_);
    if (ask_ == Ask::Count) counts_.resize(count_);
    if (ask_ == Ask::NextOrigin) origins_.resize(count_);
    if (ask_ == Ask::Nearest) near_.resize(count_);
    if (ask_ == Ask::SignedDistance) distances_.resize(count_);
    if (ask_ == Ask::Locate || ask_ == Ask::Voxelise) locations_.resize(count_);
  }

  double one(std::size_t i) {
    switch (ask_) {
      case Ask::Closest: {
        const auto hit = scene_->closest_hit(rays_[i], query_);
        return static_cast<double>(hit ? hit->t : kInfinity<Real>);
      }
      case Ask::AllHits:
        scene_->all_hits(rays_[i], list_);
        return static_cast<double>(list_.size());
      case Ask::Count:
        return scene_->count_hits(rays_[i]);
      case Ask::NextOrigin:
        return scene_->next_origin(rays_[i], hits_[i], Side::Before) ? 1 : 0;
      case Ask::Locate:
        return static_cast<double>(scene_->locate(points_[i], locate_));
      case Ask::SignedDistance:
        return static_cast<double>(scene_->signed_distance(points_[i], locate_));
      case Ask::Nearest: {
        const auto near = scene_->nearest_point(points_[i]);
        return static_cast<double>(near ? near->distance : kInfinity<Real>);
      }
      case Ask::Voxelise:
        break;
    }
    return 0;
  }

  void batch(std::size_t first, std::size_t count, std::vector<double>& answers) {
    const auto part = [&](auto& all) { return std::span(all).subspan(first, count); };
    const auto rays = std::span<const Ray<Real>>(rays_);
    const auto points = std::span<const Vec3<Real>>(points_);
    const auto put = [&](const auto& value) {
      for (std::size_t i = first; i < first + count; ++i)
        answers[i] = static_cast<double>(value(i));
    };
    switch (ask_) {
      case Ask::Closest:
        scene_->closest_hits(rays.subspan(first, count), part(hits_), batch_);
        return put([&](std::size_t i) { return hits_[i].t; });
      case Ask::AllHits: {
        const HitLists<Real> lists = scene_->all_hits(rays.subspan(first, count), batch_);
        return put([&](std::size_t i) { return lists.of(i - first).size(); });
      }
      case Ask::Count:
        scene_->count_hits(rays.subspan(first, count), part(counts_), batch_);
        return put([&](std::size_t i) { return counts_[i]; });
      case Ask::NextOrigin:
        scene_->next_origins(rays.subspan(first, count),
                             std::span<const Hit<Real>>(hits_).subspan(first, count), Side::Before,
                             part(origins_), batch_);
        return put([&](std::size_t i) { return origins_[i] ? 1 : 0; });
      case Ask::Locate:
        scene_->locate(points.subspan(first, count), part(locations_), locate_);
        return put([&](std::size_t i) { return static_cast<int>(locations_[i]); });
      case Ask::SignedDistance:
        scene_->signed_distances(points.subspan(first, count), part(distances_), locate_);
        return put([&](std::size_t i) { return distances_[i]; });
      case Ask::Nearest:
        scene_->nearest_points(points.subspan(first, count), part(near_), nearest_);
        return put([&](std::size_t i) { return near_[i].distance; });
      case Ask::Voxelise:
        voxelise(*scene_, grid_, std::span<Location>(locations_), locate_);
        return put([&](std::size_t i) { return static_cast<int>(locations_[i]); });
    }
  }

  Ask ask_;
  std::vector<Vec3<Real>> vertices_, points_;
  std::vector<Triangle> triangles_;
  std::vector<Ray<Real>> rays_;
  Grid<Real> grid_{};
  LocateOptions locate_;
  NearestOptions<Real> nearest_;
  BatchOptions batch_;
  QueryOptions query_;
  std::optional<Scene<Real>> scene_;
  std::size_t count_ = 0, together_ = 0;
  // Answers of the batches, and of all_hits.
  std::vector<Hit<Real>> hits_, list_;
  std::vector<std::uint32_t> counts_;
  std::vector<std::optional<Vec3<Real>>> origins_;
  std::vector<NearestPoint<Real>> near_;
  std::vector<Real> distances_;
  std::vector<Location> locations_;
};

template <class Real>
void add_ways(const Subject& subject, Ask ask, std::vector<Way>& ways) {
  const auto asked = std::make_shared<Asked<Real>>(subject, ask);
  if (ask != Ask::Voxelise) {
    ways.push_back(
        {"one", asked->count(), [asked](std::vector<double>& a) { asked->one_by_one(a); }});
  }
  ways.push_back(
      {"batch", asked->count(), [asked](std::vector<double>& a) { asked->in_batches(a); }});
}

}  // namespace

void add_pierce_ways(const Subject& subject, Ask ask, std::vector<Way>& ways) {
  subject.in_double ? add_ways<double>(subject, ask, ways) : add_ways<float>(subject, ask, ways);
}

}  // namespace pierce::bench
