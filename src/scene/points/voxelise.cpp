// SPDX-License-Identifier: Apache-2.0
//
// Grids: the line through the centres of a column meets each triangle once; how many centres lie
// below that point is found by asking on which side of the triangle's plane they lie. Exact as
// locate is, since the questions are the same.
#include "pierce/voxelise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scene/scene_impl.h"
#include "support/finite.h"
#include "support/float_environment.h"
#include "support/for_chunks.h"

namespace pierce {
namespace {

constexpr std::uint32_t kMostCells = std::uint32_t{1} << 21;  // so that all of them fit in 63 bits
constexpr std::size_t kPacketsPerTask = 16;

// origin + (index + 1/2) spacing, rounded once: index + 1/2 is a Real.
template <class Real>
Real centre_of(Real origin, Real spacing, std::uint32_t index) {
  return std::fma(static_cast<Real>(index) + Real(0.5), spacing, origin);
}

template <class Real>
void validate_grid(const Grid<Real>& grid, std::uint32_t first, std::uint32_t layers,
                   std::size_t results) {
  const auto refuse = [](ErrorCode code, const std::string& what) { throw Error(code, what); };
  const Real origin[3] = {grid.origin.x, grid.origin.y, grid.origin.z};
  const Real spacing[3] = {grid.spacing.x, grid.spacing.y, grid.spacing.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (grid.size[axis] > kMostCells) {
      refuse(ErrorCode::InvalidArgument, "grid: " + std::to_string(grid.size[axis]) +
                                             " cells along " + name + ", at most " +
                                             std::to_string(kMostCells) + " will do");
    }
    if (!(spacing[axis] > 0) || !is_finite_number(spacing[axis])) {
      refuse(ErrorCode::InvalidArgument,
             "grid: the spacing along " + name + " must be finite and greater than 0");
    }
    const std::uint32_t last = std::max(grid.size[axis], 1U) - 1;
    if (!is_finite_number(origin[axis]) ||
        !is_finite_number(centre_of(origin[axis], spacing[axis], last))) {
      refuse(ErrorCode::InvalidArgument,
             "grid: its cells along " + name + " must all have finite coordinates");
    }
  }
  if (first > grid.size[0] || layers > grid.size[0] - first) {
    refuse(ErrorCode::InvalidArgument, "grid: layers " + std::to_string(first) + " to " +
                                           std::to_string(std::uint64_t{first} + layers) +
                                           " are not all there; it has " +
                                           std::to_string(grid.size[0]));
  }
  const std::uint64_t cells = std::uint64_t{layers} * grid.size[1] * grid.size[2];
  if (cells != results) {
    refuse(ErrorCode::SizeMismatch, "there are " + std::to_string(cells) + " cells but room for " +
                                        std::to_string(results) +
                                        " results; make room for one a cell");
  }
}

// The z of the centres of a column, and where a height falls among them.
class Heights {
 public:
  template <class Real>
  explicit Heights(const Grid<Real>& grid)
      : origin_(static_cast<double>(grid.origin.z)), spacing_(static_cast<double>(grid.spacing.z)) {
    z_.reserve(grid.size[2]);
    for (std::uint32_t k = 0; k < grid.size[2]; ++k) {
      z_.push_back(static_cast<double>(centre_of(grid.origin.z, grid.spacing.z, k)));
    }
  }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(z_.size()); }
  [[nodiscard]] double at(std::uint32_t k) const { return z_[k]; }

  /// The first centre above centre k: those between lie where it does.
  [[nodiscard]] std::uint32_t above(std::uint32_t k) const {
    if (k + 1 == size() || z_[k + 1] > z_[k]) return k + 1;
    return static_cast<std::uint32_t>(std::upper_bound(z_.begin() + k, z_.end(), z_[k]) -
                                      z_.begin());
  }

  /// How many centres are below z.
  [[nodiscard]] std::uint32_t below(double z) const {
    const double guess = std::clamp((z - origin_) / spacing_, 0.0, static_cast<double>(size()));
    std::uint32_t k = guess == guess ? static_cast<std::uint32_t>(guess) : 0;
    while (k > 0 && z_[k - 1] >= z) --k;
    while (k < size() && z_[k] < z) ++k;
    return k;
  }
  /// How many are below z or at it.
  [[nodiscard]] std::uint32_t up_to(double z) const {
    std::uint32_t k = below(z);
    while (k < size() && z_[k] == z) ++k;
    return k;
  }

 private:
  double origin_, spacing_;
  std::vector<double> z_;
};

// What the triangles above and below do to the cells of one column.
class Column {
 public:
  void start() {
    passages_.clear();
    on_surface_.clear();
  }
  /// The surface is passed with `count` centres below the passage.
  void pass(std::uint32_t count, int facing) { passages_.push_back({count, facing}); }
  /// Cells `begin` to `end` - 1 have centres on the surface.
  void touch(std::uint32_t begin, std::uint32_t end) { on_surface_.push_back({begin, end}); }

