// SPDX-License-Identifier: Apache-2.0
//
// Where points lie: on the surface, or inside or outside by the passages of a ray along an axis.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/points/axis_points.h"
#include "scene/points/point_source.h"
#include "scene/points/sorted_points.h"
#include "scene/points/winder.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

// The resolver of a packet of points.
template <class Real>
class PointResolver final : public kernels::AxisResolver {
 public:
  PointResolver(const scene::Geometries<Real>& geometries, scene::StopPoll stop,
                predicate::LadderCounts& counts)
      : geometries_(geometries), stop_(stop), counts_(counts) {}

  void start(scene::AxisDirection along) {
    along_ = along;
    on_surface_ = 0;
  }

  int passage(std::uint32_t point, const kernels::Candidate& candidate) override {
    stop_.sometimes();
    if (on_surface(point)) return 0;  // nothing more to find out
    const predicate::AxisPassage passage = predicate::decide_axis_passage(
        points[point], along_, geometries_.triangle(candidate), counts_);
    if (passage != predicate::AxisPassage::OnTriangle) return static_cast<int>(passage);
    on_surface_ |= 1U << point;
    return 0;
  }

  [[nodiscard]] bool on_surface(std::uint32_t point) const {
    return ((on_surface_ >> point) & 1U) != 0;
  }

  std::array<Vec3<double>, kernels::kAxisPoints> points;

 private:
  const scene::Geometries<Real>& geometries_;
  scene::StopPoll stop_;
  predicate::LadderCounts& counts_;
  scene::AxisDirection along_;
  std::uint32_t on_surface_ = 0;
};

Location location_of(std::int32_t winding, InsideRule rule) {
  const bool inside = rule == InsideRule::NonZero ? winding != 0 : winding % 2 != 0;
  return inside ? Location::Inside : Location::Outside;
}

// A thread's way through packets of points.
template <class Real, class Counts>
class Locator {
 public:
  template <class Impl>
  Locator(const Impl& impl, const scene::AxisSpace& space, const LocateOptions& options,
          Counts& counts)
      : tree_(impl.tree),
        traverse_(impl.kernel->axis),
        space_(space),
        rule_(options.rule),
        counts_(counts),
        resolver_(impl.geometries, scene::StopPoll(options.work.stop), counts.ladder) {}

  /// Takes points one by one; all of a packet look the same way.
  void add(const Vec3<double>& point, scene::AxisDirection along, Location& location) {
    if (size_ == kernels::kAxisPoints || (size_ != 0 && !same(along, along_))) flush();
    along_ = along;
    resolver_.points[size_] = point;
    out_[size_++] = &location;
  }

  void flush() {
    if (size_ == 0) return;
    resolver_.start(along_);
    space_.fill(std::span(resolver_.points).first(size_), along_, packet_);
    traverse_(tree_, packet_, resolver_, counts_.kernel_counts());
    for (std::uint32_t i = 0; i < size_; ++i) {
      *out_[i] =
          resolver_.on_surface(i) ? Location::OnSurface : location_of(packet_.winding[i], rule_);
    }
    size_ = 0;
  }

 private:
  static bool same(scene::AxisDirection a, scene::AxisDirection b) {
    return a.axis == b.axis && a.forward == b.forward;
  }

  const bvh::Tree& tree_;
  kernels::AxisTraversal traverse_;
  const scene::AxisSpace& space_;
  InsideRule rule_;
  Counts& counts_;
  PointResolver<Real> resolver_;
  kernels::AxisPacket packet_;
  scene::AxisDirection along_;
  std::array<Location*, kernels::kAxisPoints> out_;
  std::uint32_t size_ = 0;
};

scene::Look look_of(const LocateOptions& options) {
  return options.open_mesh ? scene::Look::Up : scene::Look::NearestExit;
}

}  // namespace

