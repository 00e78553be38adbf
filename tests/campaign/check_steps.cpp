// SPDX-License-Identifier: Apache-2.0
//
// Hits gone through one by one (after, distinct, filter), rays that are not valid, hit points and
// normals: of some rays of each case, alone and in batches. What is asked of a ray depends on the
// case alone, so that a case that was saved asks it again.
#include <limits>
#include <optional>
#include <utility>

#include "campaign/check.h"
#include "campaign/rng.h"
#include "campaign/step_oracle.h"

namespace pierce::campaign {
namespace {

constexpr std::size_t kRays = 24, kSteps = 30, kTriangles = 60;

template <class Real>
Real nan_of() {
  return std::numeric_limits<Real>::quiet_NaN();
}
template <class Real>
Vec3<Real> nowhere() {
  return {nan_of<Real>(), nan_of<Real>(), nan_of<Real>()};
}

/// A ray that is not valid, made of one that is.
template <class Real>
Ray<Real> broken(Rng& rng, Ray<Real> ray) {
  const Real bad = rng.pick({nan_of<Real>(), kInfinity<Real>, -kInfinity<Real>});
  switch (rng.below(5)) {
    case 0:
      ray.origin.y = bad;
      break;
    case 1:
      ray.direction.x = bad;
      break;
    case 2:
      ray.direction = {Real(-0.0), 0, 0};
      break;
    case 3:
      ray.t_min = nan_of<Real>();
      break;
    default:
      ray.t_max = nan_of<Real>();
  }
  return ray;
}

/// One ray of the batch, and what is true of it.
template <class Real>
struct Asked {
  Ray<Real> ray;
  bool valid;
  std::vector<ExactHit> line;
  Question question;
  TriangleRef after;

  [[nodiscard]] std::vector<Hit<Real>> hits(const Steps& steps, std::uint64_t most) const {
    std::vector<Hit<Real>> all;
    if (!valid) return all;
    for (const auto& hit : stepped(line, question, steps, most).hits) {
      all.push_back(rounded_hit<Real>(hit));
    }
    return all;
  }
};

template <class Real>
Hit<Real> first_of(const std::vector<Hit<Real>>& hits) {
  return hits.empty() ? Hit<Real>{} : hits[0];
}

template <class Real>
struct Walk {
  const Case<Real>& made;
  const Built<Real>& built;
  Tally& tally;
  std::vector<Asked<Real>> rays;
  bool goes_on, distinct;  // whether the rays go on after hits
  std::optional<Whim> filter;
  InvalidRays invalid;

  [[nodiscard]] auto where(const char* how, std::size_t i) const {
    return [this, how, i] {
      return std::string(how) + ", " + built.name + ", chosen ray " + std::to_string(i);
    };
  }
  [[nodiscard]] Steps steps(std::size_t i, std::uint64_t number) const {
    return {rays[i].after, distinct, filter ? &*filter : nullptr, number};
  }
  [[nodiscard]] QueryOptions options(std::size_t i) const {
    const Question& q = rays[i].question;
    return {.range = q.range,
            .skip = q.skip,
            .sides = q.sides,
            .mask = q.mask,
            .max_hits = made.max_hits,
            .after = rays[i].after,
            .distinct = distinct,
            .invalid = invalid};
  }

  /// Asks with the filter, if there is one, and compares what it was told.
  template <class Ask>
  void heard(const char* query, std::size_t i, std::uint64_t most, const Ask& ask) const {
    QueryOptions o = options(i);
    std::vector<Hit<Real>> told, wanted;
    if (filter) {
      o.filter = [&](std::uint64_t ray, const Hit<double>& hit) {
        told.push_back({Real(hit.t), Real(hit.u), Real(hit.v), Real(hit.w), hit.geometry,
                        hit.triangle, hit.facing});
        return filter->accepts(ray, hit);
      };
    }
    ask(o);
    if (!filter) return;
    if (rays[i].valid) {
      for (const auto& hit : stepped(rays[i].line, rays[i].question, steps(i, 0), most).asked) {
        wanted.push_back(rounded_hit<Real>(hit));
      }
    }
    tally.compare(std::string("filter of ") + query, wanted, told, where("single", i));
  }

  void single(std::size_t i) const {
    const auto& scene = built.scene;
    const auto& ray = rays[i].ray;
    const auto wanted = rays[i].hits(steps(i, 0), kUnlimited);
    const auto at = where("single", i);
    heard("closest_hit", i, 1, [&](const QueryOptions& o) {
      const auto got = scene.closest_hit(ray, o).value_or(Hit<Real>{});
      tally.compare("closest_hit in steps", first_of(wanted), got, at);
    });
    heard("any_hit", i, 1, [&](const QueryOptions& o) {
      tally.compare("any_hit in steps", !wanted.empty(), scene.any_hit(ray, o), at);
    });
    heard("all_hits", i, made.max_hits, [&](const QueryOptions& o) {
      std::vector<Hit<Real>> all(2);
      scene.all_hits(ray, all, o);
      tally.compare("all_hits in steps", rays[i].hits(steps(i, 0), made.max_hits), all, at);
    });
    heard("count_hits", i, kUnlimited, [&](const QueryOptions& o) {
      tally.compare("count_hits in steps", std::uint64_t{wanted.size()},
                    std::uint64_t{scene.count_hits(ray, o)}, at);
    });
    if (!rays[i].valid) {
      tally.compare("crossings of a bad ray", Crossings{},
                    scene.crossings(ray, {.invalid = InvalidRays::Miss}), at);
    }
  }

