// SPDX-License-Identifier: Apache-2.0
//
// Shades that cast rays from the hits: ambient occlusion, and clay under a lamp and a sky.
//
// Rays start where Scene::next_origin says, on the viewer's side of the surface, so that none slips
// through it or is stopped by the triangle that it starts from.
#include <algorithm>
#include <optional>

#include "render/shade.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

template <class Real>
struct Spot {
  Vec face_normal, normal;  // on the viewer's side
  Vec3<Real> start;
};

template <class Real>
Spot<Real> spot_of(const Surface<Real>& surface, const Ray<Real>& ray, const Hit<Real>& hit,
                   const std::optional<Vec3<Real>>& start) {
  const Vec d = convert<double>(ray.direction);
  // There is no start only for a camera that stands on the surface.
  Spot<Real> spot{surface.face_normal(hit), surface.normal(hit), start.value_or(ray.origin)};
  if (dot(spot.face_normal, d) > 0) spot.face_normal = -spot.face_normal;
  if (dot(spot.normal, spot.face_normal) < 0) spot.normal = -spot.normal;
  return spot;
}

template <class Real>
class LightShader : public Shader<Real> {
 public:
  LightShader(Shade shade, const Surface<Real>& surface, const Camera& camera,
              const Scene<Real>& scene, const LightOptions& options)
      : shade_(shade), surface_(surface), scene_(scene), options_(options) {
    up_ = normalized(camera.up);
    lamp_ = lamp_direction(camera);
    lamps_ = shade == Shade::Clay ? std::max(1U, options.samples / 4) : 0;
  }

  void shade(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits, std::uint64_t first,
             const BatchOptions& batch, std::span<Color> colors) const override {
    const std::size_t each = options_.samples + lamps_;
    const std::size_t chunk = std::max<std::size_t>(1, (std::size_t{1} << 20) / each);
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].triangle != kNone) places.push_back(i);
      if (places.size() == chunk || (i + 1 == hits.size() && !places.empty())) {
        shade_some(places, rays, hits, first, batch, colors);
        places.clear();
      }
    }
  }

 private:
  void shade_some(std::span<const std::size_t> places, std::span<const Ray<Real>> rays,
                  std::span<const Hit<Real>> hits, std::uint64_t first, const BatchOptions& batch,
                  std::span<Color> colors) const {
    std::vector<Ray<Real>> inward;
    std::vector<Hit<Real>> hit;
    for (const std::size_t i : places) {
      inward.push_back(rays[i]);
      hit.push_back(hits[i]);
    }
    std::vector<std::optional<Vec3<Real>>> starts(places.size());
    scene_.next_origins(inward, hit, Side::Before, starts, batch);

    std::vector<Ray<Real>> outward;
    std::vector<Spot<Real>> spots;
    for (std::size_t k = 0; k < places.size(); ++k) {
      spots.push_back(spot_of(surface_, inward[k], hit[k], starts[k]));
      aim(spots.back(), first + places[k], outward);
    }
    if (options_.section) {
      for (Ray<Real>& ray : outward) options_.section->clip(ray);
    }
    std::vector<std::uint8_t> blocked(outward.size());
    scene_.any_hits(outward, blocked, batch);

    const std::size_t each = options_.samples + lamps_;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const auto rays_k = std::span(std::as_const(outward)).subspan(k * each, each);
      const auto blocked_k = std::span(std::as_const(blocked)).subspan(k * each, each);
      colors[places[k]] = color(spots[k], hits[places[k]], rays_k, blocked_k);
    }
  }

  // First the rays into the hemisphere, then those to points of the lamp.
  void aim(const Spot<Real>& spot, std::uint64_t number, std::vector<Ray<Real>>& outward) const {
    const std::uint64_t key = mix(options_.seed) ^ number;
    for (unsigned s = 0; s < options_.samples; ++s) {
      const Vec direction = cosine_direction(spot.normal, spread_point(s, key));
      outward.push_back({spot.start, convert<Real>(direction)});
    }
    for (unsigned s = 0; s < lamps_; ++s) {
      const Vec spread = cosine_direction(lamp_, spread_point(s, ~key));
      outward.push_back({spot.start, convert<Real>(lamp_ + 0.12 * spread)});
    }
  }

  [[nodiscard]] Color color(const Spot<Real>& spot, const Hit<Real>& hit,
                            std::span<const Ray<Real>> outward,
                            std::span<const std::uint8_t> blocked) const {
    // A ray that leaves below the surface (possible where normals are interpolated) sees nothing.
    const auto is_free = [&](std::size_t s) {
      return blocked[s] == 0 && dot(convert<double>(outward[s].direction), spot.face_normal) > 0;
    };
    Color sky = {0, 0, 0};
    for (std::size_t s = 0; s < options_.samples; ++s) {
      if (!is_free(s)) continue;
      const double height = dot(normalized(convert<double>(outward[s].direction)), up_);
      sky = sky + (1 / static_cast<float>(options_.samples)) * sky_color(height);
    }
    if (shade_ == Shade::Ao) return sky;  // the fraction itself, as a number

    float lit = 0;
    for (std::size_t s = options_.samples; s < outward.size(); ++s) lit += is_free(s) ? 1.0F : 0.0F;
    lit *= static_cast<float>(std::max(0.0, dot(spot.normal, lamp_))) / static_cast<float>(lamps_);
    const Color light = sky + lit * Color{0.86F, 0.78F, 0.66F};
    const Color base = surface_.color(hit, {0.72F, 0.68F, 0.63F});
    return encode_light({base.x * light.x, base.y * light.y, base.z * light.z});
  }

  // White for ao, so that the picture shows occlusion and no more.
  [[nodiscard]] Color sky_color(double height) const {
    if (shade_ == Shade::Ao) return {1, 1, 1};
    const auto k = static_cast<float>(0.5 + 0.5 * height);
    return blend({0.20F, 0.17F, 0.14F}, {0.50F, 0.58F, 0.72F}, k);
  }

  Shade shade_;
  const Surface<Real>& surface_;
  const Scene<Real>& scene_;
  LightOptions options_;
  Vec up_, lamp_;
  unsigned lamps_ = 0;
};

}  // namespace

template <class Real>
std::unique_ptr<Shader<Real>> make_light_shader(Shade shade, const Surface<Real>& surface,
                                                const Camera& camera, const Scene<Real>& scene,
                                                const LightOptions& options) {
  return std::make_unique<LightShader<Real>>(shade, surface, camera, scene, options);
}

template std::unique_ptr<Shader<float>> make_light_shader(Shade, const Surface<float>&,
                                                          const Camera&, const Scene<float>&,
                                                          const LightOptions&);
template std::unique_ptr<Shader<double>> make_light_shader(Shade, const Surface<double>&,
                                                           const Camera&, const Scene<double>&,
                                                           const LightOptions&);

}  // namespace pierce::tool
