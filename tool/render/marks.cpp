// SPDX-License-Identifier: Apache-2.0
#include "render/marks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bounds.h"
#include "pierce/barycentric.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

constexpr double kHalfWidth = 1.2, kRadius = 4.5;  // of lines and balls, in pixels
constexpr Color kHitRay = {0.10F, 0.45F, 0.88F}, kMissRay = {0.52F, 0.55F, 0.60F};
constexpr Color kBall = {0.85F, 0.12F, 0.16F};

struct Columns {
  unsigned first, end;
};

Columns columns_between(double low, double high, unsigned width) {
  const auto at = [width](double x) {
    return static_cast<unsigned>(std::clamp(x, 0.0, static_cast<double>(width)));
  };
  return {at(std::floor(low)), at(std::ceil(high))};
}

}  // namespace

template <class Real>
Marks<Real>::Marks(const Camera& camera, std::span<const MeshView<Real>> meshes,
                   std::span<const Ray<Real>> rays, std::span<const io::ViewHit<Real>> hits)
    : camera_(camera) {
  if (rays.empty() && hits.empty()) return;
  const Box box = box_of(meshes);
  const double size = box.diagonal(), least_depth = size / 1024;
  std::map<std::uint32_t, double> first_hit;
  for (const auto& [numbers, names] : hits) {
    const auto [ray, geometry, triangle] = names;
    if (triangle == kNone) continue;
    const MeshView<Real>& mesh = meshes[geometry];
    const Triangle& t = mesh.triangles[triangle];
    const auto corner = [&](int k) { return convert<double>(mesh.vertices[t[k]]); };
    const Vec p = static_cast<double>(numbers[3]) * corner(0) +
                  static_cast<double>(numbers[1]) * corner(1) +
                  static_cast<double>(numbers[2]) * corner(2);
    const Spot spot = project(p);
    if (spot.depth > least_depth) balls_.push_back(spot);
    const auto [known, is_new] = first_hit.try_emplace(ray, numbers[0]);
    if (!is_new) known->second = std::min(known->second, static_cast<double>(numbers[0]));
  }
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec o = convert<double>(rays[i].origin), d = convert<double>(rays[i].direction);
    const double length = std::hypot(d.x, d.y, d.z);
    const Vec off = box.centre() - o;
    const double past = dot(off, d) / (length * length) + 0.75 * size / length;
    const double from = std::max<double>(rays[i].t_min, past - 2.5 * size / length);
    const auto hit = first_hit.find(static_cast<std::uint32_t>(i));
    const bool meets = hit != first_hit.end();
    const double to =
        meets ? hit->second
              : std::min<double>(rays[i].t_max, std::max(past, from + 0.25 * size / length));
    add_line(o + std::min(from, to) * d, o + to * d, meets ? kHitRay : kMissRay, least_depth);
  }
}

template <class Real>
typename Marks<Real>::Spot Marks<Real>::project(const Vec& p) const {
  const Vec r = p - camera_.eye;
  const double depth = dot(r, camera_.forward), scale = camera_.parallel ? 1 : depth;
  const double s = dot(r, camera_.right) / (dot(camera_.right, camera_.right) * scale);
  const double t = dot(r, camera_.up) / (dot(camera_.up, camera_.up) * scale);
  return {0.5 * (1 + s) * camera_.size.width, 0.5 * (1 - t) * camera_.size.height, depth};
}

// Of the line what lies before the camera.
template <class Real>
void Marks<Real>::add_line(Vec from, Vec to, const Color& color, double least_depth) {
  const double near = dot(from - camera_.eye, camera_.forward) - least_depth;
  const double far = dot(to - camera_.eye, camera_.forward) - least_depth;
  if (!(near > 0 || far > 0)) return;
  const Vec at_plane = near == far ? from : from + near / (near - far) * (to - from);
  if (near < 0) from = at_plane;
  if (far < 0) to = at_plane;
  const Line line{project(from), project(to), color};
  const double sum = line.from.x + line.from.y + line.to.x + line.to.y;
  if (std::isfinite(sum)) lines_.push_back(line);
}

