// SPDX-License-Identifier: Apache-2.0
//
// From hits to colours: the values of --shade.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "render/camera.h"
#include "render/color.h"
#include "render/section.h"
#include "render/surface.h"

namespace pierce::tool {

enum class Shade : std::uint8_t {
  Normal,
  Depth,
  Barycentric,
  Uv,
  Triangle,
  Facing,
  VertexColor,
  Texcoord,
  Ao,
  Clay,
};

/// Colours the hits of many rays at once, since some shades cast rays of their own.
template <class Real>
class Shader {
 public:
  virtual ~Shader() = default;

  /// One colour a ray; misses are left as they are. `first` numbers the rays through the picture,
  /// so that what is drawn by lot depends on the place alone. `batch` has threads and stop.
  virtual void shade(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits,
                     std::uint64_t first, const BatchOptions& batch,
                     std::span<Color> colors) const = 0;
};

struct LightOptions {
  unsigned samples = 16;  ///< rays to the surroundings, for each hit
  std::uint64_t seed = 0;
  std::optional<Section> section = {};  ///< what it cuts off casts no shadow
};

/// Where the light comes from: over the viewer's left shoulder. Of unit length.
[[nodiscard]] inline Vec3<double> lamp_direction(const Camera& camera) {
  return normalized(0.9 * normalized(camera.up) - 0.7 * normalized(camera.right) -
                    0.9 * camera.forward);
}

/// Shades that need only the hit. `depths`: the nearest and farthest depth in the picture.
/// Throws Error (BadFile) if all meshes lack what the shade shows; `name` names them.
template <class Real>
[[nodiscard]] std::unique_ptr<Shader<Real>> make_plain_shader(
    Shade shade, const Surface<Real>& surface, const Camera& camera,
    std::span<const MeshView<Real>> meshes, const std::string& name);

/// Ao and Clay, which cast rays from the hits into the scene.
template <class Real>
[[nodiscard]] std::unique_ptr<Shader<Real>> make_light_shader(Shade shade,
                                                              const Surface<Real>& surface,
                                                              const Camera& camera,
                                                              const Scene<Real>& scene,
                                                              const LightOptions& options);

[[nodiscard]] inline bool casts_light(Shade shade) {
  return shade == Shade::Ao || shade == Shade::Clay;
}

}  // namespace pierce::tool
