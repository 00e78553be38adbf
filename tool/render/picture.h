// SPDX-License-Identifier: Apache-2.0
//
// A picture made of the samples of its pixels: what is behind the mesh, and what is drawn over it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pierce/scene.h"
#include "render/camera.h"
#include "render/color.h"
#include "render/marks.h"
#include "render/section.h"
#include "render/shade.h"
#include "render/surface.h"

namespace pierce::tool {

enum class Background : std::uint8_t { Gradient, White, Transparent };

struct PictureOptions {
  unsigned samples = 4;  ///< of a pixel
  std::uint64_t seed = 0;
  Background background = Background::Gradient;
  bool edges = false, ground = false;
  std::optional<Section> section;

  /// Bytes of a pixel.
  [[nodiscard]] unsigned channels() const { return background == Background::Transparent ? 4 : 3; }
};

/// Draws rows of the picture. What it is given must outlive it.
template <class Real>
class Picture {
 public:
  Picture(const PictureOptions& options, const Camera& camera, const Scene<Real>& scene,
          const Surface<Real>& surface, const Shader<Real>& shader, const Marks<Real>& marks);

  /// Appends the bytes of rows first ... end - 1. Returns how many samples show the mesh.
  std::uint64_t draw(unsigned first, unsigned end, const BatchOptions& batch,
                     std::vector<std::uint8_t>& bytes) const;

 private:
  void put_edges(std::span<const Hit<Real>> hits, std::span<Sample> samples) const;
  void put_ground(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                  const BatchOptions& batch, std::span<Sample> samples) const;

  const PictureOptions& options_;
  const Camera& camera_;
  const Scene<Real>& scene_;
  const Surface<Real>& surface_;
  const Shader<Real>& shader_;
  const Marks<Real>& marks_;
  double floor_ = 0;  // how high the ground lies
  Vec3<double> centre_{0, 0, 0};
  double size_ = 0;
};

extern template class Picture<float>;
extern template class Picture<double>;

}  // namespace pierce::tool
