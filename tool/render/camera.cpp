// SPDX-License-Identifier: Apache-2.0
#include "render/camera.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bounds.h"
#include "failure.h"
#include "io/extension.h"
#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

constexpr double kMargin = 1.06;  // how much larger than the mesh the picture is

Vec unit(const Vec& v) { return 1 / std::hypot(v.x, v.y, v.z) * v; }

// Right, up and back: the axes of a camera that looks along -back.
struct Frame {
  Vec right, up, back;
};

bool parallel(const Vec& p, const Vec& q) {
  const Vec n = cross(p, q);
  return std::hypot(n.x, n.y, n.z) < 1e-9;
}

Frame look_along(const Vec& back, const Vec& up) {
  Frame frame;
  frame.back = unit(back);
  frame.right = unit(cross(up, frame.back));
  frame.up = cross(frame.back, frame.right);
  return frame;
}

// The nearest place from which a camera with these axes has the whole mesh in its picture. A point
// at (x, y, z) in the frame is in the picture of a camera at (cx, cy, cz) iff
// |x - cx| <= (cz - z) tan_x and |y - cy| <= (cz - z) tan_y: four planes a camera must stay behind.
template <class Real>
Vec framing_eye(std::span<const MeshView<Real>> meshes, const Frame& frame, const Box& box,
                double tan_x, double tan_y) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  double left = -kInf, right = -kInf, low = -kInf, high = -kInf;
  const Vec centre = box.centre();
  for_each_corner(meshes, [&](const Vec& p) {
    const Vec r = p - centre;
    const double x = dot(r, frame.right), y = dot(r, frame.up), z = dot(r, frame.back);
    right = std::max(right, x + z * tan_x);
    left = std::max(left, -x + z * tan_x);
    high = std::max(high, y + z * tan_y);
    low = std::max(low, -y + z * tan_y);
  });
  const double cx = (right - left) / 2, cy = (high - low) / 2;
  double cz = std::max((right + left) / (2 * tan_x), (high + low) / (2 * tan_y));
  cz = std::max(cz, box.diagonal() / 2);  // not inside a mesh that is seen edge-on
  if (cz == 0) cz = 1;                    // a single point
  return centre + cx * frame.right + cy * frame.up + cz * frame.back;
}

Vec default_up(bool z_up) { return z_up ? Vec{0, 0, 1} : Vec{0, 1, 0}; }

Vec default_back(bool z_up) { return z_up ? Vec{0.5, -1, 0.4} : Vec{0.5, 0.4, 1}; }

Vec choose_up(const CameraOptions& options, const Vec& back, bool z_up) {
  if (!options.up.empty()) {
    const Vec up = parse_vector(options.up, "--up");
    if (up == Vec{0, 0, 0}) throw UsageError("--up: must not be zero");
    if (parallel(unit(up), unit(back))) {
      throw UsageError("--up: is parallel to the line of sight; choose another direction");
    }
    return unit(up);
  }
  const Vec up = default_up(z_up);
  if (!parallel(up, unit(back))) return up;
  return z_up ? Vec{0, 1, 0} : Vec{0, 0, -1};  // straight down, as on a map
}

// The same for an orthographic one: behind the whole mesh, and how far it is to the edges of its
// picture.
struct Framing {
  Vec eye;
  double half_width, half_height;
};

template <class Real>
Framing parallel_framing(std::span<const MeshView<Real>> meshes, const Frame& frame, const Box& box,
                         const ImageSize& size) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Vec low = {kInf, kInf, kInf}, high = -low;
  const Vec centre = box.centre();
  for_each_corner(meshes, [&](const Vec& p) {
    const Vec r = p - centre;
    const Vec at = {dot(r, frame.right), dot(r, frame.up), dot(r, frame.back)};
    low = {std::min(low.x, at.x), std::min(low.y, at.y), std::min(low.z, at.z)};
    high = {std::max(high.x, at.x), std::max(high.y, at.y), std::max(high.z, at.z)};
  });
  const double aspect = static_cast<double>(size.width) / size.height;
  double half = kMargin * std::max((high.y - low.y) / 2, (high.x - low.x) / 2 / aspect);
  if (half == 0) half = 1;
  const Vec eye = centre + 0.5 * (low.x + high.x) * frame.right + 0.5 * (low.y + high.y) * frame.up;
  const double away = high.z + std::max(box.diagonal() / 4, half / 4);
  return {eye + away * frame.back, aspect * half, half};
}