template <class Real>
Location Scene<Real>::Impl::locate_by_ray(const Vec3<Real>& point, const LocateOptions& options,
                                          scene::PassageCounter<Real>& counter,
                                          Counts& counts) const {
  const scene::Extent& box = geometries.extent();
  const Vec3<double> p = predicate::to_double(point);
  // Along the axis that leaves the scene soonest.
  const double exits[6] = {box.upper.x - p.x, p.x - box.lower.x, box.upper.y - p.y,
                           p.y - box.lower.y, box.upper.z - p.z, p.z - box.lower.z};
  const auto* const way = look_of(options) == scene::Look::Up
                              ? &exits[4]
                              : std::min_element(std::begin(exits), std::end(exits));
  const auto number = static_cast<std::size_t>(way - exits);
  Real direction[3] = {0, 0, 0};
  direction[number / 2] = number % 2 == 0 ? Real(1) : Real(-1);
  const Ray<Real> ray{point, {direction[0], direction[1], direction[2]}};
  const Crossings found = crossings(ray, scene::Sight{}, counter, counts);
  if (found.origin_on_surface) return Location::OnSurface;
  return location_of(options.rule == InsideRule::NonZero ? found.signed_count
                                                         : static_cast<std::int32_t>(found.count),
                     options.rule);
}

template <class Real>
const typename Scene<Real>::Impl& Scene<Real>::Impl::asked(const LocateOptions& options) const {
  const WorkOptions quiet{.threads = options.work.threads, .stop = options.work.stop};
  if (options.rule == InsideRule::Winding) require_flat("the rule Winding");
  if (options.rule == InsideRule::Unique) {
    LazyUnique& once = *unique;
    const auto make = [&] {
      once.parts = scene::leave_out_repeats(geometries, quiet);
      if (once.parts.views.empty()) return;
      once.scene = build(once.parts.views, {}, {.quality = quality, .work = quiet});
      once.scene->surface = std::make_unique<scene::LazySurface>(
          scene::Surface{.odd = once.parts.fault, .unbalanced = {}});
    };
    once.made.call(make, [&] { scene::StopPoll(options.work.stop).now(); });
    if (once.scene) {
      if (!options.open_mesh && once.parts.fault) throw Error(*once.parts.fault);
      return *once.scene;
    }
  }
  if (!options.open_mesh && options.rule != InsideRule::Winding) {
    scene::validate_closed(surface->of(geometries, options.work), options.rule);
  }
  return *this;
}

template <class Real>
void Scene<Real>::Impl::require_flat(const char* what) const {
  if (!geometries.shares_meshes()) return;
  throw Error(ErrorCode::InvalidArgument,
              std::string("instances that share their meshes' trees are not for ") + what +
                  "; build the scene with a larger flatten_limit");
}

template <class Real>
scene::AxisSpace Scene<Real>::Impl::axis_space() const {
  return {geometries.space(), tree, geometries.copies_exact(),
          surface->repeats(tree, geometries.size())};
}

template <class Real>
Location Scene<Real>::locate(const Vec3<Real>& point, const LocateOptions& options) const {
  const FloatEnvironment environment;
  scene::validate_point(point);
  const Impl& impl = impl_->asked(options);
  if (impl.geometries.shares_meshes()) {
    scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
    auto counts = sum.start();
    scene::PassageCounter<Real> counter(impl.geometries, {}, counts.ladder);
    const Location location = impl.locate_by_ray(point, options, counter, counts);
    sum.add(counts);
    return location;
  }
  const scene::AxisSpace space = impl.axis_space();
  const Vec3<double> p = predicate::to_double(point);
  if (options.rule == InsideRule::Winding) {
    Location location = Location::Outside;
    scene::ask_winding(impl, space, point, options.work,
                       [&location](std::size_t, const auto& winder, const auto& asked) {
                         location = winder.location(asked);
                       });
    return location;
  }
  Location location = Location::Outside;
  scene::AxisDirection along;
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  auto counts = sum.start();
  ++counts.rays;
  if (space.direction(p, look_of(options), along)) {
    Locator<Real, typename Impl::Counts> locator(impl, space, options, counts);
    locator.add(p, along, location);
    locator.flush();
  }
  sum.add(counts);
  return location;
}

