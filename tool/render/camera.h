// SPDX-License-Identifier: Apache-2.0
//
// A camera, pinhole or orthographic: where it stands unless told, and the ray through each point of
// its picture.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "parse.h"
#include "pierce/types.h"
#include "pierce/vector.h"

namespace CLI {
class App;
}

namespace pierce::tool {

/// As typed; empty strings are choices left to us.
struct CameraOptions {
  std::string size = "1024x1024", eye, look_at, up;
  double fov = 35;  // degrees, vertical
  bool orthographic = false;
};

void add_camera_options(CLI::App& app, CameraOptions& options);

struct Camera {
  ImageSize size;
  Vec3<double> eye;
  Vec3<double> forward, right, up;  ///< orthogonal; forward has unit length, the others reach from
                                    ///< the picture's centre to its edge (pinhole: 1 ahead)
  Vec3<double> vertical = {0, 1, 0};  ///< which way is up in the scene, of unit length
  bool parallel = false;              ///< orthographic: all rays run along `forward`

  /// How large a pixel is so far ahead.
  [[nodiscard]] double pixel_at(double depth) const {
    const double whole = 2 * std::hypot(up.x, up.y, up.z) / size.height;
    return parallel ? whole : depth * whole;
  }

  /// The ray through a point of the picture, in pixels from its top left corner: pixel (0, 0) has
  /// its centre at (0.5, 0.5). Its t is the distance along `forward`.
  template <class Real>
  [[nodiscard]] Ray<Real> ray(double x, double y) const {
    const double s = 2 * x / size.width - 1;
    const double t = 1 - 2 * y / size.height;
    if (parallel) {
      return {convert<Real>(eye + s * right + t * up), convert<Real>(forward)};
    }
    const auto along = [&](double f, double r, double u) {
      return static_cast<Real>(f + s * r + t * u);
    };
    return {{static_cast<Real>(eye.x), static_cast<Real>(eye.y), static_cast<Real>(eye.z)},
            {along(forward.x, right.x, up.x), along(forward.y, right.y, up.y),
             along(forward.z, right.z, up.z)}};
  }
};

/// A camera as asked for. What is left open is chosen so that all meshes together fill the picture,
/// seen from the front, a little from the right and above. `z_up`: the files' format has z upward.
template <class Real>
[[nodiscard]] Camera make_camera(const CameraOptions& options,
                                 std::span<const MeshView<Real>> meshes, bool z_up);

extern template Camera make_camera(const CameraOptions&, std::span<const MeshView<float>>, bool);
extern template Camera make_camera(const CameraOptions&, std::span<const MeshView<double>>, bool);

/// STL files come from programs in which z is upward; in most others (and for Assimp) y is.
[[nodiscard]] bool has_z_up(std::span<const std::string> files);

}  // namespace pierce::tool