  void write(std::span<Location> cells, InsideRule rule) {
    std::sort(passages_.begin(), passages_.end(),
              [](const Passage& a, const Passage& b) { return a.below > b.below; });
    std::size_t end = cells.size();  // of the cells that have the winding number so far
    int winding = 0;
    const auto fill_from = [&](std::size_t begin) {
      const bool inside = rule == InsideRule::NonZero ? winding != 0 : winding % 2 != 0;
      std::fill(cells.begin() + static_cast<std::ptrdiff_t>(begin),
                cells.begin() + static_cast<std::ptrdiff_t>(end),
                inside ? Location::Inside : Location::Outside);
      end = begin;
    };
    for (const Passage& passage : passages_) {
      fill_from(passage.below);
      winding += passage.facing;
    }
    fill_from(0);
    for (const Touched& t : on_surface_) {
      std::fill(cells.begin() + t.begin, cells.begin() + t.end, Location::OnSurface);
    }
  }

 private:
  struct Passage {
    std::uint32_t below;
    int facing;
  };
  std::vector<Passage> passages_;
  struct Touched {
    std::uint32_t begin, end;
  };
  std::vector<Touched> on_surface_;
};

// A packet of columns and its resolver, which takes every triangle apart itself and leaves the
// traversal nothing to count.
template <class Real>
class Columns final : public kernels::AxisResolver {
 public:
  Columns(const scene::Geometries<Real>& geometries, const Heights& heights,
          predicate::LadderCounts& counts)
      : geometries_(geometries), heights_(heights), counts_(counts) {}

  kernels::AxisPacket packet;  ///< those columns that may meet a triangle

  /// The columns (i, j) to (i, j + count - 1).
  void start(const Grid<Real>& grid, std::uint32_t i, std::uint32_t j, std::uint32_t count,
             const scene::AxisSpace& space) {
    count_ = count;
    std::uint32_t met = 0;
    for (std::uint32_t c = 0; c < count; ++c) {
      columns_[c].start();
      Vec3<double> point = predicate::to_double(grid.centre(i, j + c, 0));
      point.z = 0;
      if (!space.line_meets(point)) continue;
      points_[met] = point;
      column_of_[met++] = c;
    }
    space.fill_lines(std::span(points_).first(met), packet);
  }

  /// The cells of all columns; returns how many columns there are.
  std::uint32_t write(std::span<Location> cells, InsideRule rule) {
    for (std::uint32_t c = 0; c < count_; ++c) {
      columns_[c].write(cells.subspan(std::size_t{c} * heights_.size(), heights_.size()), rule);
    }
    return count_;
  }

  int passage(std::uint32_t met, const kernels::Candidate& candidate) override {
    const predicate::TriangleD triangle = geometries_.triangle(candidate);
    Vec3<double> point = points_[met];
    Column& column = columns_[column_of_[met]];
    const auto shadow = predicate::decide_shadow(point, 2, triangle, counts_);
    if (!shadow.touched) return 0;
    const auto [lowest, highest] = std::minmax({triangle.a.z, triangle.b.z, triangle.c.z});
    std::uint32_t begin = heights_.below(lowest);
    std::uint32_t end = heights_.up_to(highest);
    if (shadow.facing == 0) {  // upright
      for (std::uint32_t k = begin; k < end; k = heights_.above(k)) {
        point.z = heights_.at(k);
        if (predicate::decide_on_triangle(point, triangle)) column.touch(k, heights_.above(k));
      }
      return 0;
    }
    // The sign of (z of the plane) - (z of centre k), which falls with k.
    const auto plane_above = [&](std::uint32_t k) {
      point.z = heights_.at(k);
      return shadow.facing * predicate::decide_side_of_plane(point, triangle, counts_);
    };
    while (begin < end) {
      const std::uint32_t middle = begin + (end - begin) / 2;
      const int sign = plane_above(middle);
      if (sign > 0) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    for (std::uint32_t k = begin; k < heights_.size() && heights_.at(k) <= highest;
         k = heights_.above(k)) {
      if (plane_above(k) != 0) break;
      column.touch(k, heights_.above(k));
    }
    if (shadow.passed) column.pass(begin, shadow.facing);
    return 0;
  }

 private:
  const scene::Geometries<Real>& geometries_;
  const Heights& heights_;
  predicate::LadderCounts& counts_;
  std::uint32_t count_ = 0;
  std::array<Vec3<double>, kernels::kAxisPoints> points_;
  std::array<std::uint32_t, kernels::kAxisPoints> column_of_{};
  std::array<Column, kernels::kAxisPoints> columns_;
};

// Cell by cell, by what locate says.
template <class Real>
void voxelise_points(const Scene<Real>& scene, const Grid<Real>& grid, std::uint32_t first,
                     std::span<Location> cells, const LocateOptions& options) {
  constexpr std::size_t kCellsAtOnce = std::size_t{1} << 20;
  const std::size_t layer = std::size_t{grid.size[1]} * grid.size[2];
  std::vector<Vec3<Real>> points;
  for (std::size_t begin = 0; begin < cells.size(); begin += points.size()) {
    points.resize(std::min(kCellsAtOnce, cells.size() - begin));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t cell = begin + i;
      points[i] = grid.centre(first + static_cast<std::uint32_t>(cell / layer),
                              static_cast<std::uint32_t>(cell % layer / grid.size[2]),
                              static_cast<std::uint32_t>(cell % grid.size[2]));
    }
    LocateOptions part = options;
    const auto of_all = [&cells](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(cells.size());
    };
    part.work.progress =
        part_of(options.work.progress, of_all(begin), of_all(begin + points.size()));
    scene.locate(points, cells.subspan(begin, points.size()), part);
  }
}

}  // namespace