template <class Real>
void Marks<Real>::draw(unsigned first, unsigned end, const SamplePlaces& places,
                       std::span<Sample> samples) const {
  for (const Line& line : lines_) draw_line(line, first, end, places, samples);
  for (const Spot& ball : balls_) draw_ball(ball, first, end, places, samples);
}

template <class Real>
void Marks<Real>::draw_line(const Line& line, unsigned first, unsigned end,
                            const SamplePlaces& places, std::span<Sample> samples) const {
  const double dx = line.to.x - line.from.x, dy = line.to.y - line.from.y;
  const double length = std::hypot(dx, dy);
  if (length == 0) return;
  const auto [top, bottom] = std::minmax(line.from.y, line.to.y);
  const Columns rows = columns_between(top - kHalfWidth, bottom + kHalfWidth, end);
  for (unsigned y = std::max(first, rows.first); y < rows.end; ++y) {
    // Which part of the line comes near this row, and so which columns.
    double u0 = 0, u1 = 1;
    if (std::fabs(dy) > 1) {
      const double a = (y - kHalfWidth - 1 - line.from.y) / dy;
      const double b = (y + kHalfWidth + 2 - line.from.y) / dy;
      u0 = std::clamp(std::min(a, b), 0.0, 1.0);
      u1 = std::clamp(std::max(a, b), 0.0, 1.0);
    }
    const double x0 = line.from.x + u0 * dx, x1 = line.from.x + u1 * dx;
    const Columns columns = columns_between(std::min(x0, x1) - kHalfWidth,
                                            std::max(x0, x1) + kHalfWidth + 1, places.width);
    for (unsigned x = columns.first; x < columns.end; ++x) {
      for (unsigned s = 0; s < places.samples; ++s) {
        const Point2 at = places.at(x, y, s);
        const double px = at.x - line.from.x, py = at.y - line.from.y;
        const double u = std::clamp((px * dx + py * dy) / (length * length), 0.0, 1.0);
        if (std::hypot(px - u * dx, py - u * dy) > kHalfWidth) continue;
        const double depth = camera_.parallel
                                 ? line.from.depth + u * (line.to.depth - line.from.depth)
                                 : 1 / ((1 - u) / line.from.depth + u / line.to.depth);
        Sample& sample = samples[(std::size_t{y - first} * places.width + x) * places.samples + s];
        if (depth <= sample.depth) sample = {line.color, 1, depth};
      }
    }
  }
}

template <class Real>
void Marks<Real>::draw_ball(const Spot& ball, unsigned first, unsigned end,
                            const SamplePlaces& places, std::span<Sample> samples) const {
  const Columns rows = columns_between(ball.y - kRadius, ball.y + kRadius + 1, end);
  const Columns columns = columns_between(ball.x - kRadius, ball.x + kRadius + 1, places.width);
  for (unsigned y = std::max(first, rows.first); y < rows.end; ++y) {
    for (unsigned x = columns.first; x < columns.end; ++x) {
      for (unsigned s = 0; s < places.samples; ++s) {
        const Point2 at = places.at(x, y, s);
        const double off = std::hypot(at.x - ball.x, at.y - ball.y) / kRadius;
        if (off > 1) continue;
        const double rise = std::sqrt(1 - off * off);
        const double depth = ball.depth - kRadius * camera_.pixel_at(ball.depth) * rise;
        Sample& sample = samples[(std::size_t{y - first} * places.width + x) * places.samples + s];
        if (depth <= sample.depth)
          sample = {static_cast<float>(0.55 + 0.45 * rise) * kBall, 1, depth};
      }
    }
  }
}

template class Marks<float>;
template class Marks<double>;

}  // namespace pierce::tool
