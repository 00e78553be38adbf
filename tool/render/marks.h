// SPDX-License-Identifier: Apache-2.0
//
// Rays and hits drawn into a picture, behind what stands before them.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "io/view_page.h"
#include "render/camera.h"
#include "render/color.h"
#include "render/sampling.h"

namespace pierce::tool {

/// What a ray through a picture came to.
struct Sample {
  Color color;
  float alpha = 1;                                         ///< how much of it there is
  double depth = std::numeric_limits<double>::infinity();  ///< along the camera's `forward`
};

/// Where in the picture the samples of its pixels lie.
struct SamplePlaces {
  unsigned width, samples;
  std::uint64_t seed;

  [[nodiscard]] Point2 at(unsigned x, unsigned y, unsigned sample) const {
    const std::uint64_t pixel = std::uint64_t{y} * width + x;
    const Point2 off = samples == 1 ? Point2{0.5, 0.5} : spread_point(sample, seed ^ pixel << 1U);
    return {x + off.x, y + off.y};
  }
};

template <class Real>
class Marks {
 public:
  /// Rays as far as their first hit, or out of the box of the meshes; hits as balls.
  Marks(const Camera& camera, std::span<const MeshView<Real>> meshes,
        std::span<const Ray<Real>> rays, std::span<const io::ViewHit<Real>> hits);

  /// Into the samples of rows first ... end - 1.
  void draw(unsigned first, unsigned end, const SamplePlaces& places,
            std::span<Sample> samples) const;

 private:
  // A point of the picture: in pixels, and its depth.
  struct Spot {
    double x, y, depth;
  };
  struct Line {
    Spot from, to;
    Color color;
  };

  [[nodiscard]] Spot project(const Vec3<double>& p) const;
  void add_line(Vec3<double> from, Vec3<double> to, const Color& color, double least_depth);
  void draw_line(const Line& line, unsigned first, unsigned end, const SamplePlaces& places,
                 std::span<Sample> samples) const;
  void draw_ball(const Spot& spot, unsigned first, unsigned end, const SamplePlaces& places,
                 std::span<Sample> samples) const;

  const Camera& camera_;
  std::vector<Line> lines_;
  std::vector<Spot> balls_;
};

extern template class Marks<float>;
extern template class Marks<double>;

}  // namespace pierce::tool