  /// From hit to hit by `after`: all of them, in order.
  void step(std::size_t i) const {
    if (!rays[i].valid) return;
    QueryOptions o = options(i);
    std::vector<Hit<Real>> got;
    while (got.size() < kSteps) {
      const auto hit = built.scene.closest_hit(rays[i].ray, o);
      if (!hit) break;
      got.push_back(*hit);
      o.after = *hit;
    }
    Steps plain = steps(i, 0);
    plain.filter = nullptr;
    tally.compare("stepping by after", rays[i].hits(plain, kSteps), got, where("stepping", i));
  }

  void batch(unsigned threads) const {
    std::vector<Ray<Real>> all_rays;
    std::vector<TriangleRef> after, skip;
    std::vector<std::uint32_t> masks;
    for (const auto& asked : rays) {
      all_rays.push_back(asked.ray);
      skip.push_back(asked.question.skip);
      masks.push_back(asked.question.mask);
      if (goes_on) after.push_back(asked.after);
    }
    BatchOptions o{.range = made.range,
                   .skip = skip,
                   .sides = made.sides,
                   .masks = masks,
                   .max_hits = made.max_hits,
                   .after = after,
                   .distinct = distinct,
                   .invalid = invalid,
                   .work = {.threads = threads}};
    if (filter) {
      o.filter = [this](std::uint64_t ray, const Hit<double>& hit) {
        return filter->accepts(ray, hit);
      };
    }
    const std::size_t count = rays.size();
    const auto& scene = built.scene;
    std::vector<Hit<Real>> closest(count), columns(count);
    std::vector<std::uint8_t> any(count, 7);
    std::vector<std::uint32_t> counts(count);
    std::vector<Vec3<Real>> points(count), normals(count), units(count);
    scene.closest_hits(all_rays, closest, o);
    scene.any_hits(all_rays, any, o);
    scene.count_hits(all_rays, counts, o);
    const auto lists = scene.all_hits(all_rays, o);
    scene.closest_hits(RayArrays<Real>::of(all_rays),
                       {.hits = columns,
                        .point = pierce::rows(points),
                        .normal = pierce::rows(normals),
                        .unit_normal = pierce::rows(units)},
                       o);
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = where(threads == 1 ? "1 thread" : "2 threads", i);
      const auto wanted = rays[i].hits(steps(i, i), kUnlimited);
      tally.compare("closest_hits in steps", first_of(wanted), closest[i], at);
      tally.compare("closest_hits in columns", first_of(wanted), columns[i], at);
      tally.compare("any_hits in steps", !wanted.empty(), any[i] != 0, at);
      tally.compare("count_hits of a batch in steps", std::uint64_t{wanted.size()},
                    std::uint64_t{counts[i]}, at);
      const auto list = lists.of(i);
      tally.compare("all_hits of a batch in steps", rays[i].hits(steps(i, i), made.max_hits),
                    std::vector<Hit<Real>>(list.begin(), list.end()), at);
      compare_places(i, first_of(wanted), points[i], normals[i], units[i], at);
    }
    if (invalid == InvalidRays::Miss) crossings(all_rays, threads);
  }

  /// Bad rays cross nothing, and have no next origin; those among them are as without.
  void crossings(const std::vector<Ray<Real>>& all_rays, unsigned threads) const {
    std::vector<Crossings> got(all_rays.size(), {7, 7, true});
    built.scene.crossings(all_rays, got, {.invalid = invalid, .work = {.threads = threads}});
    for (std::size_t i = 0; i < all_rays.size(); ++i) {
      const auto wanted = rays[i].valid ? built.scene.crossings(all_rays[i]) : Crossings{};
      tally.compare("crossings among bad rays", wanted, got[i], where("batch", i));
    }
  }

  template <class Where>
  void compare_places(std::size_t i, const Hit<Real>& hit, const Vec3<Real>& point,
                      const Vec3<Real>& normal, const Vec3<Real>& unit, const Where& at) const {
    if (hit.triangle == kNone) {
      const auto is_nan = [](const Vec3<Real>& p) {
        return p.x != p.x && p.y != p.y && p.z != p.z;
      };
      const bool all = is_nan(point) && is_nan(normal) && is_nan(unit);
      tally.compare("columns of a miss", true, all, at);
      return;
    }
    const auto exact = std::find_if(rays[i].line.begin(), rays[i].line.end(),
                                    [&](const ExactHit& h) { return h.ref == TriangleRef(hit); });
    const Triangle& t = made.meshes[hit.geometry].triangles[hit.triangle];
    const auto& v = made.meshes[hit.geometry].vertices;
    const Normals<Real> normals({as_point(v[t[0]]), as_point(v[t[1]]), as_point(v[t[2]])});
    tally.compare("column of points", rounded_point<Real>(rays[i].question, exact->t), point, at);
    tally.compare("column of normals", normals.normal, normal, at);
    tally.compare("column of unit normals", normals.unit, unit, at);
  }

