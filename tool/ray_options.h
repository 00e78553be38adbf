// SPDX-License-Identifier: Apache-2.0
//
// Where rays come from: a file, or made on the fly.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "io/rays.h"
#include "made_rays.h"
#include "render/camera.h"

namespace CLI {
class App;
}

namespace pierce::tool {

struct RayOptions {
  std::string rays;  ///< a file
  bool camera = false;
  CameraOptions pinhole;
  std::string grid, along = "-z";
  std::string lidar, at, elevations = "-25,15";
  std::uint64_t sphere = 0, seed = 1;

  [[nodiscard]] bool made() const {
    return camera || !grid.empty() || !lidar.empty() || sphere != 0;
  }
};

/// --rays, --camera and its own options, --grid, --lidar, --sphere.
void add_ray_options(CLI::App& app, RayOptions& options);

/// Throws UsageError if there are several sources.
void check_one_source(const RayOptions& options);

/// The numbers of rays that are to be made for these meshes.
template <class Real>
[[nodiscard]] MadeRays make_rays(const RayOptions& options, std::span<const MeshView<Real>> meshes,
                                 bool z_up);

/// Rays of either source, chunk by chunk.
class RayStream {
 public:
  explicit RayStream(io::RayFile file) : source_(std::move(file)) {}
  explicit RayStream(MadeRays rays) : source_(rays) {}

  [[nodiscard]] std::uint64_t size() const;
  [[nodiscard]] std::string name() const;
  /// Height and width of what was made as a picture; else the number of rays.
  [[nodiscard]] std::vector<std::uint64_t> shape() const;
  [[nodiscard]] bool is_made() const { return std::holds_alternative<MadeRays>(source_); }
  /// Rays first, first + 1, ...
  template <class Real>
  void read(std::uint64_t first, std::span<Ray<Real>> out) const;

 private:
  std::variant<io::RayFile, MadeRays> source_;
};

extern template MadeRays make_rays(const RayOptions&, std::span<const MeshView<float>>, bool);
extern template MadeRays make_rays(const RayOptions&, std::span<const MeshView<double>>, bool);
extern template void RayStream::read(std::uint64_t, std::span<Ray<float>>) const;
extern template void RayStream::read(std::uint64_t, std::span<Ray<double>>) const;

}  // namespace pierce::tool