template <class Real>
Vec3<Real> Grid<Real>::centre(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
  const FloatEnvironment environment;
  return environment.made(Vec3<Real>{centre_of(origin.x, spacing.x, i),
                                     centre_of(origin.y, spacing.y, j),
                                     centre_of(origin.z, spacing.z, k)});
}

template <class Real>
void Scene<Real>::voxelise(const Grid<Real>& grid, std::uint32_t first, std::uint32_t layers,
                           std::span<Location> cells, const LocateOptions& options) const {
  const FloatEnvironment environment;
  validate_grid(grid, first, layers, cells.size());
  const Impl& impl = impl_->asked(options);
  if (impl.geometries.shares_meshes()) {
    scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
    const std::size_t rows = std::size_t{layers} * grid.size[1];
    scene::for_chunks(rows, options.work, 1, [&](std::size_t begin, std::size_t end) {
      auto counts = sum.start();
      const scene::StopPoll stop(options.work.stop);
      scene::PassageCounter<Real> counter(impl.geometries, stop, counts.ladder);
      for (std::size_t row = begin; row < end; ++row) {
        const auto i = first + static_cast<std::uint32_t>(row / grid.size[1]);
        const auto j = static_cast<std::uint32_t>(row % grid.size[1]);
        for (std::uint32_t k = 0; k < grid.size[2]; ++k) {
          stop.now();
          cells[row * grid.size[2] + k] =
              impl.locate_by_ray(grid.centre(i, j, k), options, counter, counts);
        }
      }
      sum.add(counts);
    });
    return;
  }
  const scene::AxisSpace space = impl.axis_space();
  if (cells.empty()) return;
  if (options.rule == InsideRule::Winding) {  // no two cells of a column need be alike
    voxelise_points(*this, grid, first, cells, options);
    return;
  }
  const Heights heights(grid);
  const auto traverse = impl.kernel->axis;
  const std::uint32_t packets = (grid.size[1] - 1) / kernels::kAxisPoints + 1;  // a layer
  scene::CountSum<typename Impl::Counts> sum(options.work.statistics);
  const auto chunk = [&](std::size_t begin, std::size_t end) {
    auto counts = sum.start();
    Columns<Real> columns(impl.geometries, heights, counts.ladder);
    const scene::StopPoll stop(options.work.stop);
    for (std::size_t number = begin; number < end; ++number) {
      stop.now();
      const auto layer = static_cast<std::uint32_t>(number / packets);
      const auto j = static_cast<std::uint32_t>(number % packets) * kernels::kAxisPoints;
      columns.start(grid, first + layer, j, std::min(grid.size[1] - j, kernels::kAxisPoints),
                    space);
      if (columns.packet.count != 0) {
        traverse(impl.tree, columns.packet, columns, counts.kernel_counts());
      }
      counts.rays += columns.write(
          cells.subspan((std::size_t{layer} * grid.size[1] + j) * grid.size[2]), options.rule);
    }
    sum.add(counts);
  };
  scene::for_chunks(std::size_t{layers} * packets, options.work, kPacketsPerTask, chunk);
}

template struct Grid<float>;
template struct Grid<double>;
template void Scene<float>::voxelise(const Grid<float>&, std::uint32_t, std::uint32_t,
                                     std::span<Location>, const LocateOptions&) const;
template void Scene<double>::voxelise(const Grid<double>&, std::uint32_t, std::uint32_t,
                                      std::span<Location>, const LocateOptions&) const;

}  // namespace pierce