// Overflowed where the camera is too far away or sees too wide, NaN where it is too near.
template <class Real>
bool is_usable(const Camera& camera) {
  const double width = camera.size.width, height = camera.size.height;
  for (const double x : {0.0, width}) {
    for (const double y : {0.0, height}) {
      const auto [origin, direction, t_min, t_max] = camera.ray<Real>(x, y);
      const Real sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
      if (!std::isfinite(origin.x + origin.y + origin.z) || !std::isfinite(sum) || sum == 0) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

void add_camera_options(CLI::App& app, CameraOptions& options) {
  app.add_option("--size", options.size, "Size of the picture in pixels")
      ->type_name("WxH")
      ->default_str(options.size);
  app.add_option("--eye", options.eye, "Where the camera stands; default: so that all is seen")
      ->type_name("X,Y,Z");
  app.add_option("--look-at", options.look_at,
                 "What it looks at; default: the centre of the mesh's box")
      ->type_name("X,Y,Z");
  app.add_option("--up", options.up,
                 "Which way is up; default: z for STL files and flat meshes, else y")
      ->type_name("X,Y,Z");
  app.add_option("--fov", options.fov, "Vertical field of view in degrees, 0 to 180")
      ->type_name("DEGREES")
      ->default_str("35");
}

template <class Real>
Camera make_camera(const CameraOptions& options, std::span<const MeshView<Real>> meshes,
                   bool z_up) {
  const ImageSize size = parse_size(options.size, "--size");
  if (!(options.fov > 0 && options.fov < 180)) {
    throw UsageError(fmt::format("--fov: {} is not between 0 and 180 degrees", options.fov));
  }
  const double tan_y = std::tan(options.fov / 360 * std::numbers::pi);
  const double tan_x = tan_y * size.width / size.height;

  const Box box = box_of(meshes);
  const Vec extent = box.high - box.low;
  z_up = z_up || extent.z < 0.25 * std::min(extent.x, extent.y);  // lies flat, like a map
  const Vec target =
      options.look_at.empty() ? box.centre() : parse_vector(options.look_at, "--look-at");
  Vec back = default_back(z_up);
  Vec eye = target;
  if (!options.eye.empty()) {
    eye = parse_vector(options.eye, "--eye");
    back = eye - target;
    if (back == Vec{0, 0, 0}) throw UsageError("--eye: is the point looked at; move one of them");
  }
  const Vec vertical = choose_up(options, back, z_up);
  const Frame frame = look_along(back, vertical);
  Framing framing{eye, tan_x, tan_y};
  if (options.orthographic) {
    // From a place of the user's it shows what a pinhole shows of the plane through the target.
    const double away = std::hypot(back.x, back.y, back.z);
    framing = options.eye.empty() ? parallel_framing(meshes, frame, box, size)
                                  : Framing{eye, tan_x * away, tan_y * away};
  }
  if (options.eye.empty()) {
    eye = options.orthographic ? framing.eye
                               : framing_eye(meshes, frame, box, tan_x / kMargin, tan_y / kMargin);
    // Asked to look elsewhere, it steps sideways until it does.
    const Vec off = target - eye;
    if (!options.look_at.empty()) {
      eye = eye + dot(off, frame.right) * frame.right + dot(off, frame.up) * frame.up;
    }
  }
  const Camera camera{size,
                      eye,
                      -frame.back,
                      framing.half_width * frame.right,
                      framing.half_height * frame.up,
                      vertical,
                      options.orthographic};
  if (!is_usable<Real>(camera)) {
    throw UsageError(fmt::format(
        "--eye, --look-at and --fov: the numbers of the camera do not fit {}; choose others",
        std::is_same_v<Real, float> ? "float" : "double"));
  }
  return camera;
}

template Camera make_camera(const CameraOptions&, std::span<const MeshView<float>>, bool);
template Camera make_camera(const CameraOptions&, std::span<const MeshView<double>>, bool);

bool has_z_up(std::span<const std::string> files) {
  return std::all_of(files.begin(), files.end(),
                     [](const std::string& file) { return io::has_extension(file, ".stl"); });
}

}  // namespace pierce::tool