  /// Of every hit of the ray's whole line, in its range or not.
  void places() const {
    std::vector<Ray<Real>> all_rays;
    std::vector<Hit<Real>> hits;
    std::vector<Vec3<Real>> wanted;
    const auto at = [&](std::size_t i) { return where("hit", i); };
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!rays[i].valid) continue;
      for (std::size_t k = 0; k < std::min(rays[i].line.size(), kSteps); ++k) {
        const ExactHit& hit = rays[i].line[k];
        all_rays.push_back(rays[i].ray);
        hits.push_back(rounded_hit<Real>(hit));
        wanted.push_back(rounded_point<Real>(rays[i].question, hit.t));
        const auto got = built.scene.hit_point(rays[i].ray, hit.ref);
        tally.compare("hit_point", wanted.back(), got, at(i));
      }
    }
    std::vector<Vec3<Real>> points(hits.size());
    built.scene.hit_points(all_rays, hits, points, {.threads = 2});
    for (std::size_t i = 0; i < hits.size(); ++i) {
      tally.compare("hit_points", wanted[i], points[i], at(i));
    }
  }
};

template <class Real>
Walk<Real> draw(Rng& rng, const Case<Real>& made, const Built<Real>& built, const World& world,
                Tally& tally) {
  Walk<Real> walk{made, built, tally, {}, rng.one_in(2), rng.one_in(2), {}, InvalidRays::Throw};
  if (rng.one_in(2)) walk.filter = Whim{rng.below(1 << 20), rng.pick({0u, 2u, 4u, 6u, 7u, 8u})};
  if (rng.one_in(2)) walk.invalid = InvalidRays::Miss;
  const std::size_t step = made.rays.size() / kRays + 1;
  for (std::size_t i = rng.below(step); i < made.rays.size(); i += step) {
    const bool valid = walk.invalid == InvalidRays::Throw || !rng.one_in(4);
    Asked<Real> asked{valid ? made.rays[i] : broken(rng, made.rays[i]), valid, {}, {}, {}};
    const auto& ray = made.rays[i];
    asked.question = {as_point(ray.origin), as_point(ray.direction),
                      double{ray.t_min},    double{ray.t_max},
                      made.range,           made.skip.empty() ? TriangleRef{} : made.skip[i],
                      made.sides,           made.ray_masks.empty() ? made.mask : made.ray_masks[i],
                      made.geometry_masks};
    const Question& q = asked.question;
    asked.line = line_hits(candidates(world, q.origin, q.direction), q.origin, q.direction);
    if (walk.goes_on && !asked.line.empty() && !rng.one_in(4)) {
      asked.after = rng.pick(asked.line).ref;
    }
    walk.rays.push_back(std::move(asked));
  }
  return walk;
}

template <class Real>
void check_normals(Rng& rng, const Built<Real>& built, const World& world, Tally& tally) {
  std::vector<TriangleRef> refs;
  std::vector<Vec3<Real>> normals, units;
  const auto at = [&] { return built.name; };
  const std::size_t step = world.size() / kTriangles + 1;
  for (std::size_t i = rng.below(step); i < world.size(); i += step) {
    const Normals<Real> wanted(world[i].corners);
    refs.push_back(world[i].ref);
    normals.push_back(wanted.normal);
    units.push_back(wanted.unit);
    tally.compare("normal", wanted.normal, built.scene.normal(world[i].ref), at);
    tally.compare("unit_normal", wanted.unit, built.scene.unit_normal(world[i].ref), at);
  }
  std::vector<Vec3<Real>> got(refs.size(), nowhere<Real>());
  built.scene.normals(refs, got, {.threads = 2});
  for (std::size_t i = 0; i < refs.size(); ++i) tally.compare("normals", normals[i], got[i], at);
  built.scene.unit_normals(refs, got, {.threads = 2});
  for (std::size_t i = 0; i < refs.size(); ++i) tally.compare("unit_normals", units[i], got[i], at);
}

}  // namespace

template <class Real>
void check_steps(const Case<Real>& made, const Scenes<Real>& scenes, const World& world,
                 Tally& tally) {
  // The case alone says what is drawn, see above.
  Rng rng(made.rays.size() * 1000 + world.size() * 7 + made.max_hits);
  for (const auto& built : scenes) {
    const auto walk = draw(rng, made, built, world, tally);
    for (std::size_t i = 0; i < walk.rays.size(); ++i) {
      walk.single(i);
      walk.step(i);
    }
    walk.batch(1);
    walk.batch(2);
    walk.places();
    check_normals(rng, built, world, tally);
  }
}

template void check_steps(const Case<float>&, const Scenes<float>&, const World&, Tally&);
template void check_steps(const Case<double>&, const Scenes<double>&, const World&, Tally&);

}  // namespace pierce::campaign
