// SPDX-License-Identifier: Apache-2.0
#include "render/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bounds.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

constexpr Color kTop = {0.955F, 0.96F, 0.965F}, kBottom = {0.80F, 0.81F, 0.825F};
constexpr Color kEdge = {0.10F, 0.11F, 0.13F}, kCut = {0.86F, 0.45F, 0.33F};
constexpr unsigned kSkyRays = 8;  // of a sample on the ground, beside one to the lamp

void put_byte(float part, std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(
      std::lround(255.0F * std::clamp(std::isnan(part) ? 0.0F : part, 0.0F, 1.0F))));
}

// The mean of a pixel's samples, each weighted by how much of it there is.
void put_pixel(std::span<const Sample> samples, unsigned channels,
               std::vector<std::uint8_t>& bytes) {
  Color sum = {0, 0, 0};
  float cover = 0;
  for (const Sample& sample : samples) {
    sum = sum + sample.alpha * sample.color;
    cover += sample.alpha;
  }
  const Color color = cover > 0 ? 1 / cover * sum : sum;
  for (const float part : {color.x, color.y, color.z}) put_byte(part, bytes);
  if (channels == 4) put_byte(cover / static_cast<float>(samples.size()), bytes);
}

Sample behind(Background background, float height) {
  switch (background) {
    case Background::White:
      return {{1, 1, 1}};
    case Background::Transparent:
      return {{0, 0, 0}, 0};
    default:
      return {blend(kTop, kBottom, height)};
  }
}

}  // namespace

template <class Real>
Picture<Real>::Picture(const PictureOptions& options, const Camera& camera,
                       const Scene<Real>& scene, const Surface<Real>& surface,
                       const Shader<Real>& shader, const Marks<Real>& marks)
    : options_(options),
      camera_(camera),
      scene_(scene),
      surface_(surface),
      shader_(shader),
      marks_(marks) {
  if (!options.ground) return;
  floor_ = std::numeric_limits<double>::infinity();
  for_each_corner(scene.meshes(),
                  [&](const Vec& p) { floor_ = std::min(floor_, dot(p, camera.vertical)); });
  const Box box = box_of(scene.meshes());
  centre_ = box.centre();
  size_ = box.diagonal();
}

// Lines as wide as a pixel, measured where the surface is; fainter where triangles are only a few
// pixels high, which lines would hide.
template <class Real>
void Picture<Real>::put_edges(std::span<const Hit<Real>> hits, std::span<Sample> samples) const {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (hits[i].triangle == kNone) continue;
    const double pixel = camera_.pixel_at(static_cast<double>(hits[i].t));
    const auto [distance, height] = surface_.edge_distance(hits[i]);
    const double strength = std::clamp((height / pixel - 2) / 10, 0.1, 0.9);
    if (distance < 0.6 * pixel)
      samples[i].color = blend(samples[i].color, kEdge, static_cast<float>(strength));
  }
}

// Where a ray that hits nothing meets the ground, the shadow that the mesh casts there.
template <class Real>
void Picture<Real>::put_ground(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                               const BatchOptions& batch, std::span<Sample> samples) const {
  const Vec up = camera_.vertical, lamp = lamp_direction(camera_);
  std::vector<std::size_t> places;
  std::vector<Ray<Real>> outward;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec o = convert<double>(rays[i].origin), d = convert<double>(rays[i].direction);
    const double t = (floor_ - dot(o, up)) / dot(d, up);
    if (hits[i].triangle != kNone || !(t > 0) || !std::isfinite(t)) continue;
    const Vec p = o + t * d, off = p - centre_;
    if (std::hypot(off.x, off.y, off.z) > 3 * size_) continue;
    places.push_back(i);
    const Vec3<Real> start = convert<Real>(p);
    const std::uint64_t key = mix(options_.seed + 1) ^ i;
    const Vec to_lamp = lamp + 0.12 * cosine_direction(lamp, spread_point(i, key));
    outward.push_back({start, convert<Real>(to_lamp)});
    for (unsigned s = 0; s < kSkyRays; ++s)
      outward.push_back({start, convert<Real>(cosine_direction(up, spread_point(s, ~key)))});
  }
  if (options_.section) {
    for (Ray<Real>& ray : outward) options_.section->clip(ray);
  }
  // A mesh that stands on the ground is no obstacle where it touches it.
  BatchOptions open = batch;
  open.range = Range::OpenStart;
  std::vector<std::uint8_t> blocked(outward.size());
  scene_.any_hits(outward, blocked, open);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::uint8_t* here = blocked.data() + k * (1 + kSkyRays);
    float sky = 0;
    for (unsigned s = 1; s <= kSkyRays; ++s) sky += here[s] / static_cast<float>(kSkyRays);
    const float shadow = 0.30F * static_cast<float>(here[0]) + 0.40F * sky;
    Sample& sample = samples[places[k]];
    // Black, so much of it, over what is behind.
    sample.color = (1 - shadow) * sample.alpha * sample.color;
    sample.alpha += shadow * (1 - sample.alpha);
    if (sample.alpha > 0) sample.color = 1 / sample.alpha * sample.color;
  }
}

template <class Real>
std::uint64_t Picture<Real>::draw(unsigned first, unsigned end, const BatchOptions& batch,
                                  std::vector<std::uint8_t>& bytes) const {
  const unsigned width = camera_.size.width;
  const SamplePlaces places{width, options_.samples, options_.seed};
  std::vector<Ray<Real>> rays;
  std::vector<Sample> samples;
  const std::size_t count = std::size_t{end - first} * width * options_.samples;
  rays.reserve(count);
  samples.reserve(count);
  for (unsigned y = first; y < end; ++y) {
    const float height = (static_cast<float>(y) + 0.5F) / static_cast<float>(camera_.size.height);
    samples.resize(samples.size() + std::size_t{width} * options_.samples,
                   behind(options_.background, height));
    for (unsigned x = 0; x < width; ++x) {
      for (unsigned s = 0; s < options_.samples; ++s) {
        const Point2 at = places.at(x, y, s);
        rays.push_back(camera_.ray<Real>(at.x, at.y));
      }
    }
  }
  std::vector<bool> cut(rays.size());
  if (options_.section) {
    for (std::size_t i = 0; i < rays.size(); ++i) cut[i] = options_.section->clip(rays[i]);
  }
  std::vector<Hit<Real>> hits(rays.size());
  scene_.closest_hits(rays, hits, batch);

  std::vector<Color> colors(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) colors[i] = samples[i].color;
  const std::uint64_t number = std::uint64_t{first} * width * options_.samples;
  shader_.shade(rays, hits, number, batch, colors);
  std::uint64_t met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].triangle == kNone) continue;
    ++met;
    // Whoever comes in through the section and leaves through a back was inside there.
    if (cut[i] && hits[i].facing == Facing::Back) {
      hits[i] = Hit<Real>{};
      hits[i].t = rays[i].t_min;
      samples[i] = {kCut, 1, static_cast<double>(rays[i].t_min)};
    } else {
      samples[i] = {colors[i], 1, static_cast<double>(hits[i].t)};
    }
  }
  if (options_.edges) put_edges(hits, samples);
  if (options_.ground) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (std::isfinite(samples[i].depth)) hits[i].triangle = 0;  // not the ground's, cut or not
    }
    put_ground(rays, hits, batch, samples);
  }
  marks_.draw(first, end, places, samples);
  for (std::size_t i = 0; i < samples.size(); i += options_.samples)
    put_pixel(std::span(samples).subspan(i, options_.samples), options_.channels(), bytes);
  return met;
}

template class Picture<float>;
template class Picture<double>;

}  // namespace pierce::tool
