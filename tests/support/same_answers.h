// SPDX-License-Identifier: Apache-2.0
//
// Two scenes that should be the same to whoever asks: every query, single and batch, compared to
// the bit, errors included.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pierce/error.h"
#include "pierce/scene.h"
#include "pierce/voxelise.h"
#include "support/show.h"

namespace pierce::oracle {

/// What `ask` answers, or the text of the Error that it throws.
template <class Ask>
std::string answer_or_error(const Ask& ask) {
  try {
    return ask();
  } catch (const Error& error) {
    return error.what();
  }
}

template <class Real>
std::string text(const NearestPoint<Real>& n) {
  return show::joined(show::text(n.point), ' ', show::text(n.distance), ' ', show::text(n.u), ' ',
                      show::text(n.v), ' ', show::text(n.w), ' ', n.geometry, ':', n.triangle,
                      " feature ", static_cast<int>(n.feature));
}

inline std::string text(const Crossings& c) {
  return show::joined(c.count, ' ', c.signed_count, ' ', c.origin_on_surface);
}

/// All that the scene says about one ray.
template <class Real>
std::string answers(const Scene<Real>& scene, const Ray<Real>& ray) {
  std::string all = show::text(scene.closest_hit(ray).value_or(Hit<Real>{}));
  all += scene.any_hit(ray) ? " any" : " none";
  std::vector<Hit<Real>> hits;
  scene.all_hits(ray, hits);
  for (const Hit<Real>& hit : hits) all += show::joined("\n  ", show::text(hit));
  // Of the first hit only: exact arithmetic of any size takes its time.
  for (const Side side : {Side::Before, Side::Beyond}) {
    if (hits.empty()) break;
    const auto next = scene.next_origin(ray, hits[0], side);
    all += next ? show::text(*next) : std::string(" nowhere");
  }
  return show::joined(all, '\n', text(scene.crossings(ray)));
}

/// All that the scene says about one point.
template <class Real>
std::string answers(const Scene<Real>& scene, const Vec3<Real>& p) {
  std::string all;
  for (const bool open_mesh : {false, true}) {
    LocateOptions options;
    options.open_mesh = open_mesh;
    options.work.threads = 1;
    all += answer_or_error([&] {
      return show::joined(static_cast<int>(scene.locate(p, options)), " at ",
                          show::text(scene.signed_distance(p, options)));
    });
    options.rule = InsideRule::NonZero;
    all += answer_or_error(
        [&] { return show::joined(' ', static_cast<int>(scene.locate(p, options)), '\n'); });
  }
  return all + text(scene.nearest_point(p).value_or(NearestPoint<Real>{}));
}

/// What is near to one point, and what lies between it and another.
template <class Real>
std::string answers(const Scene<Real>& scene, const Vec3<Real>& p, const Vec3<Real>& q) {
  std::string all;
  std::vector<NearestPoint<Real>> nearest;
  const Real distance = scene.nearest_point(p).value_or(NearestPoint<Real>{}).distance;
  for (const Real radius : {distance, kInfinity<Real>}) {
    scene.nearest_triangles(p, 8, nearest, radius);
    for (const auto& n : nearest) all += show::joined(text(n), '\n');
  }
  std::vector<TriangleRef> touched;
  const auto add = [&] {
    for (const TriangleRef& t : touched) all += show::joined(t.geometry, ':', t.triangle, ' ');
    all += '\n';
  };
  scene.touching_segment(p, q, touched);
  add();
  scene.touching_box({std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                     {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}, touched);
  add();
  return all;
}

/// All batches, as text.
template <class Real>
std::string answers(const Scene<Real>& scene, const std::vector<Ray<Real>>& rays,
                    const std::vector<Vec3<Real>>& points) {
  std::string all;
  std::vector<Hit<Real>> hits(rays.size());
  scene.closest_hits(rays, hits);
  for (const auto& hit : hits) all += show::joined(show::text(hit), '\n');
  std::vector<std::uint8_t> any(rays.size());
  scene.any_hits(rays, any);
  for (const auto hit : any) all += hit != 0 ? '1' : '0';
  const HitLists<Real> lists = scene.all_hits(rays);
  for (const auto& hit : lists.hits) all += show::joined(show::text(hit), '\n');
  std::vector<Crossings> crossings(rays.size());
  scene.crossings(rays, crossings);
  for (const auto& c : crossings) all += show::joined(text(c), '\n');
  std::vector<Location> locations(points.size());
  LocateOptions open;
  open.open_mesh = true;
  scene.locate(points, locations, open);
  for (const auto l : locations) all += show::joined(static_cast<int>(l), ' ');
  std::vector<NearestPoint<Real>> nearest(points.size());
  scene.nearest_points(points, nearest);
  for (const auto& n : nearest) all += show::joined(text(n), '\n');
  return all;
}

/// Where the two differ in what they answer about these rays and points.
template <class Real>
void expect_same_answers(const Scene<Real>& found, const Scene<Real>& expected,
                         const std::vector<Ray<Real>>& rays,
                         const std::vector<Vec3<Real>>& points) {
  EXPECT_EQ(found.info().triangles, expected.info().triangles);
  EXPECT_EQ(found.info().vertices, expected.info().vertices);
  EXPECT_EQ(found.info().degenerate, expected.info().degenerate);
  for (const Ray<Real>& ray : rays) {
    ASSERT_EQ(answers(found, ray), answers(expected, ray)) << show::text(ray);
  }
  for (const Vec3<Real>& p : points) {
    ASSERT_EQ(answers(found, p), answers(expected, p)) << show::text(p);
    ASSERT_EQ(answers(found, p, points[0]), answers(expected, p, points[0])) << show::text(p);
  }
  ASSERT_EQ(answers(found, rays, points), answers(expected, rays, points));
}

}  // namespace pierce::oracle
