// SPDX-License-Identifier: Apache-2.0
//
// Shades that show the numbers of a hit as colours.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "bounds.h"
#include "failure.h"
#include "render/shade.h"

namespace pierce::tool {
namespace {

// Triangles of two geometries get other colours, though their numbers are the same.
constexpr std::uint32_t kGeometryStep = 0x9e3779b9U;

template <class Real>
using ColorOf = std::function<Color(const Ray<Real>&, const Hit<Real>&)>;

template <class Real>
class PlainShader : public Shader<Real> {
 public:
  explicit PlainShader(ColorOf<Real> color) : color_(std::move(color)) {}

  void shade(std::span<const Ray<Real>> rays, std::span<const Hit<Real>> hits, std::uint64_t,
             const BatchOptions&, std::span<Color> colors) const override {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      if (hits[i].triangle != kNone) colors[i] = color_(rays[i], hits[i]);
    }
  }

 private:
  ColorOf<Real> color_;
};

// How squarely the ray meets the surface, 0 to 1: enough light to show a shape.
template <class Real>
float headlight(const Surface<Real>& surface, const Ray<Real>& ray, const Hit<Real>& hit) {
  const Vec3<double> d = normalized(convert<double>(ray.direction));
  return static_cast<float>(std::fabs(dot(surface.normal(hit), d)));
}

// Normals point to the viewer's side, so that both sides of an open mesh look right.
template <class Real>
Color normal_color(const Surface<Real>& surface, const Ray<Real>& ray, const Hit<Real>& hit) {
  Vec3<double> n = surface.normal(hit);
  if (dot(n, convert<double>(ray.direction)) > 0) n = -n;
  return convert<float>(0.5 * n + Vec3<double>{0.5, 0.5, 0.5});
}

struct Depths {
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0;
};

// Of the corners, not of the hits: the same for every size of the picture.
template <class Real>
Depths depths_of(std::span<const MeshView<Real>> meshes, const Camera& camera) {
  Depths depths;
  for_each_corner(meshes, [&](const Vec3<double>& corner) {
    const double depth = dot(corner - camera.eye, camera.forward);
    depths.nearest = std::min(depths.nearest, std::max(depth, 0.0));
    depths.farthest = std::max(depths.farthest, depth);
  });
  return depths;
}

template <class Real>
Color depth_color(const Depths& depths, const Hit<Real>& hit) {
  const double range = depths.farthest - depths.nearest;
  const double k = range > 0 ? (static_cast<double>(hit.t) - depths.nearest) / range : 0;
  return lightness_map(static_cast<float>(1 - k));
}

// Red at corner a, green at b, blue at c.
template <class Real>
Color barycentric_color(const Hit<Real>& hit) {
  return {static_cast<float>(hit.w), static_cast<float>(hit.u), static_cast<float>(hit.v)};
}

template <class Real>
Color uv_color(const Hit<Real>& hit) {
  return {static_cast<float>(hit.u), static_cast<float>(hit.v), 0.25F};
}

constexpr Color kNothing = {1, 0, 1};  // magenta

Color texcoord_color(const std::array<float, 2>& at) {
  const auto fraction = [](float x) { return x - std::floor(x); };
  const auto cell = [](float x) { return static_cast<long long>(std::floor(16 * x)); };
  const bool finite = std::isfinite(at[0]) && std::isfinite(at[1]);
  if (!finite || std::fabs(at[0]) > 1e15F || std::fabs(at[1]) > 1e15F) return kNothing;
  const bool dark = ((cell(at[0]) + cell(at[1])) & 1) != 0;
  return (dark ? 0.75F : 1.0F) *
         Color{0.2F + 0.8F * fraction(at[0]), 0.2F + 0.8F * fraction(at[1]), 0.45F};
}

void require(bool present, const std::string& name, const char* what, const char* shade) {
  if (present) return;
  throw Error(ErrorCode::BadFile,
              fmt::format("{}: has no {}; choose another --shade than {}", name, what, shade));
}

template <class Real>
ColorOf<Real> plain_color(Shade shade, const Surface<Real>& surface, const Camera& camera,
                          std::span<const MeshView<Real>> meshes, const std::string& name) {
  using R = const Ray<Real>&;
  using H = const Hit<Real>&;
  switch (shade) {
    case Shade::Depth:
      return [depths = depths_of(meshes, camera)](R, H hit) { return depth_color(depths, hit); };
    case Shade::Barycentric:
      return [](R, H hit) { return barycentric_color(hit); };
    case Shade::Uv:
      return [](R, H hit) { return uv_color(hit); };
    case Shade::Triangle:
      return [&surface](R ray, H hit) {
        return (0.35F + 0.65F * headlight(surface, ray, hit)) *
               color_of(hit.triangle + kGeometryStep * hit.geometry);
      };
    case Shade::Facing:
      return [&surface](R ray, H hit) {
        const Color side =
            hit.facing == Facing::Front ? Color{0.36F, 0.61F, 0.84F} : Color{0.91F, 0.42F, 0.24F};
        return (0.35F + 0.65F * headlight(surface, ray, hit)) * side;
      };
    case Shade::VertexColor:
      require(surface.has_colors(), name, "vertex colours", "color");
      return [&surface](R, H hit) { return surface.color(hit, kNothing); };
    case Shade::Texcoord:
      require(surface.has_texcoords(), name, "texture coordinates", "texcoord");
      return [&surface](R, H hit) {
        const auto at = surface.texcoord(hit);
        return at ? texcoord_color(*at) : kNothing;
      };
    default:
      return [&surface](R ray, H hit) { return normal_color(surface, ray, hit); };
  }
}

}  // namespace

template <class Real>
std::unique_ptr<Shader<Real>> make_plain_shader(Shade shade, const Surface<Real>& surface,
                                                const Camera& camera,
                                                std::span<const MeshView<Real>> meshes,
                                                const std::string& name) {
  return std::make_unique<PlainShader<Real>>(plain_color(shade, surface, camera, meshes, name));
}

template std::unique_ptr<Shader<float>> make_plain_shader(Shade, const Surface<float>&,
                                                          const Camera&,
                                                          std::span<const MeshView<float>>,
                                                          const std::string&);
template std::unique_ptr<Shader<double>> make_plain_shader(Shade, const Surface<double>&,
                                                           const Camera&,
                                                           std::span<const MeshView<double>>,
                                                           const std::string&);

}  // namespace pierce::tool