template <class Real>
void Scene<Real>::locate(const Rows<const Real>& rows, const Rows<std::int8_t>& locations,
                         const LocateOptions& options) const {
  const FloatEnvironment environment;
  const scene::PointSource<Real> points(rows);
  scene::validate_outputs("point", points.size(), locations.count);
  const scene::OutputRows<std::int8_t> results(locations, points.size(), "point", "locations");
  scene::validate_points(points, options.work.stop);
  const Impl& impl = impl_->asked(options);
  if (impl.geometries.shares_meshes()) {
    scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
    scene::for_chunks(points.size(), options.work, 256, [&](std::size_t begin, std::size_t end) {
      auto counts = sum.start();
      scene::PassageCounter<Real> counter(impl.geometries, scene::StopPoll(options.work.stop),
                                          counts.ladder);
      for (std::size_t i = begin; i < end; ++i) {
        results.set(
            i, static_cast<std::int8_t>(impl.locate_by_ray(points[i], options, counter, counts)));
      }
      sum.add(counts);
    });
    return;
  }
  scene::AxisSpace space = impl.axis_space();
  if (options.rule == InsideRule::Winding) {
    scene::ask_windings(impl, space, points, options.work,
                        [&results](std::size_t i, const auto& winder, const auto& asked) {
                          results.set(i, static_cast<std::int8_t>(winder.location(asked)));
                        });
    return;
  }
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  std::vector<Location> block;  // where results do not lie as an array of Location does
  Location* out = nullptr;      // those of the block
  const auto start = [&](std::size_t first, std::size_t size) {
    out = reinterpret_cast<Location*>(results.in_place(first));
    if (out != nullptr) return;
    block.resize(size);
    out = block.data();
  };
  const auto answer = [&](std::size_t first, std::span<const std::uint64_t> entries) {
    auto counts = sum.start();
    counts.rays += entries.size();
    scene::StopPoll stop(options.work.stop);
    Locator<Real, typename Impl::Counts> locator(impl, space, options, counts);
    for (const std::uint64_t entry : entries) {
      const scene::SortedPoint at(entry);
      stop.sometimes();
      out[at.number] = Location::Outside;
      if (!at.looks) continue;
      locator.add(predicate::to_double(points[first + at.number]), at.along, out[at.number]);
    }
    locator.flush();
    sum.add(counts);
  };
  const auto finish = [&](std::size_t first, std::size_t size) {
    if (out != block.data() || size == 0) return;
    results.write(first, std::span<const Location>(block).first(size),
                  [](Location location) { return static_cast<std::int8_t>(location); });
  };
  scene::for_sorted_points(points, space, look_of(options), options.work, start, answer, finish);
}

template <class Real>
void Scene<Real>::locate(std::span<const Vec3<Real>> points, std::span<Location> locations,
                         const LocateOptions& options) const {
  auto* const out = reinterpret_cast<std::int8_t*>(locations.data());
  locate(rows(points), Rows<std::int8_t>{out, locations.size()}, options);
}

template Location Scene<float>::locate(const Vec3<float>&, const LocateOptions&) const;
template Location Scene<double>::locate(const Vec3<double>&, const LocateOptions&) const;
template void Scene<float>::locate(const Rows<const float>&, const Rows<std::int8_t>&,
                                   const LocateOptions&) const;
template void Scene<float>::locate(std::span<const Vec3<float>>, std::span<Location>,
                                   const LocateOptions&) const;
template void Scene<double>::locate(const Rows<const double>&, const Rows<std::int8_t>&,
                                    const LocateOptions&) const;
template void Scene<double>::locate(std::span<const Vec3<double>>, std::span<Location>,
                                    const LocateOptions&) const;
template Location Scene<float>::Impl::locate_by_ray(const Vec3<float>&, const LocateOptions&,
                                                    scene::PassageCounter<float>&, Counts&) const;
template Location Scene<double>::Impl::locate_by_ray(const Vec3<double>&, const LocateOptions&,
                                                     scene::PassageCounter<double>&, Counts&) const;
template const Scene<float>::Impl& Scene<float>::Impl::asked(const LocateOptions&) const;
template const Scene<double>::Impl& Scene<double>::Impl::asked(const LocateOptions&) const;
template void Scene<float>::Impl::require_flat(const char*) const;
template void Scene<double>::Impl::require_flat(const char*) const;
template scene::AxisSpace Scene<float>::Impl::axis_space() const;
template scene::AxisSpace Scene<double>::Impl::axis_space() const;

}  // namespace pierce
